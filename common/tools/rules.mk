# Pages, and what looks at the text of the code.
.PHONY: diff lint pictures readmes student-edition

#: reading: make diff CH=08   what a chapter changes of the one before
diff:
	@common/tools/chapter_diff '$(CH)'
#: maintaining: make lint         the rules that the text of the code keeps
lint:
	common/tools/check_text
	git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
#: teaching: make student-edition   student/: the project without solutions, answers and diffs; CH=09: with exercises up to 09
student-edition:
	@common/tools/student_edition $(CH)
#: maintaining: make pictures     render the small pictures that the READMEs show; those that are right stay as they are
pictures: programs
	common/tools/make_pictures $(BUILD)
#: maintaining: make readmes      put code, diffs and what the programs print into the READMEs (SLOW=1: what takes long)
readmes: programs
	common/tools/fill_readmes $(if $(SLOW),--slow)
	common/tools/fill_readmes tests/printed/*.md

# What programs print is checked of the main build alone; the pages not at all on Windows, which has no links.
.PHONY: check_pages
check_pages: programs
	$(if $(findstring mingw,$(machine)),,common/tools/fill_readmes --check $(if $(filter build,$(BUILD)),,--text))
