// The ways to render a scene that the measuring programs know, each with one name, one colour and
// one label everywhere.
//
// A chapter joins by a file method_NN.cpp of its own, which hands add_method() what is below; no
// other file changes. (A file of its own, because what chapter NN teaches is in common/ later under
// the same name, and overloads of both would be ambiguous.) `render` makes the whole film, so that
// a chapter may also splat, share its samples out, or begin with photons; for a plain trace() it is
// by_trace(). The film is unbiased for any seed, spp and threads of the options, and with
// options.split it gives the films of the classes as well.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "common/program/render.h"

struct NamedMethod {
    std::string name;                      // "09"; with an option of the chapter, "09-area"
    std::string label = {};                // in legends
    std::string color = {};                // "#rrggbb"
    std::string finds_light = {};          // how, in two words: those that do it alike err alike
    std::vector<std::string> scenes = {};  // what its chapter is about, for make efficiency
    std::vector<void (*)(const Scene&)> refuse = {};  // throw InputError for what it cannot render
    std::function<Rendering(const Scene&, const RenderOptions&)> render = {};
    bool biased = false;  // on purpose
    LightSearch search = LightSearch::light_sampling;
    Features features = {};  // of scenes, which it renders
};

/// Whether the method is a chapter with an option, and not the chapter as it is.
inline bool is_variant(const NamedMethod& method) { return method.name.size() > 2; }

/// Adds to all_methods(); returns true.
bool add_method(const NamedMethod& method);

/// render for a chapter that has nothing but trace(): `make_trace` hands it what it needs of the
/// scene.
std::function<Rendering(const Scene&, const RenderOptions&)> by_trace(
    const std::function<Method(const Scene&)>& make_trace);

/// All methods, sorted by name.
const std::vector<NamedMethod>& all_methods();

/// The methods of these names, or UsageError. "all": every chapter; "09+": chapter 09 and its
/// variants.
std::vector<NamedMethod> methods_named(const std::vector<std::string>& names);

/// Throws InputError when the method cannot render the scene.
void refuse(const NamedMethod& method, const Scene& scene);
/// Whether the method can render the scene.
bool can_render(const NamedMethod& method, const Scene& scene);

/// The scenes of scenes/, as paths; and those with the ones of tests/pictures/references/.
std::vector<std::string> own_scenes();
std::vector<std::string> all_scenes();

/// "cornell" for scenes/cornell.pbrt, "references/veach-mis" for the scenes of others.
std::string scene_name(const std::string& path);

/// The same as part of a file's name: without a slash.
std::string file_name(std::string scene_name);

/// The path of a scene from its path or its scene_name, or UsageError.
std::string find_scene(const std::string& name);
