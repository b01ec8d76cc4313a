# Students' files, graded.
.PHONY: grade grade-trial
boxes: | $(BUILD)/packages
	@command -v bwrap >/dev/null || common/tools/install bubblewrap
.PHONY: boxes
#: teaching: make grade DIR=submissions   check a folder of students' files, each in a box, into out/grade/ (CH=09, WEIGHTS=FILE)
grade: boxes checkers programs
	@tests/grade/grade $(BUILD) '$(DIR)' $(CH:%=--chapter %) $(if $(WEIGHTS),--weights '$(WEIGHTS)') \
	    -- $(CXX) $(filter-out -I.,$(CXXFLAGS))
#: maintaining: make grade-trial  does make grade say what is right of files that hang, forge, delete and print?
grade-trial: boxes checkers programs
	@tests/grade/trial $(BUILD) $(CXX) $(filter-out -I.,$(CXXFLAGS))
