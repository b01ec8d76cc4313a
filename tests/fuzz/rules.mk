#: make SAN=1 fuzz   100,000 damaged scenes and meshes through the reader, under the sanitizers
fuzz: $B/fuzz_reader
	$<
$B/fuzz_reader: $B/obj/tests/fuzz/reader.o $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@

.PHONY: fuzz
