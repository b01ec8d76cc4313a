#: make fuzz         100,000 damaged scenes and meshes through the reader, sanitized
fuzz:
	$(MAKE) --no-print-directory SAN=1 build/san/fuzz_reader
	build/san/fuzz_reader
$B/fuzz_reader: $B/obj/tests/fuzz/reader.o $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@

.PHONY: fuzz
