// All ways to render a scene, in one table: tests of laws, charts, `make agree`, `make stability`
// and `make check` read it.
//
// A chapter joins in chapters.cpp: one row for the chapter, and one for each of its options that is
// tested or measured by itself.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "common/render/render.h"

/// A row of the table.
struct NamedMethod {
    std::string name;                      // "09"; with an option of the chapter, "09-area"
    std::string label = {};                // in legends
    std::string color = {};                // "#rrggbb"
    std::vector<std::string> scenes = {};  // what its chapter is about, for make efficiency
    LightSearch search = LightSearch::light_sampling;
    /// What the chapter prepares, and its trace(). May replace options, such as the sampler.
    std::function<Method(const Scene&, RenderOptions&)> make = {};

    int number() const { return std::stoi(name); }
    /// Whether it is a chapter with an option, and not the chapter as it is.
    bool is_variant() const { return name.size() > 2; }
    /// Whether it never samples lights: it has more noise, and finds no lights without size.
    bool random_hits() const { return search == LightSearch::random_hits; }
    /// Whether it blurs light: all of it (23, 24), or that of mirrors and glass (25).
    bool biased() const { return blurs() || search == LightSearch::merging; }
    bool blurs() const { return search == LightSearch::photons; }
};

/// Adds rows to the table: `static const Rows added = {{...}, {...}};`
struct Rows {
    Rows(std::initializer_list<NamedMethod> rows);
};

/// All methods, sorted by name.
const std::vector<NamedMethod>& all_methods();

/// The methods of these names, or UsageError. "all": every chapter; "09+": chapter 09 and its
/// variants.
std::vector<NamedMethod> methods_named(const std::vector<std::string>& names);

/// The method of this name for a scene, ready to trace.
Method method(const std::string& name, const Scene& scene);

/// Renders the whole film: unbiased for any seed, spp and threads of the options unless the method
/// is biased; with options.split it has the films of the classes as well.
Rendering render(const NamedMethod& method, const Scene& scene, RenderOptions options);

/// Throws InputError when the method cannot render the scene.
void refuse(const NamedMethod& method, const Scene& scene);
/// Whether the method can render the scene.
bool can_render(const NamedMethod& method, const Scene& scene);
