# The reader's own version of a chapter, in my/: to begin with, and to be checked.
.PHONY: exercise check checkers mine

#: teaching: make exercise CH=09   write my/09_light_sampling/estimator.h, its new functions left to you (ALL=1: also those that change)
exercise:
	@common/tools/exercise '$(CH)'
comparing := $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tests/check/*.cpp tests/known/*.cpp) \
             tests/methods/table.cpp tests/measure/measure.cpp)
checkers  := $(comparing) $(support)
# Chapters without paths of light: their check renders the chapter's own picture.
draw_alone := 01 02 03 04 05 06 26
$(BUILD)/check/support.h: tests/check/support.h $(BUILD)/flags
	@mkdir -p $(@D); printf '#include "$<"\n' >$@
# Compiled in advance, with the flags that tests/check/check compiles with. g++ takes a header for the one in here only if its
# time is the same: not that of another folder, from ccache.
$(BUILD)/check/support.h.gch: $(BUILD)/check/support.h $(common)
	@echo "$(counted)compile $<"; CCACHE_DISABLE=1 $(CXX) $(filter-out -O%,$(CXXFLAGS)) -w -O1 -Dflatten= -MMD -MP -MF $(BUILD)/obj/check_support.d \
	    -x c++-header $< -o $@
checkers: $(checkers) $(common) $(BUILD)/check/support.h.gch
# What the chapter's own file renders of random scenes.
$(BUILD)/check/worlds_%: $(BUILD)/obj/tests/methods/%.o $(comparing) $(common)
	@mkdir -p $(@D); $(CXX) $(CXXFLAGS) $(filter %.o,$^) -o $@.program $(LIBS) && echo "render random scenes"
	@$(RUN) $@.program $* write --worlds $@
#: teaching: make check CH=09      is it right? what is off, and where (NAME=1: in which function; MINE=FILE, LIMIT=30)
check: checkers $(made) $(patsubst tests/methods/%.cpp,$(BUILD)/check/worlds_%,$(wildcard tests/methods/$(CH).cpp)) \
       $(if $(filter $(CH),$(draw_alone)),$(filter $(BUILD)/$(CH)_%,$(chapters:%=$(BUILD)/%))) \
       $(BUILD)/compare
	@tests/check/check $(BUILD) '$(CH)' $(CXX) $(filter-out -I.,$(CXXFLAGS))
#: teaching: make mine CH=09       run your own file as a program: out/mine/09_light_sampling.ppm (ARGS='--spp 64')
mine: $(common) $(made)
	@ARGS='$(ARGS)' tests/check/mine $(BUILD) '$(CH)' $(CXX) $(filter-out -I.,$(CXXFLAGS)) -- $(common) $(LIBS)
