// Stand-ins: what --stand-in renders in the place of what the programs do not model.
#pragma once
#include <string>
#include <vector>

struct StandIn {
    std::string what, instead;
};
/// All of them; scenes/README.md sums them up.
const std::vector<StandIn>& all_stand_ins();
/// "; --stand-in renders it as INSTEAD", which ends a message; empty for what has no stand-in in
/// the table.
std::string or_stand_in(const std::string& what);
