// See chosen.h. `make mutants` copies this file into the tree that it compiles.
//
//   MUTANT=17          choose this mutant
//   MUTANTS_REACHED=F  write 1 into byte n of file F as soon as the place of mutant n is reached;
//                      processes that a program starts write into the same file
#include "tests/mutants/chosen.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

namespace mutants {

constexpr int most = 1 << 16;
unsigned char state[most];
static volatile unsigned char* seen = nullptr;

// Before all other constructors: they may reach mutants.
__attribute__((constructor(101))) static void choose() {
    if (const char* file = std::getenv("MUTANTS_REACHED")) {
        int f = ::open(file, O_RDWR | O_CREAT, 0644);
        if (f < 0 || ::ftruncate(f, most) != 0) std::abort();
        void* bytes = ::mmap(nullptr, most, PROT_READ | PROT_WRITE, MAP_SHARED, f, 0);
        if (bytes == MAP_FAILED) std::abort();
        ::close(f);
        seen = static_cast<unsigned char*>(bytes);
        std::memset(state, 2, most);
    }
    if (const char* n = std::getenv("MUTANT")) state[std::atoi(n) % most] = 1;
}

bool reached(int n) {
    if (state[n] == 1) return true;
    seen[n] = 1;
    state[n] = 0;
    return false;
}

}  // namespace mutants
