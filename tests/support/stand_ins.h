// Stand-ins for scenes and for a chapter's trace(), where only the loop around them is tested.
#pragma once
#include "common/path/sampler.h"
#include "common/recording/recorder.h"
#include "common/render/options.h"
#include "tests/support/scenes.h"

inline Scene empty_scene(int width, int height, int spp) {
    Scene scene = scene_of(
        "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
        "Shape \"sphere\"\n");
    scene.width = width;
    scene.height = height;
    scene.spp = spp;
    return scene;
}

inline RenderOptions stand_in_options(int threads = 2) {
    RenderOptions options;
    options.name = "stand_in";
    options.command = "build/stand_in --spp 4";
    options.threads = threads;
    options.quiet = true;
    return options;
}

/// The options that a chapter reads from its command line.
inline RenderOptions parsed(std::vector<std::string> words, const std::vector<Option>& extra = {},
                            const std::vector<std::string>& takes = {}) {
    words.insert(words.begin(), "build/07_x");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return parse_render_options(static_cast<int>(argv.size()), argv.data(), "07_x",
                                {"scenes/a.pbrt", 0}, extra, takes);
}
