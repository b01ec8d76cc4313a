# Path by Path. `make help` lists what there is: the lines that start with "#:".
SHELL     := /bin/bash
MAKEFLAGS += --no-builtin-rules -j$(shell nproc)
BUILD     := build
# These change speed alone. The last one: to pack two floats of a path costs more than it saves.
OPT       := -O3 -march=native -mtune=generic -fno-math-errno -fno-trapping-math \
             -fno-tree-slp-vectorize
ifdef SAN
OPT       := -O1 -g -march=native -fsanitize=address,undefined -fno-sanitize-recover=all
BUILD     := build/san
endif
CXXFLAGS  := -std=c++20 $(OPT) -ffp-contract=off -pthread -I. -Wall -Wextra -Wshadow -Wconversion

chapters  := $(notdir $(wildcard chapters/[0-9]*))
numbers   := $(foreach chapter,$(chapters),$(firstword $(subst _, ,$(chapter))))
tools     := $(basename $(notdir $(wildcard common/tools/*.cpp)))
common    := $(patsubst %.cpp,$(BUILD)/obj/%.o,$(filter-out common/tools/%,$(wildcard common/*/*.cpp)))
tests     := $(patsubst %.cpp,$(BUILD)/obj/%.o,$(filter-out tests/measure/% tests/fuzz/%,$(wildcard tests/*/*.cpp)))
made      := scenes/knot.ply scenes/thousand-lights.pbrt

.PHONY: all programs test test-slow pictures readmes book diff help clean always $(numbers)
.SECONDARY .DELETE_ON_ERROR .SECONDEXPANSION:

#: make              install what is missing, build, and render each chapter's picture into out/
all: $(chapters:%=out/%.png)
	@printf 'The pictures:\n'; printf '  %s\n' $^ $(^:.png=.ppm)
out/%.png: $(BUILD)/% $(made)
	@mkdir -p out
	$< --quiet --out $@ --out out/$*.ppm

#: make test         build, and run all tests but the slow ones
test: $(BUILD)/tests programs
	common/tools/fill_readmes --check
	$(BUILD)/tests --test-suite-exclude='*slow*'
#: make test-slow    run the slow ones
test-slow: $(BUILD)/tests programs
	$(BUILD)/tests --test-suite='*slow*'

#: make 06           build and run one chapter
$(numbers): $$(filter $(BUILD)/$$@_%,$(chapters:%=$(BUILD)/%)) $(made)
	$<
#: make diff CH=07   what a chapter changes of the one before
diff:
	@common/tools/chapter_diff '$(CH)' --color=auto

#: make programs     build the programs, and run nothing
programs: $(chapters:%=$(BUILD)/%) $(tools:%=$(BUILD)/%) $(made)
$(BUILD)/tests: $(tests) $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@
$(BUILD)/%: $(BUILD)/obj/chapters/%/main.o $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@
$(BUILD)/%: $(BUILD)/obj/common/tools/%.o $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@
$(BUILD)/make_%: $(BUILD)/obj/scenes/make_%.o $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@
$(made): $(BUILD)/make_$$(basename $$(@F))
	$< $@
$(BUILD)/obj/%.o: %.cpp $(BUILD)/flags | $(BUILD)/packages
	@mkdir -p $(@D); echo "compile $<"
	@$(CXX) $(CXXFLAGS) -MMD -MP -c $< -o $@
-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)

# Changes when the compiler or its flags do: then all is compiled again.
$(BUILD)/flags: always
	@mkdir -p $(@D); echo '$(CXX) $(CXXFLAGS)' | cmp -s - $@ || echo '$(CXX) $(CXXFLAGS)' >$@
# The two libraries that the programs are compiled with, from Debian when they are missing.
$(BUILD)/packages:
	@mkdir -p $(@D); printf '#include <doctest/doctest.h>\n#include <stb/stb_image_write.h>\n' | \
	    $(CXX) -x c++ -fsyntax-only - 2>/dev/null || common/tools/install doctest-dev libstb-dev
	@touch $@

#: make pictures     render the small pictures that the READMEs show, by the commands they name
pictures: programs
	common/tools/make_pictures $(BUILD)
#: make readmes      put code, diffs and what the programs print into the READMEs
readmes: programs
	common/tools/fill_readmes
#: make book         all READMEs as one page: out/book.html
book:
	common/tools/make_book out/book.html
include $(wildcard tests/*/rules.mk)

#: make clean        remove all that was built and rendered
clean:
	rm -rf build out
#: make SAN=1 test   under the address and undefined-behaviour sanitizers; CXX=clang++ also works
help:
	@sed -n "s/^#: //p" Makefile tests/*/rules.mk
