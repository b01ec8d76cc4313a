# Assertions that compile a third faster; an exception in one of them ends its test.
$(BUILD)/obj/tests/%.o: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS
# Most tests run for less time than it takes to compile them by -O3.
brief := $(filter-out %/exact_hits.o $(BUILD)/obj/tests/check/% $(BUILD)/obj/tests/diagnose/%,$(tests))
$(brief): own_flags += $(if $(filter -O3,$(OPT)),-O1)

# g++ compiles what most tests include once: a test then compiles in three quarters of the time. With such a file,
# g++ 12 warns of arrays and copies in std::string by mistake. ccache needs to be told that it may be used. The file itself is
# not from ccache: g++ knows the headers in it by the times of their files, which other folders have not.
ifneq ($(findstring Free Software,$(shell $(CXX) --version)),)
advance  := $(filter-out %/main.o,$(brief))
included := $(BUILD)/obj/tests/included.h
CCACHE_SLOPPINESS ?= pch_defines,time_macros
export CCACHE_SLOPPINESS
$(advance): own_flags += -include $(included) -fpch-preprocess -Wno-array-bounds -Wno-restrict \
    -Wno-stringop-overflow
$(advance): $(included).gch
$(included).gch: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS $(if $(filter -O3,$(OPT)),-O1)
$(included).gch: tests/support/included.h $(BUILD)/flags | $(BUILD)/packages
	@mkdir -p $(@D); echo "$(counted)compile $<"; echo '#include "$<"' >$(included)
	@CCACHE_DISABLE=1 $(CXX) $(CXXFLAGS) $(own_flags) -w -MMD -MP -x c++-header $(included) -o $@
endif
