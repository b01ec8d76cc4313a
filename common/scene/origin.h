// Where a scene comes from: what messages, films and results say of it.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "common/base/error.h"

/// Something in the scene that is not modelled, and what is rendered in its place.
struct UsedStandIn {
    std::string what, instead;
    size_t places = 0;  // in the scene files
    Position first;

    /// `Shape "curve" as nothing (3 places, first scene.pbrt:4:1)`.
    std::string text() const {
        return what + " as " + instead + " (" + std::to_string(places) +
               (places == 1 ? " place, " : " places, first ") + place_text(first) + ')';
    }
};

/// The files that a scene was read from, and what of them is not rendered as they say.
struct Origin {
    std::string file;             // as named by the user
    std::set<std::string> files;  // all of them
    uint64_t checksum = 0;        // of their bytes
    std::vector<UsedStandIn> stand_ins;
};
