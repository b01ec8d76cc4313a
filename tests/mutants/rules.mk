# Changes of the code that no test notices.
.PHONY: mutants
#: maintaining: make mutants DIR=common/light   change the code in 25 (or N=) places, and list what no test notices (SEED=)
mutants: $(made)
	@tests/mutants/mutants --build $(BUILD) $(if $(N),--n $(N)) $(if $(SEED),--seed $(SEED)) $(DIR)
