# Pictures of small scenes by any renderer: what is wrong with them?
diagnosing := $(patsubst %,$(BUILD)/obj/tests/%.o,diagnose/scenes diagnose/tiles diagnose/judge known/scenes)
# They take little time; with -O3 g++ 12 warns of copies in std::string by mistake.
$(BUILD)/obj/tests/diagnose/%.o: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS $(briefly)

.PHONY: probes diagnose
#: teaching: make probes       write the small scenes that build/diagnose judges any renderer by: build/probes
probes: $(BUILD)/diagnose
	@$< --write $(BUILD)/probes
$(BUILD)/diagnose: $(BUILD)/obj/tests/diagnose/programs/diagnose.o $(diagnosing) $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@
