.PHONY: test-book exercise check checkers mine fuzz probes grade chart stability agree efficiency compare references bench teeth break mutants race

# Assertions that compile a third faster; an exception in one of them ends its test. Most tests run for less time than it
# takes to compile them by -O3, or with all that trace() calls in one function.
asserts = -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS
$(BUILD)/obj/tests/%.o $(BUILD)/obj/$(BUILD)/batch/%.o: own_flags = $(asserts) $(briefly) -Dflatten=
$(patsubst %,$(BUILD)/obj/tests/%/%.o,$(thorough) race/programs): own_flags = $(asserts)
# What tests include takes longer to compile than they do: those of a batch are compiled as one, each in a namespace of its
# own, behind all that they include: first the chapters, since what one teaches must not be found in it. NAME,FILES:
define batch
batch_$(1) := $(filter $(tests),$(foreach files,$(2),$(sort $(call objects_of,tests/$(files).cpp))))
tests := $$(filter-out $$(batch_$(1)),$$(tests)) $(BUILD)/obj/$(BUILD)/batch/$(1).o
$(BUILD)/obj/$(BUILD)/batch/$(1).o: $(if $(precompiled),$(BUILD)/obj/brief/standard.h.gch)
$(BUILD)/obj/$(BUILD)/batch/$(1).o: own_flags += $(call precompiled,brief/standard.h)
endef
between = $(subst [,,$(subst ],,$(1)))
$(foreach n,0[1-6] 0[7-9] 1[0-4] 1[5-7] 1[8-9] 2[0-1] 2[2-3] 2[4-6],$(eval $(call batch,$(call between,$n),chapters/ch$n methods/$n)))
$(foreach n,[a-e] [f-l] [m-r] [s-z],$(eval $(call batch,$(call between,$n),common/$n*)))
$(eval $(call batch,laws,laws/[aknds]*))
$(eval $(call batch,other,chapters/figures damage/damage diagnose/trials grade/* pictures/* printed/* race/*))
$(BUILD)/batch/%.cpp: $(if $(COUNT),,always)
	@mkdir -p $(@D); $(eval files := $(batch_$*:$(BUILD)/obj/%.o=%.cpp)) \
	    { sed -n '/^#include "ch/p' $(files) | sort -u; sed -n '/^#include/p' $(files) | sort -u; \
	      printf 'namespace %s {\n#include "%s"\n}\n' $(foreach f,$(files),$(subst /,_,$(basename $f)) $f); } >$@.new; \
	    cmp -s $@.new $@ && rm $@.new || mv $@.new $@

#: maintaining: make test-book    open every page of the book in Chromium and Firefox, and use what is live (5 minutes; needs npm)
test-book: book programs
	@[ -d $(BUILD)/node_modules/puppeteer-core ] || npm install --no-save --no-fund --prefix $(BUILD) puppeteer-core@24 || \
	    echo "SKIPPED: npm cannot get puppeteer-core"
	@[ ! -d $(BUILD)/node_modules/puppeteer-core ] || NODE_PATH=$(BUILD)/node_modules timeout 1800 node tests/book/test.js out/book $(BUILD)

# The reader's own version of a chapter, in my/: to begin with, and to be checked.
#: teaching: make exercise CH=09   write my/09_light_sampling/estimator.h, its new functions left to you (ALL=1: also those that change)
exercise:
	@common/tools/exercise '$(CH)'
comparing := $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tests/check/*.cpp tests/known/*.cpp) \
             tests/methods/table.cpp tests/measure/measure.cpp)
checkers  := $(comparing) $(support)
checkers: $(checkers) $(common)
# What the chapter's own file renders of random scenes: make check starts the program itself.
$(BUILD)/check/worlds_%: $(BUILD)/check/worlds_%.program
	@$(RUN) $< $* write --worlds $@
$(BUILD)/check/worlds_%.program: $(BUILD)/obj/tests/methods/%.o $(comparing) $(common)
	@mkdir -p $(@D); $(CXX) $(CXXFLAGS) $^ -o $@ $(LIBS)
# Chapters without paths of light are checked beside the chapter's own picture, others beside its random scenes.
#: teaching: make check CH=09      is it right? what is off, and where (NAME=1: in which function; MINE=FILE, LIMIT=30)
check: checkers $(made) $(if $(wildcard tests/methods/$(CH).cpp),$(BUILD)/check/worlds_$(CH).program, \
    $(filter $(BUILD)/$(CH)_%,$(chapters:%=$(BUILD)/%)))
	@tests/check/check $(BUILD) '$(CH)' $(CXX) $(filter-out -I.,$(CXXFLAGS))
#: teaching: make mine CH=09       run your own file as a program: out/mine/09_light_sampling.ppm (ARGS='--spp 64')
mine: $(common) $(made)
	@OPTIONS="$$ARGS" tests/check/check $(BUILD) '$(CH)' $(CXX) $(filter-out -I.,$(CXXFLAGS)) $(LIBS)

#: maintaining: make SAN=1 fuzz   100,000 (or COUNT=) damaged scenes, under the sanitizers
# The sanitizer keeps little of what was freed: the limit of 1 GB is for what the reader itself takes.
fuzz: export ASAN_OPTIONS := quarantine_size_mb=16
fuzz: $(BUILD)/fuzz_reader
	$< $(COUNT)
$(BUILD)/fuzz_reader: $(BUILD)/obj/tests/damage/fuzz_reader.o $(common)
	$(link)

# Pictures of small scenes by any renderer: what is wrong with them?
diagnosing := $(patsubst %,$(BUILD)/obj/tests/%.o,diagnose/scenes diagnose/tiles diagnose/judge known/scenes)
#: teaching: make probes       write the small scenes that build/diagnose judges any renderer by: build/probes
probes: $(BUILD)/diagnose
	@$< --write $(BUILD)/probes
$(BUILD)/diagnose: $(BUILD)/obj/tests/diagnose/programs/diagnose.o $(diagnosing) $(common)
	@echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@

#: teaching: make grade DIR=submissions   check a folder of students' files, each in a box, into out/grade/ (CH=09, WEIGHTS=FILE)
grade: checkers programs
	@command -v bwrap >/dev/null || common/tools/install bubblewrap
	@tests/grade/grade $(BUILD) '$(DIR)' $(CH:%=--chapter %) $(if $(WEIGHTS),--weights '$(WEIGHTS)') \
	    -- $(CXX) $(filter-out -I.,$(CXXFLAGS))

# The programs that measure: all methods against each other, in error, time and stability.
measuring := $(basename $(notdir $(shell grep -l '^int main' tests/measure/*.cpp)))
methods   := $(filter-out $(measuring:%=tests/measure/%.cpp),$(wildcard tests/measure/*.cpp)) $(wildcard tests/methods/*.cpp)
comma     := ,
chosen     = $(if $(A),--methods $(A)$(if $(B),$(comma)$(B)))
of_reader  = $(filter mine/%,$(A) $(B))

$(measuring:%=$(BUILD)/%): $(BUILD)/%: $(BUILD)/obj/tests/measure/%.o $(methods:%.cpp=$(BUILD)/obj/%.o) $(common)
	$(link)
$(BUILD)/bench: LIBS += $(if $(wildcard /usr/include/embree3/rtcore.h),-lembree3)
$(BUILD)/gnuplot:
	@command -v gnuplot >/dev/null || common/tools/install gnuplot-nox; mkdir -p $(@D); touch $@

#: measuring: make chart        error against time of all chapters (11 minutes; QUICK=1: 2; SCENE=cornell)
chart: $(BUILD)/chart $(BUILD)/gnuplot $(made)
	$(BUILD)/chart $(SCENE) $(chosen) $(if $(QUICK),--seconds 60)
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
#: maintaining: make references   render what the charts compare with (25 minutes)
references: $(BUILD)/references $(made)
	$< $(SCENE)
#: measuring: make bench        rays per second of the hierarchy of common/geometry, beside Embree (2 minutes)
bench: $(BUILD)/bench $(made)
	@$<
readmes: $(if $(SLOW),$(addprefix $(BUILD)/,agree bench efficiency stability gnuplot))
# What a test program consists of beside the test itself.
harness := $(common) $(support) $(filter $(BUILD)/obj/tests/known/%,$(tests)) $(BUILD)/obj/tests/laws/laws.o $(call objects_of,tests/methods/*.cpp)
teeth = tests/teeth $(BUILD) '$(CH)' '$(N)' $(CXX) $(filter-out -I.,$(CXXFLAGS))
#: maintaining: make teeth        plant mistakes, one at a time, and show the test that sees each (CH=09: a page's) (15 minutes)
teeth: $(harness) $(made)
	@$(teeth)
#: teaching: make break CH=09 N=2   plant the second mistake of that page, and show its test red
break: $(harness) $(made)
	@$(if $(and $(CH),$(N)),$(teeth),echo 'usage: make break CH=09 N=2' >&2; exit 1)

#: maintaining: make mutants DIR=common/light   change the code in 25 (or N=) places, and list what no test notices (SEED=)
mutants: programs $(BUILD)/tests $$(started)
	@tests/mutants --build $(BUILD) $(if $(N),--n $(N)) $(if $(SEED),--seed $(SEED)) $(DIR)

$(BUILD)/flatten: $(BUILD)/obj/tests/race/programs/flatten.o $(common)
	$(link)
started += $(BUILD)/flatten
#: measuring: make race         other renderers beside the chapters, on the same scenes (PEERS='cycles pbrt'; PBRT=FILE, SCENES=) (28 minutes)
race: programs $(BUILD)/flatten
	@tests/race/race $(BUILD) $(SCENES) \
	    $(foreach name,PEERS BLENDER PBRT SIZE TURNS SECONDS REFERENCE,$(if $($(name)),--$(name) '$($(name))'))
