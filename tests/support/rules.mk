# Assertions that compile a third faster; an exception in one of them ends its test.
$(BUILD)/obj/tests/%.o: own_flags = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS
