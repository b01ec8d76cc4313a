// Which mutant of this program is chosen. The copy of the tree that `make mutants` compiles
// includes this header first in every file; nothing else uses it.
#pragma once

namespace mutants {

/// For each mutant: 0 nothing to do, 1 chosen, 2 tell when it is reached.
extern unsigned char state[];

/// Tells that mutant n is reached; returns whether it is chosen.
bool reached(int n);

/// Whether mutant n is chosen: read from the environment variable MUTANT at the start.
inline bool is(int n) { return state[n] != 0 && reached(n); }

/// The same in constexpr functions. The compiler itself always takes the original code.
constexpr bool is_now(int n) { return !__builtin_is_constant_evaluated() && is(n); }

}  // namespace mutants
