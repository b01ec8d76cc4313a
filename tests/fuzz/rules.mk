#: make SAN=1 fuzz   100,000 damaged scenes and meshes through the reader, under the sanitizers
fuzz: $(BUILD)/fuzz_reader
	$<
$(BUILD)/fuzz_reader: $(BUILD)/obj/tests/fuzz/reader.o $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@

.PHONY: fuzz
