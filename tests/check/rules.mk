# The reader's own version of a chapter, in my/: to begin with, and to be checked.
.PHONY: exercise check checkers names mistakes stages verdicts

#: teaching: make exercise CH=09   write my/09_light_sampling/estimator.h, its new functions left to you
exercise:
	@common/tools/exercise '$(CH)'
	@MAKEFLAGS= $(MAKE) --no-print-directory checkers
checkers := $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tests/check/*.cpp) tests/measure/methods.cpp \
            tests/measure/measure.cpp) $(support)
$(BUILD)/check/support.h: tests/check/support.h $(BUILD)/flags
	@mkdir -p $(@D); printf '#include "$<"\n' >$@
# Compiled in advance, with the flags that tests/check/check compiles with. g++ takes a header for the one in here only if its
# time is the same: not that of another folder, from ccache.
$(BUILD)/check/support.h.gch: $(BUILD)/check/support.h $(common)
	@echo "$(counted)compile $<"; CCACHE_DISABLE=1 $(CXX) $(filter-out -O%,$(CXXFLAGS)) -w -O1 -MMD -MP -MF $(BUILD)/obj/check_support.d \
	    -x c++-header $< -o $@
checkers: $(checkers) $(common) $(BUILD)/check/support.h.gch
#: teaching: make check CH=09      is it right? one line for each claim, and what is off; NAME=1: the function with the mistake
check: checkers $(made) \
       $(if $(wildcard tests/measure/method_$(CH).cpp),,$(filter $(BUILD)/$(CH)_%,$(chapters:%=$(BUILD)/%))) \
       $(BUILD)/compare
	@tests/check/check $(BUILD) '$(CH)' $(CXX) $(filter-out -I.,$(CXXFLAGS))
#: maintaining: make verdicts     does make check say of right, wrong and endless files what they are?
verdicts: checkers $(BUILD)/01_monte_carlo_pi $(BUILD)/compare
	@tests/check/verdicts $(BUILD) $(CXX) $(filter-out -I.,$(CXXFLAGS))
#: maintaining: make stages CH=21     after which function of the exercise can each claim be decided? (minutes)
stages: checkers
	@tests/check/stages $(BUILD) $(CH) -- $(CXX) $(filter-out -I.,$(CXXFLAGS))
# All chapters in one, for the references that make check compares with (2 minutes): build/names --references
$(BUILD)/names: $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard tests/check/*.cpp)) $$(patsubst %.cpp,$$(BUILD)/obj/%.o,$$(methods)) $(common)
	$(link)
#: maintaining: make names        plant the mistakes of the pages, and write down how make check names them
names: $(checkers) $(common) $(made)
	@tests/check/plant $(BUILD) '$(M)' $(CXX) $(filter-out -I.,$(filter-out -O%,$(CXXFLAGS)))
#: maintaining: make mistakes     change code as students might: what does make check notice, and does it find the function? (CH=09, N=, SEED=, FILL=1, PREDICT=1)
mistakes: checkers $(made)
	@tests/check/mistakes $(BUILD) $(CH:%=--chapters %) $(N:%=--n %) $(SEED:%=--seed %) $(if $(LIST),--list) \
	  $(if $(PREDICT),--predict) $(if $(FILL),--fill) -- $(CXX) $(filter-out -I.,$(filter-out -O%,$(CXXFLAGS)))
