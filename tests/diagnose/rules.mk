# Pictures of small scenes by any renderer: what is wrong with them?
diagnosing := $(patsubst %,$(BUILD)/obj/tests/%.o,diagnose/scenes diagnose/tiles diagnose/judge known/scenes)
measuring_small := $(diagnosing) $(patsubst %,$(BUILD)/obj/tests/%.o,diagnose/programs/measure measure/measure methods/table)
planted_methods := 07 09 14
# They take little time; with -O3 g++ 12 warns of copies in std::string by mistake.
$(BUILD)/obj/tests/diagnose/%.o: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS $(briefly)

.PHONY: probes diagnose effects
#: teaching: make probes       write the small scenes that build/diagnose judges any renderer by: build/probes
probes: $(BUILD)/diagnose
	@$< --write $(BUILD)/probes
$(BUILD)/diagnose: $(BUILD)/obj/tests/diagnose/programs/diagnose.o $(diagnosing) $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@
#: maintaining: make effects      measure anew what mistakes do to the small scenes (12 minutes)
effects: $(BUILD)/diagnose_effects
	@$< $(BUILD)/diagnosed --spp 256
$(BUILD)/diagnose_effects: $(measuring_small) $(common) tests/diagnose/mistakes.tsv tests/diagnose/plant tests/diagnose/planted.h | probes
	@rm -rf $(BUILD)/diagnosed; tests/diagnose/plant $(BUILD)/diagnosed $(BUILD)/probes
	@for chapter in $(planted_methods); do echo "compile chapter $$chapter with mistakes"; \
	  CCACHE_NODIRECT=1 $(CXX) $(filter-out -I.,$(CXXFLAGS)) -w -I$(BUILD)/diagnosed -I. -include tests/diagnose/planted.h \
	    -c tests/methods/$$chapter.cpp -o $(BUILD)/diagnosed/$$chapter.o || exit 1; done
	@echo "link $@"; $(CXX) $(CXXFLAGS) $(planted_methods:%=$(BUILD)/diagnosed/%.o) $(filter %.o,$^) -o $@
