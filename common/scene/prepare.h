// Where a scene comes from, what it needs before a ray is sent into it, and what is wrong with it.
#pragma once
#include <set>
#include <string>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/scene/scene.h"

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

/// Makes a scene ready to trace: its hierarchy, its size, its normals, the shapes of its lights,
/// and the sum of its skies. From then on it is only read.
/// `report` hears how far it is.
void prepare(Scene& scene, int threads, const Report& report = {});

/// The shape that primitive number `prim` of the scene is a part of.
const Shape& shape_of(const Scene& scene, uint32_t prim);
/// The primitive, as a part of a light.
Emitter emitter_of(const Scene& scene, uint32_t prim);
/// m^2
float area_of(const Emitter& e);

/// A note for each two Shape directives of which one shines and overlaps the other in one plane:
/// rounding then decides what a ray meets there.
///
/// Shapes that move are left out. It takes at most some tenths of a second: only the first 30
/// million pairs of a face that shines and another one are compared.
/// tested by  "truth: surfaces in one place are named, and no others"
std::vector<std::string> notes_of_coincident(const Scene& scene);
