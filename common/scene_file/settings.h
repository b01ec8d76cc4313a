// The directives before WorldBegin that are not transforms: camera, film, sampling.
#pragma once
#include "common/geometry/transform.h"
#include "common/scene/scene.h"
#include "common/scene_file/params.h"

/// The time the shutter is open (s) and the film's speed: both scale the picture in pbrt.
struct Exposure {
    float shutter = 1, iso = 100;
};

void read_camera(Params& params, const Transform& camera_from_world, Camera& camera,
                 Exposure& exposure);
void read_film(Params& params, Scene& scene, Exposure& exposure, SceneNotes& notes);
/// PixelFilter, Sampler, Integrator and Accelerator: how pbrt renders, of which little counts here.
void read_setting(const std::string& directive, Params& params, Scene& scene, SceneNotes& notes);
