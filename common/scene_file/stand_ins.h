// Stand-ins: what --stand-in renders in the place of what the programs do not model.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/scene/origin.h"
#include "common/scene_file/messages.h"

struct StandIn {
    std::string what, instead;
};
/// All of them; scenes/README.md sums them up.
const std::vector<StandIn>& all_stand_ins();
/// "; --stand-in renders it as INSTEAD", which ends a message; empty for what has no stand-in in
/// the table.
std::string or_stand_in(const std::string& what);

/// Notes, and which stand-ins a scene takes, where they are allowed.
class SceneNotes : public Messages {
public:
    SceneNotes(std::vector<std::string>& lines, bool stand_ins)
        : Messages("note", lines), stand_ins_(stand_ins) {}

    bool stand_ins() const { return stand_ins_; }
    /// Remembers that a stand-in is taken at a place in the scene file.
    void stand_in(const Position& at, const std::string& what);
    /// The same; throws where stand-ins are not allowed.
    void need(const Position& at, const std::string& what);
    /// Those that were taken, in the order of the table.
    std::vector<UsedStandIn> used() const;

private:
    struct Places {
        Position first;
        std::set<Position> all;
    };
    bool stand_ins_;
    std::map<std::string, Places> used_;
};
