// Writes zone-plate.pbrt: rings of equal area, so narrow at the rim that pixels cannot show them.
// usage: make_zone-plate FILE.pbrt
#include <cmath>
#include <cstdio>
#include <string>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/options/command_line.h"

constexpr const char* head =
    R"(# A zone plate: white disks and black ones in turn, each nearer to the camera than the last
# and smaller, so that rings of equal area are seen. Written by make_zone-plate.cpp.
# Shows: a pixel is the mean over an area. Rings narrower than a pixel are grey; one point in each
# pixel sees rings that are not there.
# True of its picture: rings around the middle alone, fading into an even grey of one half.
Film "rgb" "integer xresolution" [256] "integer yresolution" [256]
PixelFilter "box"
Sampler "independent" "integer pixelsamples" [16]
Integrator "path" "integer maxdepth" [0]
LookAt 0 0 -10  0 0 0  0 1 0
Camera "perspective" "float screenwindow" [-0.1 0.1 -0.1 0.1] "float fov" [90]
WorldBegin

)";

int main(int argc, char** argv) {
    return run_program([&] {
        if (argc != 2) throw UsageError("usage: make_zone-plate FILE.pbrt");
        constexpr int rings = 400;
        std::string scene = head;
        for (int i = 0; i <= rings; i++) {
            double radius = 1.5 * std::sqrt((rings + 1 - i) / (rings + 1.0)), z = -1e-5 * i;
            char disk[400];
            const char* light =
                i % 2 == 0 ? "AreaLightSource \"diffuse\" \"bool twosided\" true " : "";
            std::snprintf(
                disk, sizeof disk,
                "AttributeBegin %sMaterial \"diffuse\" \"rgb reflectance\" [0 0 0] Translate "
                "0 0 %.6f Shape \"disk\" \"float radius\" %.9f AttributeEnd\n",
                light, z, radius);
            scene += disk;
        }
        write_file_atomically(argv[1], scene);
        return 0;
    });
}
