// How a solution of radiosity is shown: each patch alike, smooth, or by one more bounce.
#pragma once
#include <memory>

#include "common/light/light_table.h"
#include "common/path/sampler.h"
#include "common/radiosity/patches.h"

enum class Show : uint8_t { constant, smooth, gather };

/// Radiosity at the corners of each patch, W m^-2.
using CornerB = std::vector<std::array<Rgb, 3>>;

/// What is shown.
struct Shown {
    std::shared_ptr<const Patches> patches;
    CornerB B;
    Show show = Show::smooth;
    LightTable lights;  // for final gathers
};

/// Makes it of one radiosity for each patch, W m^-2. Constant: that is what the corners have too.
/// Else they have the mean of the patches around, by area, but only where the surface goes on. That
/// alone would flatten what rises and falls; so what a patch's corners miss of its own radiosity is
/// spread among them.
/// tested by  "failure: no light under a wall: patches are cut where it stands"
Shown make_shown(const Scene& scene, std::shared_ptr<const Patches> patches,
                 const std::vector<Rgb>& B, Show how, int threads);

/// B at a point of a surface, W m^-2; black where no patch is.
Rgb radiosity_at(const Shown& shown, const Hit& x);

/// What x reflects to wo, W m^-2 sr^-1, by a path of `bounces` bounces, for this point and not for
/// its patch. Lights are sampled at each bounce; the last bounce finds the radiosity of a patch,
/// without what it emits.
/// tested by  "agreement: the final gather with chapter 15, block by block within 2 %"
Rgb final_gather(const Scene& scene, const Shown& shown, Hit x, Vec3 wo, Sampler& sampler,
                 int bounces = 1);
