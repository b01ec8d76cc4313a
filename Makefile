# Path by Path. `make help` lists what there is: the lines that start with "#:".
SHELL     := /bin/bash
MAKEFLAGS += --no-builtin-rules -j$(shell getconf _NPROCESSORS_ONLN)
BUILD     := build
# OPT and CPU change speed alone. x86-64 processors differ in their instructions; and there, to pack
# two floats of a path costs more than it saves.
OPT       := -O3 -fno-math-errno -fno-trapping-math
ifneq ($(filter x86_64%,$(shell $(CXX) -dumpmachine)),)
CPU       := -march=native -mtune=generic -fno-tree-slp-vectorize
endif
ifdef SAN
OPT       := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all
BUILD     := build/san
endif
CXXFLAGS  := -std=c++20 $(OPT) $(CPU) -ffp-contract=off -pthread -I. -Wall -Wextra -Wshadow \
             -Wconversion $(patsubst %,-isystem %/include,$(shell brew --prefix 2>/dev/null))
# For another processor than this one: RUN runs programs, HOST_CXX compiles what writes scenes.
RUN       :=
HOST_CXX  := $(CXX)
export RUN
chapters  := $(notdir $(wildcard chapters/[0-9]*))
numbers   := $(foreach chapter,$(chapters),$(firstword $(subst _, ,$(chapter))))
tools     := $(basename $(notdir $(wildcard common/tools/*.cpp)))
objects    = $(patsubst %.cpp,$(BUILD)/obj/%.o,$(filter-out $(2),$(wildcard $(1)/*/*.cpp)))
common    := $(call objects,common,common/tools/% common/book/%)
tests     := $(call objects,tests,tests/measure/% tests/fuzz/% tests/check/names.cpp)
made = $(addprefix scenes/,globe.pfm knot.ply pool.ply sky.pfm thousand-lights.pbrt zone-plate.pbrt)

.PHONY: all programs test host test-slow help clean always $(numbers)
.SECONDARY .DELETE_ON_ERROR .SECONDEXPANSION:

#: make              install what is missing, build, and render each chapter's picture into out/
all: $(chapters:%=out/%.png) programs
	@printf 'The pictures:\n'; printf '  %s\n' $(chapters:%=out/%.png) $(chapters:%=out/%.ppm)
out/%.png: $(BUILD)/% $(made)
	@mkdir -p out
	$(RUN) $< --quiet --out $@ --out out/$*.ppm

#: make test         build, and run all tests but the slow ones; T='NAME': those so named
test: $(BUILD)/tests programs
	$(if $(T),,common/tools/fill_readmes --check $(if $(filter build,$(BUILD)),,--text))
	tests/run $(BUILD) $(if $(T),--test-case="$$T",--test-suite-exclude='*slow*')
#: make test-slow    run the slow ones
test-slow: $(BUILD)/tests programs
	tests/run $(BUILD) --test-suite='*slow*'

#: make 07           build and run one chapter
$(numbers): $$(filter $(BUILD)/$$@_%,$(chapters:%=$(BUILD)/%)) $(made)
	$(RUN) $<

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
ifeq ($(HOST_CXX),$(CXX))
$(made): $(BUILD)/make_$$(basename $$(@F))
	$(RUN) $< $@
else
$(made): host ;
host:
	MAKEFLAGS= $(MAKE) CXX='$(HOST_CXX)' HOST_CXX='$(HOST_CXX)' BUILD=$(BUILD)/host RUN= $(made)
endif
$(BUILD)/obj/%.o: %.cpp $(BUILD)/flags | $(BUILD)/packages
	@mkdir -p $(@D); echo "compile $<"
	@$(CXX) $(CXXFLAGS) $(own_flags) $(if $(WERROR),-Werror) -MMD -MP -c $< -o $@
-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)

# Changes when the compiler or its flags do: then all is compiled again.
$(BUILD)/flags: always
	@mkdir -p $(@D); echo '$(CXX) $(CXXFLAGS)' | cmp -s - $@ || echo '$(CXX) $(CXXFLAGS)' >$@
# The two libraries that the programs are compiled with, from Debian when they are missing.
$(BUILD)/packages:
	@mkdir -p $(@D); printf '#include <doctest/doctest.h>\n#include <stb/stb_image_write.h>\n' | \
	    $(CXX) -x c++ -fsyntax-only - 2>/dev/null || common/tools/install doctest-dev libstb-dev
	@touch $@

include $(wildcard common/*/rules.mk tests/*/rules.mk)

#: make clean        remove all that was built and rendered
clean:
	rm -rf build out
#: make SAN=1 test   under the address and undefined-behaviour sanitizers; CXX=clang++ also works
help:
	@sed -n "s/^#: //p" Makefile common/*/rules.mk tests/*/rules.mk
