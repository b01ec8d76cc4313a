# The book: all pages as HTML, and in them the programs of all chapters as one WebAssembly module.
.PHONY: book
#: reading: make book         all pages as HTML, with chapters that run in them: out/book/index.html (3 minutes)
book: $(made)
	@command -v em++ >/dev/null || common/tools/install emscripten || true
	@if command -v em++ >/dev/null; then $(MAKE) $(wasm)/live.js && \
	    common/book/make_book out/book $(wasm) $(made_here); else common/book/make_book out/book; fi

wasm          := $(BUILD)/wasm
# What the module makes itself, with the same bytes; it has another exp() than the skies were made with.
made_here     := $(filter-out %.pfm,$(made))
makers        := $(made_here:scenes/%=make_%)
wasm_programs := $(chapters) merge compare $(basename $(makers))
wasm_code     := $(chapters:%=chapters/%/main.cpp) common/tools/merge.cpp common/tools/compare.cpp \
    $(addprefix scenes/,$(addsuffix .cpp,$(basename $(makers)))) \
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
$(wasm)/obj/common/tools/%.o $(wasm)/obj/scenes/%.o: main_as = -Dmain=main_$(subst -,_,$(notdir $*))
-include $(shell find $(wasm)/obj -name '*.d' 2>/dev/null)
# The names of the programs; and stb, which is not in the compiler's own folders.
$(wasm)/include/programs.h: $(chapters:%=chapters/%/main.cpp) common/book/rules.mk | $(BUILD)/packages
	@mkdir -p $(@D); { printf 'int main_%s(int, char**);\n' $(subst -,_,$(wasm_programs)); \
	    echo 'struct Program { const char* name; int (*main)(int, char**); };'; \
	    echo 'inline constexpr Program programs[] = {'; \
	    for name in $(wasm_programs); do echo "    {\"$$name\", main_$${name//-/_}},"; done; echo '};'; } >$@
	@ln -sfn "$$(echo '#include <stb/stb_image.h>' | $(CXX) $(CXXFLAGS) -M -x c++ - | tr ' ' '\n' | \
	    sed -n 's|/stb_image.h$$||p')" $(@D)/stb
