# Path by Path. `make help` lists what there is.
CXX      ?= g++
SHELL    := /bin/bash
MAKEFLAGS += --no-builtin-rules -j$(shell nproc)
OPT      ?= -O3 -march=native
CXXFLAGS := -std=c++20 $(OPT) -ffp-contract=off -pthread -I. \
            -Wall -Wextra -Wshadow -Wconversion
B        := build
ifdef SAN  # make SAN=1 test: the same under the address and undefined-behaviour sanitizers
OPT      := -O1 -g -march=native -fsanitize=address,undefined -fno-sanitize-recover=all
B        := build/san
endif

chapters := $(notdir $(wildcard chapters/[0-9]*))
tools    := $(basename $(notdir $(wildcard common/tools/*.cpp)))
common   := $(patsubst %.cpp,$B/%.o,$(wildcard common/*.cpp))
tests    := $(patsubst %.cpp,$B/%.o,$(wildcard tests/*.cpp))
meshes   := $(patsubst scenes/make_%.cpp,scenes/%.ply,$(wildcard scenes/make_*.cpp))
pictures := $(chapters:%=out/%.png)

.PHONY: all programs pictures test test-slow help clean $(shell seq -w 01 18)
.SECONDARY:
.DELETE_ON_ERROR:

all: $(pictures)
	@printf 'The pictures:\n'; printf '  %s\n' $^

programs: $(chapters:%=$B/%) $(tools:%=$B/%) $(meshes)

# One chapter: make 06 builds and runs it.
$(shell seq -w 01 18): %:
	@$(MAKE) --no-print-directory $(patsubst chapters/%,$B/%,$(wildcard chapters/$*_*)) $(meshes)
	$(patsubst chapters/%,$B/%,$(wildcard chapters/$*_*))

out/%.png: $B/% $(meshes)
	@mkdir -p out
	$< --quiet --out out/$*.png --out out/$*.ppm

test: $B/tests programs
	$B/tests --test-suite-exclude='*slow*'
test-slow: $B/tests programs
	$B/tests --test-suite='*slow*'

$B/tests: $(tests) $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@
$B/%: $B/chapters/%/main.o $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@
$B/%: $B/common/tools/%.o $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@
$B/make_%: $B/scenes/make_%.o $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@
scenes/%.ply: $B/make_%
	$< $@
$B/%.o: %.cpp | $B/packages
	@mkdir -p $(@D)
	$(CXX) $(CXXFLAGS) -MMD -MP -c $< -o $@

# The two packages that the programs are compiled with, from Debian when they are missing.
$B/packages:
	@mkdir -p $B
	@printf '#include <doctest/doctest.h>\n#include <stb/stb_image_write.h>\n' | \
	    $(CXX) -x c++ -fsyntax-only - 2>/dev/null || common/tools/install doctest-dev libstb-dev
	@touch $@

# What a chapter adds to the one before: make diff CH=07
diff:
	@old=$$(ls chapters | grep -B1 "^$(CH)_" | head -1); new=$$(ls chapters | grep "^$(CH)_"); \
	 git --no-pager diff --no-index --color=auto chapters/$$old/estimator.h chapters/$$new/estimator.h; true

clean:
	rm -rf build out

-include $(shell find $B -name '*.d' 2>/dev/null)
