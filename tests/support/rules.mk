# Assertions that compile a third faster; an exception in one of them ends its test.
$(BUILD)/obj/tests/%.o: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS
$(BUILD)/obj/tests/known/%.o: own_flags = $(briefly)
# Most tests run for less time than it takes to compile them by -O3, or with all that trace() calls in one function.
brief := $(filter-out $(addprefix $(BUILD)/obj/tests/,check/% diagnose/% known/% methods/%),$(tests))
$(brief): own_flags += $(briefly) -Dflatten=

# Most tests include the same headers: see common/base/rules.mk.
ifdef precompiled
advance := $(filter-out %/main.o,$(brief))
$(advance): own_flags += $(call precompiled,tests/support/included.h)
$(advance): $(BUILD)/obj/tests/support/included.h.gch
$(BUILD)/obj/tests/support/included.h.gch: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS $(briefly) -Dflatten=
endif
