# The programs that measure: all methods against each other, in error, time and stability.
measuring := $(basename $(notdir $(shell grep -l '^int main' tests/measure/*.cpp)))
measuring := $(filter-out bench,$(measuring))
methods   := $(filter-out $(measuring:%=tests/measure/%.cpp) tests/measure/bench.cpp, \
               $(wildcard tests/measure/*.cpp))

.PHONY: $(measuring)

$(measuring:%=$B/%): $B/%: $B/obj/tests/measure/%.o $(methods:%.cpp=$B/obj/%.o) $(common)
	$(CXX) $(CXXFLAGS) $^ -o $@

comma := ,
chosen_methods := $(if $(A),--methods $(A)$(if $(second),$(comma)$(second)))

agree: $B/agree $(made)
	@$< $(SCENE)
efficiency: $B/efficiency $(made)
	@$< $(or $(CH),$(SCENE),cornell) $(chosen_methods)
