# The programs that measure: all methods against each other, in error, time and stability.
measuring := $(basename $(notdir $(shell grep -l '^int main' tests/measure/*.cpp)))
methods   := $(filter-out $(measuring:%=tests/measure/%.cpp),$(wildcard tests/measure/*.cpp)) $(wildcard tests/methods/*.cpp)
comma     := ,
chosen     = $(if $(A),--methods $(A)$(if $(B),$(comma)$(B)))
quick      = $(if $(QUICK),$(1))
of_reader  = $(filter mine/%,$(A) $(B))

.PHONY: chart front stability agree efficiency compare radiosity references bench teeth break

$(measuring:%=$(BUILD)/%): $(BUILD)/%: $(BUILD)/obj/tests/measure/%.o $(methods:%.cpp=$(BUILD)/obj/%.o) $(common)
	$(link)
$(BUILD)/bench: LIBS += $(if $(wildcard /usr/include/embree3/rtcore.h),-lembree3)
$(BUILD)/gnuplot:
	@command -v gnuplot >/dev/null || common/tools/install gnuplot-nox; mkdir -p $(@D); touch $@

#: measuring: make chart        error against time of all chapters (11 minutes; QUICK=1: 2; SCENE=cornell)
chart: $(BUILD)/chart $(BUILD)/gnuplot $(made)
	$(BUILD)/chart $(SCENE) $(chosen) $(call quick,--seconds 60)
#: maintaining: make front        the chart of the front page, anew
front: $(BUILD)/chart $(BUILD)/gnuplot $(made)
	$(BUILD)/chart cornell --methods all --seconds 60
	cp out/chart-cornell.svg tests/measure/front.svg
#: measuring: make stability    do methods fail where theory says, as it says, and nowhere else? (3 minutes)
stability: $(BUILD)/stability $(made)
	$<
#: measuring: make agree        z values of every chapter against the others, on every scene (8 minutes)
agree: $(BUILD)/agree $(made)
	$< $(SCENE)
#: measuring: make efficiency CH=14   a chapter's error, time and efficiency beside the one before (3 minutes)
efficiency: $(BUILD)/efficiency $(made)
	@$< $(or $(CH),$(SCENE),cornell) $(chosen)
#: measuring: make compare A=09 B=10 SCENE=cornell   two chapters with equal samples, and with equal time (A=mine/09: yours; 2 minutes)
compare: $(if $(of_reader),$(BUILD)/compare $(filter $(patsubst %,$(BUILD)/%_%,$(filter-out mine/%,$(A) $(B))),$(chapters:%=$(BUILD)/%)),$(BUILD)/efficiency) $(made)
	@$(if $(of_reader),tests/check/beside $(BUILD) '$(A)' '$(B)' '$(SCENE)',$< $(or $(SCENE),cornell) $(chosen) --equal-time)
#: maintaining: make radiosity    error against time: patches of chapter 26 beside paths of 15 (1 minute)
radiosity: $(BUILD)/radiosity $(BUILD)/gnuplot $(made)
	@$< $(SCENE)
#: maintaining: make references   render what the charts compare with (25 minutes)
references: $(BUILD)/references $(made)
	$< $(SCENE)
#: measuring: make bench        rays per second of the hierarchy of common/geometry, beside Embree (2 minutes)
bench: $(BUILD)/bench $(made)
	@$<
readmes: $(if $(SLOW),$(addprefix $(BUILD)/,agree bench efficiency radiosity stability gnuplot))
# What a test program consists of beside the test itself.
harness := $(common) $(support) $(filter $(BUILD)/obj/tests/known/%,$(tests)) $(BUILD)/obj/tests/laws/laws.o $(filter $(BUILD)/obj/tests/methods/%,$(tests))
teeth = tests/teeth $(BUILD) '$(CH)' '$(N)' $(CXX) $(filter-out -I.,$(CXXFLAGS))
#: maintaining: make teeth        plant mistakes, one at a time, and show the test that sees each (CH=09: a page's) (15 minutes)
teeth: $(harness) $(made)
	@$(teeth)
#: teaching: make break CH=09 N=2   plant the second mistake of that page, and show its test red
break: $(harness) $(made)
	@$(if $(and $(CH),$(N)),$(teeth),echo 'usage: make break CH=09 N=2' >&2; exit 1)
