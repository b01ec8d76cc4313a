// Shapes of a pbrt-v4 scene file, put into the scene in world space.
#pragma once
#include "common/scene_file/materials.h"
#include "common/scene_file/named_files.h"
#include "common/scene_file/settings.h"

/// What is in force where a Shape directive stands.
struct ShapeState {
    Transform world_from_object;
    uint32_t material = 0;  // into Scene::materials
    std::optional<AreaEmission> emission;
    bool reverse_orientation = false;
    uint64_t primitives_elsewhere = 0, vertices_elsewhere = 0;  // not in the scene's geometry
};

/// Adds the primitives of one Shape directive, and their lights, to the scene.
///
/// The side of a surface, which decides where it shines:
///   triangle  (p1-p0) x (p2-p0), whatever the transform mirrors; where there are vertex normals,
///             theirs; the order of the corners in the scene says the same
///   sphere    outwards;   disk  object space's +z, carried along as a normal
/// and ReverseOrientation turns each to the other side. Throws ReadingEnds when the scene grows
/// beyond the limits.
void read_shape(Params& params, const ShapeState& state, const Limits& limits, NamedFiles& files,
                Scene& scene, SceneNotes& notes);

/// Gives each area light its range of primitives, once all are read.
void number_light_primitives(Scene& scene);
