// Laws: what must hold for every method of the table (tests/methods), in each scene that the method
// can render.
#pragma once
#include "tests/known/scenes.h"
#include "tests/methods/table.h"
#include "tests/support/estimators.h"

/// The methods that can render the scene; of rows that differ from another row by Sobol points or
/// the number of candidates alone, the other row stands for both.
std::vector<NamedMethod> methods_for(const Scene& scene);

/// The scene through one pixel so small that all its rays are this one.
Scene seen_along(Scene scene, const Ray& ray);
/// A large white floor under these lights, seen at the origin: its radiance is irradiance / pi.
Scene lit_floor(const std::string& lights);

/// The mean brightness of the picture, splats included, from so many paths.
Measured brightness(const Scene& scene, const NamedMethod& method, int paths, uint32_t seed = 1);

/// What is known of the brightness of a picture, and how well a method must know it.
struct KnownLight {
    double mean;
    double relative_se = 0.02;  // 3 times as much where a method rarely finds the light
    double se = 0;              // of `mean`, which is 0 for a closed form
    bool even = false;  // all surfaces have the same radiance: methods that blur light show it, too
    std::vector<std::string> except = {};        // methods that need too many paths
    int most = 1 << 20;                          // paths, for methods that rarely find the light
    std::map<std::string, Quantity> parts = {};  // by class of path
};

/// Law: each method's mean is within 5 standard errors of the known light, and has a small standard
/// error. A method takes as many paths as it needs for that, by the variance of a few others.
void check_light(const Scene& scene, const KnownLight& light);

/// Law: all methods bring the same light: in all, by length and by class of path. Each number is
/// compared with that of the last method before that knows it: who has too few paths of a class may
/// have met too little of it. Returns how many numbers were compared.
///
/// blurred  with chapters 23 and 24, which are right to 1 % where light is nearly even
int check_classes_agree(const Scene& scene, int paths, uint32_t seed = 1, bool blurred = false);

/// Law: each method brings the same light in scenes that are the same as `a` but for how they are
/// described, or where they are: by length and class of path.
void check_same_light(const Scene& a, const std::vector<Scene>& others, int paths);

/// A random scene of what chapter 13 can render (known/scenes.h).
Scene random_scene(uint32_t number);
