# How files are compiled and linked on each system, and what is said of it.
.PHONY: help help-all
#: starting: make help-all     these commands, and those that only makers use
# Each has a line "#: GROUP: make NAME   what it does" in the Makefile or in a rules.mk.
help help-all:
	@echo 'All use every processor. Minutes: on two of them, when all is compiled.'
	@for group in starting reading measuring teaching $(if $(filter help-all,$@),maintaining); do \
	    printf '\n%s\n' $$group; sed -n "s/^#: $$group: /  /p" $(filter-out %.d,$(MAKEFILE_LIST)); done

# Each folder of common/ is compiled as one file, all but what has flags of its own.
apart  := picture/film render/render render/code_hash
common := $(filter-out tools book,$(notdir $(patsubst %/,%,$(sort $(dir $(wildcard common/*/*.cpp))))))
common := $(patsubst %,$(BUILD)/obj/$(BUILD)/common/%.o,$(common) $(subst /,-,$(apart)))
$(BUILD)/common/%.cpp: $(if $(COUNT),,always)
	@mkdir -p $(@D); printf '#include "%s"\n' $(or $(wildcard common/$(subst -,/,$*).cpp), \
	    $(filter-out $(apart:%=common/%.cpp),$(wildcard common/$*/*.cpp))) >$@.new; cmp -s $@.new $@ && rm $@.new || mv $@.new $@
# What reads, prints and explains runs for less time than it takes to compile it by -O3.
briefly      = $(if $(filter -O3,$(OPT)),-O1)
brief_common := $(filter %/picture.o %/render.o %/render-code_hash.o %/scene_file.o,$(common))
thorough     := check measure methods
objects_of = $(patsubst %.cpp,$(BUILD)/obj/%.o,$(wildcard $(1)))
link = @echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@ $(LIBS)
# gold links in a third of the time, where the compiler finds it.
LIBS := $(if $(findstring GNU gold,$(shell $(CXX) -fuse-ld=gold -Wl,--version 2>&1)),-fuse-ld=gold)

# g++ collects garbage for a twentieth of its time, to need 30 MB less.
ifneq ($(findstring Free Software,$(shell $(CXX) --version)),)
CXXFLAGS += --param=ggc-min-heapsize=1000000

# g++ compiles the standard headers that most files include once: the rest then takes three quarters of the time. With
# such a file, g++ 12 warns of arrays and copies in std::string by mistake. ccache needs to be told that it may be used,
# and cannot keep it: g++ knows the headers in it by the times of their files. PRECOMPILED(HEADER): the flags that use it.
precompiled = -include $(BUILD)/obj/$(1) -fpch-preprocess -Wno-array-bounds -Wno-restrict \
    -Wno-stringop-overflow -Wno-stringop-overread
CCACHE_SLOPPINESS ?= pch_defines,time_macros
export CCACHE_SLOPPINESS
$(BUILD)/obj/%.h.gch: $(BUILD)/flags | $(BUILD)/packages
	@mkdir -p $(@D); echo "$(counted)compile $(@F)"
	@printf '#include <%s>\n' $(headers) $(if $(findstring /brief/,$@),filesystem) >$(basename $@)
	@CCACHE_DISABLE=1 $(CXX) $(CXXFLAGS) $(own_flags) -w -x c++-header $(basename $@) -o $@
headers := algorithm array atomic bit charconv chrono cmath cstdint cstdio cstring fstream functional limits map memory \
    numeric optional set span sstream string utility vector
standard := $(filter-out $(brief_common),$(common)) $(call objects_of,chapters/*/main.cpp common/tools/*.cpp scenes/*.cpp $(thorough:%=tests/%/*.cpp))
$(standard): own_flags += $(call precompiled,standard.h)
$(standard): $(BUILD)/obj/standard.h.gch
$(BUILD)/obj/standard.h.gch: own_flags =
# One of its own, since what is precompiled by -O3 makes g++ compile the rest by -O3, too.
brief_standard := $(brief_common) $(filter-out $(standard) %/fuzz_reader.o,$(call objects_of,tests/*/*.cpp tests/diagnose/*/*.cpp))
$(brief_standard): own_flags += $(call precompiled,brief/standard.h)
$(brief_standard): $(BUILD)/obj/brief/standard.h.gch
$(BUILD)/obj/brief/standard.h.gch: own_flags = $(briefly)
endif
$(brief_common): own_flags += $(briefly)

# Windows, by MinGW-w64, natively or from Linux. Programs need no other file there, and end in .exe:
# for make and scripts a link has the name without it, which MSYS2 knows by itself. Without AVX, as
# gcc's code stores 32 bytes where the stack of Windows is aligned to 16 (its bug 54412).
ifneq ($(findstring mingw,$(machine)),)
CXXFLAGS += -mno-avx
LIBS     += -static -municode
link      = @echo "link $@"; $(CXX) $(CXXFLAGS) $^ -o $@ $(LIBS) && { [ -e $@ ] || ln -s $(@F).exe $@; }
tests    := $(filter-out $(patsubst %,$(BUILD)/obj/tests/%,damage/% race/% grade/%),$(tests))
ifneq ($(OS),Windows_NT)
CXXFLAGS += -isystem $(BUILD)/include
$(BUILD)/packages: | $(BUILD)/include/stb
$(BUILD)/include/stb: # of Debian's own compiler
	@mkdir -p $(@D); ln -sfn /usr/include/doctest /usr/include/stb $(@D)
endif
endif

# Changes when the compiler or its flags do: then all is compiled again.
$(BUILD)/flags: $(if $(COUNT),,always)
	@mkdir -p $(@D); echo '$(CXX) $(CXXFLAGS)' | cmp -s - $@ || echo '$(CXX) $(CXXFLAGS)' >$@
# The two libraries that the programs are compiled with, from Debian when they are missing.
$(BUILD)/packages:
	@mkdir -p $(@D); printf '#include <doctest/doctest.h>\n#include <stb/stb_image_write.h>\n' | \
	    $(CXX) $(CXXFLAGS) -x c++ -fsyntax-only - 2>/dev/null || common/tools/install doctest-dev libstb-dev
	@touch $@

# "[12 of 228, 4 min left] ": a dry run counts, once the first file is to be compiled. COUNT: it is that run.
counted  = $(if $(COUNT),,$(eval done := $(done) x)[$(words $(done)) of $(total)$(left)] )
total    = $(eval total := $(shell MAKEFLAGS= $(MAKE) --dry-run MAKE=: COUNT=1 $(MAKEOVERRIDES) $(counting) | \
             grep -c 'echo "compile '))$(total)
counting = $(filter-out book test-book,$(or $(MAKECMDGOALS),all))
left     = $(eval begun := $(or $(begun),$(shell date +%s)))$(shell \
             n=$$(($(words $(done)) - 1)) seconds=$$(($$(date +%s) - $(begun))); [ $$seconds -lt 10 ] || \
             echo ", $$(((seconds * ($(total) - n) / n + 59) / 60)) min left")

# A hash of each chapter's code: a film continues with the code that began it, and with no other.
hash_flags  := -isystem $(BUILD)/include
compiled_in := $(filter-out common/tools/% common/book/%,$(wildcard common/*/*.h common/*/*.cpp))
$(BUILD)/include/code_hashes.h: $(compiled_in) $(wildcard chapters/*/*.h chapters/*/*.cpp)
	@mkdir -p $(@D); common=$$(cksum $(compiled_in)); { \
	    echo 'inline constexpr struct { const char *chapter, *hash; } code_hashes[] = {'; \
	    for chapter in $(chapters); do \
	        hash=$$({ echo "$$common"; cksum chapters/$$chapter/*.{h,cpp}; } | LC_ALL=C sort | cksum); \
	        echo "    {\"$$chapter\", \"$${hash%% *}\"},"; \
	    done; echo '};'; } >$@.new; cmp -s $@.new $@ && rm $@.new || mv $@.new $@
$(BUILD)/obj/$(BUILD)/common/render-code_hash.o: own_flags += $(hash_flags)
$(BUILD)/obj/$(BUILD)/common/render-code_hash.o: $(BUILD)/include/code_hashes.h

# The book: all pages as HTML, and in them the programs of all chapters as one WebAssembly module.
.PHONY: book
#: reading: make book         all pages as HTML, with chapters that run in them: out/book/index.html (3 minutes)
book: $(made)
	@command -v em++ >/dev/null || common/tools/install emscripten || true
	@if command -v em++ >/dev/null; then $(MAKE) $(wasm)/live.js && \
	    common/book/make_book out/book $(wasm); else common/book/make_book out/book; fi

wasm          := $(BUILD)/wasm
# The knot's mesh is large: the module writes it.
wasm_programs := $(chapters) merge make_knot
wasm_code     := $(chapters:%=chapters/%/main.cpp) common/tools/merge.cpp scenes/make_knot.cpp \
    $(filter-out common/tools/%,$(wildcard common/*/*.cpp))
wasm_flags     = -std=c++20 -O3 -msimd128 -fwasm-exceptions -fno-math-errno -fno-trapping-math \
    -ffp-contract=off -I. -isystem $(wasm)/include $(hash_flags) -include common/book/missing.h
wasm_link     := -sMODULARIZE -sEXPORT_NAME=Live -sENVIRONMENT=worker,node -sINVOKE_RUN=0 \
    -sALLOW_MEMORY_GROWTH -sFORCE_FILESYSTEM -sEXPORTED_RUNTIME_METHODS=callMain,FS

# NODE_PATH: for where Debian has what em++ needs of node, when node itself is another one.
$(wasm)/live.js: $(patsubst %.cpp,$(wasm)/obj/%.o,$(wasm_code))
	@echo "link $@"; NODE_PATH=/usr/share/nodejs em++ $(wasm_flags) $(wasm_link) $^ -o $@
$(wasm)/obj/%.o: %.cpp common/book/missing.h | $(wasm)/include/programs.h
	@mkdir -p $(@D); echo "compile $< for the book"; em++ $(wasm_flags) $(main_as) -MMD -MP -c $< -o $@
$(wasm)/obj/common/book/live.o: $(wasm)/include/programs.h
$(wasm)/obj/common/render/code_hash.o: $(BUILD)/include/code_hashes.h
$(wasm)/obj/chapters/%/main.o: main_as = -Dmain=main_$(notdir $(<D))
$(wasm)/obj/common/tools/%.o $(wasm)/obj/scenes/%.o: main_as = -Dmain=main_$(notdir $*)
-include $(shell find $(wasm)/obj -name '*.d' 2>/dev/null)
# The names of the programs; and stb, which is not in the compiler's own folders.
$(wasm)/include/programs.h: $(chapters:%=chapters/%/main.cpp) common/rules.mk | $(BUILD)/packages
	@mkdir -p $(@D); { printf 'int main_%s(int, char**);\n' $(wasm_programs); \
	    echo 'struct Program { const char* name; int (*main)(int, char**); };'; \
	    echo 'inline constexpr Program programs[] = {'; \
	    for name in $(wasm_programs); do echo "    {\"$$name\", main_$$name},"; done; echo '};'; } >$@
	@ln -sfn "$$(echo '#include <stb/stb_image.h>' | $(CXX) $(CXXFLAGS) -M -x c++ - | tr ' ' '\n' | \
	    sed -n 's|/stb_image.h$$||p')" $(@D)/stb
