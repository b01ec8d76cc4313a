// The programs of all chapters as one module for a page: which of them runs, the name that it is
// called by tells; and instead of a film being written now and then, the page gets a picture.
#include <emscripten.h>
#include <programs.h>  // written by rules.mk: of each program its name and its main()

#include <algorithm>
#include <cstdio>
#include <string>

#include "common/render/render.h"

/// Hands the picture to the page: of each pixel r, g, b and its number of samples.
EM_JS(void, show, (int width, int height, const float* pixels, double mean, double error), {
    const at = pixels / 4;
    Module.show(width, height, HEAPF32.slice(at, at + 4 * width * height), mean, error);
});

double save_meanwhile(const Scene&, const RenderOptions&, const Rendering& rendering,
                      double interval) {
    const Film& film = rendering.film;
    Image image = film.image();
    std::vector<float> pixels;
    pixels.reserve(4 * image.pixels.size());
    for (size_t i = 0; i < image.pixels.size(); i++) {
        Rgb L = image.pixels[i];
        pixels.insert(pixels.end(), {L.r, L.g, L.b, static_cast<float>(film.count_of(i))});
    }
    show(film.width, film.height, pixels.data(), film.mean(), film.standard_error());
    // Soon after the start often; later more seldom, since drawing takes time from the workers.
    return std::min(1.5 * interval, 1.0);
}

int main(int argc, char** argv) {
    for (const Program& program : programs) {
        if (std::string("build/") + program.name == argv[0]) return program.main(argc, argv);
    }
    std::fprintf(stderr, "error: no program %s\n", argv[0]);
    return 2;
}
