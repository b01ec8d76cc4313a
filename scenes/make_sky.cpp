// Writes sky.pfm: a sky with a small sun, as an equal-area square whose middle is the zenith.
// usage: make_sky FILE.pfm
#include <cstdio>

#include "common/base/error.h"
#include "common/picture/image.h"
#include "common/render/options.h"
#include "common/scene/sky_image.h"

/// 128 x 128 pixels, of which the sun has 2: half of the light from 10^-4 of the sphere.
int main(int argc, char** argv) {
    return run_program([&] {
        if (argc != 2) throw UsageError("usage: make_sky FILE.pfm");
        constexpr int side = 128;
        SkyImage sky;
        sky.width = sky.height = side;
        Image image(side, side);
        double light = 0;
        for (size_t i = 0; i < image.pixels.size(); i++) {
            Vec3 w = direction_of(sky, sky.middle_of(i));
            float haze = std::max(0.0f, 1 - std::abs(w.z)), below = w.z < -0.1f ? 0.1f : 1;
            haze *= haze * haze;
            image.pixels[i] =
                below * Rgb{0.25f + 0.6f * haze, 0.4f + 0.5f * haze, 0.8f + 0.3f * haze};
            light += double{average(image.pixels[i])};
        }
        Vec3 sun = normalize(Vec3{-0.7f, 0.45f, 0.75f});
        size_t place = sky.pixel_at(point_of(sky, sun));
        for (size_t pixel : {place, place + 1}) {
            float L = static_cast<float>(light / 2);
            image.pixels[pixel] = L * Rgb{1.1f, 1, 0.9f};
        }
        write_image(argv[1], image, "");
        return 0;
    });
}
