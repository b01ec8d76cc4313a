# Tests: how they are compiled, and the small commands beside them.
.PHONY: diagnose fuzz mutants probes race test-book

# An object for each chapter.
$(methods): own_flags += -DCHAPTER_$(*F)
$(methods): $(BUILD)/obj/tests/methods/%.o: tests/methods/chapters.cpp $(BUILD)/flags | $(BUILD)/packages
	@mkdir -p $(@D); echo "$(counted)compile $< for chapter $(*F)"
	@$(CXX) $(CXXFLAGS) $(own_flags) $(if $(WERROR),-Werror) -MMD -MP -c $< -o $@

# Pictures of small scenes by any renderer: what is wrong with them?
diagnosing := $(patsubst %,$(BUILD)/obj/tests/%.o,diagnose/scenes diagnose/tiles diagnose/judge known/scenes)
# They take little time; with -O3 g++ 12 warns of copies in std::string by mistake.
$(BUILD)/obj/tests/diagnose/%.o: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS $(briefly)
#: teaching: make probes       write the small scenes that build/diagnose judges any renderer by: build/probes
probes: $(BUILD)/diagnose
	@$< --write $(BUILD)/probes
$(BUILD)/diagnose: $(BUILD)/obj/tests/diagnose/programs/diagnose.o $(diagnosing) $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@

#: measuring: make race         other renderers beside the chapters, on the same scenes (PEERS='cycles pbrt'; PBRT=FILE, SCENES=) (28 minutes)
race: programs $(BUILD)/flatten
	@tests/race/race $(BUILD) $(SCENES) $(foreach name,peers blender pbrt size turns seconds reference,$(call option,$(name)))
option = $(if $($(shell tr a-z A-Z <<<$(1))),--$(1) '$($(shell tr a-z A-Z <<<$(1)))')
$(BUILD)/flatten: $(BUILD)/obj/tests/race/programs/flatten.o $(common)
	$(link)
started := $(BUILD)/flatten

#: maintaining: make test-book    open every page of the book in Chromium and Firefox, and use what is live (5 minutes; needs npm)
test-book: book programs
	tests/book/run out/book $(BUILD)
#: maintaining: make mutants DIR=common/light   change the code in 25 (or N=) places, and list what no test notices (SEED=)
mutants: $(made)
	@tests/mutants --build $(BUILD) $(if $(N),--n $(N)) $(if $(SEED),--seed $(SEED)) $(DIR)
#: maintaining: make SAN=1 fuzz   100,000 (or COUNT=) damaged scenes, under the sanitizers
# The sanitizer keeps little of what was freed: the limit of 1 GB is for what the reader itself takes.
fuzz: export ASAN_OPTIONS := quarantine_size_mb=16
fuzz: $(BUILD)/fuzz
	COUNT=$(or $(COUNT),100000) $< --no-skip
$(BUILD)/fuzz: $(BUILD)/obj/tests/damage/readers.o $(support) $(common)
	$(link)

# Assertions that compile a third faster; an exception in one of them ends its test.
$(BUILD)/obj/tests/%.o: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS
# Most tests run for less time than it takes to compile them by -O3.
brief := $(filter-out $(addprefix $(BUILD)/obj/tests/,check/% diagnose/% known/% methods/%),$(tests))
$(brief): own_flags += $(briefly)
# Most tests include the same headers: see common/base/rules.mk.
ifdef precompiled
advance := $(filter-out %/main.o,$(brief))
$(advance): own_flags += $(call precompiled,tests/support/included.h)
$(advance): $(BUILD)/obj/tests/support/included.h.gch
$(BUILD)/obj/tests/support/included.h.gch: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS $(briefly)
endif
