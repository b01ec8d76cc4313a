# Students' files, graded.
.PHONY: grade boxes
boxes: | $(BUILD)/packages
	@command -v bwrap >/dev/null || common/tools/install bubblewrap
#: teaching: make grade DIR=submissions   check a folder of students' files, each in a box, into out/grade/ (CH=09, WEIGHTS=FILE)
grade: boxes checkers programs
	@tests/grade/grade $(BUILD) '$(DIR)' $(CH:%=--chapter %) $(if $(WEIGHTS),--weights '$(WEIGHTS)') \
	    -- $(CXX) $(filter-out -I.,$(CXXFLAGS))
