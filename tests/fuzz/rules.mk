#: make SAN=1 fuzz   100,000 (or COUNT=) damaged scenes and meshes through the reader, under the sanitizers
fuzz: $(BUILD)/fuzz_reader
	$< $(COUNT)
$(BUILD)/fuzz_reader: $(BUILD)/obj/tests/fuzz/reader.o $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@

.PHONY: fuzz
