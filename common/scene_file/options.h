// The directives before WorldBegin that are not transforms: camera, film, sampling.
#pragma once
#include "common/geometry/transform.h"
#include "common/scene/scene.h"
#include "common/scene_file/params.h"

/// Collects the notes that a program prints: what of a scene file is not done as it says.
using Notes = std::vector<std::string>;

/// The time the shutter is open (s) and the film's speed: both scale the picture in pbrt.
struct Exposure {
    float shutter = 1, iso = 100;
};

void read_camera(Params& params, const Transform& camera_from_world, Camera& camera,
                 Exposure& exposure);
void read_film(Params& params, Scene& scene, Exposure& exposure, Notes& notes);
void read_pixel_filter(Params& params, Notes& notes);
void read_sampler(Params& params, Scene& scene, Notes& notes);
void read_integrator(Params& params, Scene& scene, Notes& notes);
void read_accelerator(Params& params, Notes& notes);
/// `Option "disablepixeljitter" true`: all are ignored, with a note.
void read_option(const Position& at, const std::string& name, Notes& notes);
