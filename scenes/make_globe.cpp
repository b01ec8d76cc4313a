// Writes globe.pfm: a map of a planet that does not exist, by longitude and latitude.
// usage: make_globe FILE.pfm
#include "common/base/error.h"
#include "common/picture/image.h"
#include "common/render/options.h"

namespace {

/// The height of the land at a point of the unit sphere; below 0: sea.
float height(Vec3 p) {
    float h = -0.1f;
    Vec3 wave = {1.9f, -1.3f, 2.3f};
    for (float size : {0.5f, 0.35f, 0.2f, 0.12f, 0.07f}) {
        h += size * std::sin(dot(p, wave) + 3 * wave.y);
        wave = 1.7f * Vec3{wave.z, -wave.x, wave.y};
    }
    return h;
}

Rgb ground(Vec3 p) {
    float h = height(p), cold = std::abs(p.z) + 0.1f * h;
    if (cold > 0.93f) return {0.85f, 0.87f, 0.9f};  // ice
    if (h < 0) return {0.04f, 0.2f + 0.15f * std::max(h, -1.0f), 0.5f};
    float dry = std::max(0.0f, 1 - 3 * std::abs(std::abs(p.z) - 0.35f));
    return Rgb{0.12f, 0.3f, 0.06f} + dry * Rgb{0.5f, 0.25f, 0.14f};
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        if (argc != 2) throw UsageError("usage: make_globe FILE.pfm");
        Image image(384, 192);
        for (int y = 0; y < image.height; y++) {
            for (int x = 0; x < image.width; x++) {
                float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(image.width);
                float theta =
                    pi * (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height);
                bool on_line = x % 32 == 0 || y % 32 == 0;  // one in 30 degrees
                Rgb here = ground(from_cylindrical(std::sin(theta), u, std::cos(theta)));
                image.at(x, y) = on_line ? 0.5f * here : here;
            }
        }
        write_image(argv[1], image, "");
        return 0;
    });
}
