# Other renderers beside the methods of the chapters.
.PHONY: race
$(BUILD)/flatten: $(BUILD)/obj/tests/race/programs/flatten.o $(common)
	$(link)
started += $(BUILD)/flatten
#: measuring: make race         other renderers beside the chapters, on the same scenes (PEERS='cycles pbrt'; PBRT=FILE, SCENES=) (28 minutes)
race: programs $(BUILD)/flatten
	@tests/race/race $(BUILD) $(SCENES) $(foreach name,peers blender pbrt size turns seconds reference,$(call option,$(name)))
option = $(if $($(shell tr a-z A-Z <<<$(1))),--$(1) '$($(shell tr a-z A-Z <<<$(1)))')
