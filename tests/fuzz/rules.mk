#: maintaining: make SAN=1 fuzz   100,000 (or COUNT=) damaged scenes, as many pictures and as many films, under the sanitizers
fuzz: $(BUILD)/fuzz_reader
	$< $(COUNT)
	$< $(or $(COUNT),100000) 0 pictures
	$< $(or $(COUNT),100000) 0 films
$(BUILD)/fuzz_reader: $(BUILD)/obj/tests/fuzz/reader.o $(common)
	$(link)

.PHONY: fuzz
