# Path by Path. `make help` lists what there is: the lines that start with "#:".
SHELL     := /bin/bash
MAKEFLAGS += --no-builtin-rules -j$(shell getconf _NPROCESSORS_ONLN)
BUILD     := build
# OPT and CPU change speed alone. x86-64 processors differ in their instructions; and there, to pack
# two floats of a path costs more than it saves.
OPT       := -O3 -fno-math-errno -fno-trapping-math
machine   := $(shell $(CXX) -dumpmachine)
ifneq ($(filter x86_64%,$(machine)),)
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
tests     := $(filter-out tests/measure/% tests/damage/fuzz_reader.cpp tests/check/compare_scenes.cpp,$(wildcard tests/*/*.cpp))
tests     := $(tests:%.cpp=$(BUILD)/obj/%.o)
support   := $(filter $(BUILD)/obj/tests/support/%,$(tests))
# Programs that tests start: see tests/rules.mk.
started    =
made = $(addprefix scenes/,globe.pfm knot.ply pool.ply sky.pfm thousand-lights.pbrt)

.PHONY: all programs test host test-slow clean always $(numbers)
.SECONDARY .DELETE_ON_ERROR .SECONDEXPANSION:

#: starting: make              install what is missing, build, and render all pictures into out/
all: $(chapters:%=out/%.png) programs
	@printf 'The pictures:\n'; printf '  %s\n' $(chapters:%=out/%.png) $(chapters:%=out/%.ppm)
out/%.png: $(BUILD)/% $(made)
	@mkdir -p out; echo "render $@, the last is $(lastword $(chapters))"
	@$(RUN) $< --out $@ --out out/$*.ppm >/dev/null
# When all is compiled, one after the other: each uses all processors, and shows how far it is.
previous  := programs
$(foreach c,$(chapters),$(eval out/$c.png: | $(previous))$(eval previous := out/$c.png))

#: starting: make test         build, and run all tests but the slow ones; T='NAME': those so named
test: $(BUILD)/tests programs $$(started) $(if $(T),,check_pages)
	tests/run $(BUILD) $(if $(T),--no-skip --test-case="$$T",--quick)
#: maintaining: make test-slow    run the slow tests (9 minutes)
test-slow: $(BUILD)/tests programs $$(started)
	tests/run $(BUILD) --slow

#: starting: make 07           build and run one chapter
$(numbers): $$(filter $(BUILD)/$$@_%,$(chapters:%=$(BUILD)/%)) $$(made_for_$$@)
	$(RUN) $<

# What the default scene of each chapter needs.
$(foreach n,$(numbers),$(eval made_for_$n = $$(filter $$(addsuffix .%,$$(shell \
    grep -oh 'scenes/[a-z-]*' chapters/$n_*/main.cpp)),$$(made))))
#: maintaining: make programs     build the programs, and run nothing
programs: $(chapters:%=$(BUILD)/%) $(tools:%=$(BUILD)/%) $(made)
$(BUILD)/tests: $$(tests) $$(common)
	$(link)
$(BUILD)/%: $(BUILD)/obj/chapters/%/main.o $$(common)
	$(link)
$(BUILD)/%: $(BUILD)/obj/common/tools/%.o $$(common)
	$(link)
$(BUILD)/make_%: $(BUILD)/obj/scenes/make_%.o $$(common)
	$(link)
ifeq ($(HOST_CXX),$(CXX))
$(made): $(BUILD)/make_$$(basename $$(@F))
	$(RUN) $< $@
else
$(made): host ;
host:
	MAKEFLAGS= $(MAKE) CXX='$(HOST_CXX)' HOST_CXX='$(HOST_CXX)' RUN= $(made) \
	    BUILD=build$(if $(filter build,$(BUILD)),/host)
endif
$(BUILD)/obj/%.o: %.cpp $(BUILD)/flags | $(BUILD)/packages
	@mkdir -p $(@D); echo "$(counted)compile $<"
	@$(CXX) $(CXXFLAGS) $(own_flags) $(if $(WERROR),-Werror) -MMD -MP -c $< -o $@
-include $(shell find $(BUILD)/obj -name '*.d' 2>/dev/null)

include common/rules.mk common/tools/rules.mk tests/rules.mk

#: starting: make clean        remove all that was built and rendered
clean:
	rm -rf build out
#: maintaining: make SAN=1 test   under the sanitizers of addresses and undefined behaviour
