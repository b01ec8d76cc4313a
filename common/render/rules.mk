# A hash of each chapter's code: a film continues with the code that began it, and with no other.
hash_flags  := -isystem $(BUILD)/include
compiled_in := $(filter-out common/tools/% common/book/%,$(wildcard common/*/*.h common/*/*.cpp))
$(BUILD)/include/code_hashes.h: $(compiled_in) $(wildcard chapters/*/*.h chapters/*/*.cpp)
	@mkdir -p $(@D); common=$$(cksum $(compiled_in)); { \
	    echo 'inline constexpr struct { const char *chapter, *hash; } code_hashes[] = {'; \
	    for chapter in $(chapters); do \
	        hash=$$({ echo "$$common"; cksum chapters/$$chapter/*.{h,cpp}; } | LC_ALL=C sort | cksum); \
	        echo "    {\"$$chapter\", \"$${hash%% *}\"},"; \
	    done; echo '};'; } >$@.new; cmp -s $@.new $@ && rm $@.new || mv $@.new $@
$(BUILD)/obj/common/render/code_hash.o: own_flags += $(hash_flags)
$(BUILD)/obj/common/render/code_hash.o: $(BUILD)/include/code_hashes.h
