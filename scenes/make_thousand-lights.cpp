// Writes thousand-lights.pbrt: a floor and boxes under 1000 small lights of very unequal power.
// usage: make_thousand-lights FILE.pbrt
#include <string>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/render/options.h"

namespace {

constexpr const char* head =
    R"(# A floor with boxes under 1000 square lights that shine downwards, their powers spread
# evenly in the logarithm from 0.0008 to 8 W. Written by make_thousand-lights.cpp.
# Shows: how many lights there are must cost nothing, and which of them are asked decides all.
# True of its picture: no light is seen from its front, so it is black with --max-depth 0. The mean
# is the same however lights are chosen; chosen all alike, most give next to nothing.
Film "rgb" "integer xresolution" [256] "integer yresolution" [256]
PixelFilter "box"
Sampler "independent" "integer pixelsamples" [64]
Integrator "path" "integer maxdepth" [8]
LookAt 0 8 -13  0 0.4 -0.5  0 1 0
Camera "perspective" "float fov" [42]
WorldBegin

Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point3 P" [-12 0 -12  -12 0 12  12 0 12  12 0 -12]
)";

double between(Sampler& sampler, double low, double high) {
    return low + (high - low) * double{sampler.u1()};
}

/// A box on the floor, and its grey.
std::string box(Sampler& sampler, double x, double z) {
    double grey = between(sampler, 0.35, 0.75), side = between(sampler, 0.6, 1.2);
    double height = between(sampler, 0.3, 1), angle = between(sampler, 0, 90);
    std::string box = format(
        "AttributeBegin\n  Material \"diffuse\" \"rgb reflectance\""
        " [%.3f %.3f %.3f]\n",
        grey, grey, grey);
    box += format("  Translate %.3f 0 %.3f Rotate %.1f 0 1 0 Scale %.3f %.3f %.3f\n", x, z, angle,
                  side, height, side);
    return box +
           "  Shape \"trianglemesh\" \"point3 P\"\n"
           "    [-1 0 -1  1 0 -1  1 0 1  -1 0 1  -1 1 -1  1 1 -1  1 1 1  -1 1 1]\n"
           "    \"integer indices\" [4 7 6 4 6 5  0 4 5 0 5 1  1 5 6 1 6 2\n"
           "    2 6 7 2 7 3  3 7 4 3 4 0]\nAttributeEnd\n";
}

/// A square light; tilted at random, but never so far that the camera sees its front.
std::string light(Sampler& sampler) {
    double x = between(sampler, -9, 9), y = between(sampler, 1.5, 2.8), z = between(sampler, -9, 9);
    double turn = between(sampler, 0, 360), tilt = between(sampler, 0, 12);
    double half = between(sampler, 0.02, 0.08), warm = between(sampler, 0.75, 1.25);
    double power = 0.0008 * std::pow(1e4, between(sampler, 0, 1));
    double L = power / (std::numbers::pi * 4 * half * half);
    return format("AttributeBegin\n  AreaLightSource \"diffuse\" \"rgb L\" [%.5g %.5g %.5g]\n",
                  L * warm, L, L * (2 - warm)) +
           format("  Translate %.3f %.3f %.3f Rotate %.1f 0 1 0 Rotate %.1f 1 0 0\n", x, y, z, turn,
                  tilt) +
           format(
               "  Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
               "    \"point3 P\" [%.4f 0 %.4f  %.4f 0 %.4f  %.4f 0 %.4f  %.4f 0 %.4f]\n"
               "AttributeEnd\n",
               -half, -half, half, -half, half, half, -half, half);
}

std::string thousand_lights() {
    Sampler sampler(SamplerType::independent, 1, 1);
    sampler.start(0, 0);
    std::string text = head;
    for (int i = 0; i < 12; i++) {
        double x = -6 + 4 * (i % 4) + between(sampler, -0.8, 0.8);
        double z = -4 + 4.5 * (i / 4) + between(sampler, -0.8, 0.8);
        text += box(sampler, x, z);
    }
    text += "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
    for (int i = 0; i < 1000; i++) text += light(sampler);
    return text;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        if (argc != 2) throw UsageError("usage: make_thousand-lights FILE.pbrt");
        write_file_atomically(argv[1], thousand_lights());
        return 0;
    });
}
