# Changes of the code that no test notices.
.PHONY: mutants
#: maintaining: make mutants DIR=common/light   change the code in 25 (or N=) places, and list what no test notices (SEED=, LIST=1, AT=FILE:LINE)
mutants: $(made)
	@tests/mutants/mutants --build $(BUILD) $(DIR:%=--dir %) $(if $(N),--n $(N)) $(if $(SEED),--seed $(SEED)) \
	    $(if $(AT),--at $(AT)) $(if $(M),--only $(M)) $(if $(LIST),--list) $(if $(FILL),--fill)
