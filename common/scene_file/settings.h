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
void read_pixel_filter(Params& params, SceneNotes& notes);
void read_sampler(Params& params, Scene& scene, SceneNotes& notes);
void read_integrator(Params& params, Scene& scene, SceneNotes& notes);
void read_accelerator(Params& params, SceneNotes& notes);
