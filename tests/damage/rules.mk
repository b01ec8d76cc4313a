#: maintaining: make SAN=1 fuzz   100,000 (or COUNT=) damaged scenes, under the sanitizers
# The sanitizer keeps little of what was freed: the limit of 1 GB is for what the reader itself takes.
fuzz: export ASAN_OPTIONS := quarantine_size_mb=16
fuzz: $(BUILD)/fuzz_reader
	$< $(COUNT)
$(BUILD)/fuzz_reader: $(BUILD)/obj/tests/damage/fuzz_reader.o $(common)
	$(link)

.PHONY: fuzz
