// For the chapters on photons: a scene whose light is not even, and how far a picture is off.
#pragma once
#include "tests/support/estimators.h"

/// A floor under a point light, by direct light alone: irradiance h / (h^2 + d^2)^(3/2).
inline Scene bulb_over_a_floor() {
    Scene scene = scene_of(
        "LookAt 0 1 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 60\n"
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
        "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 0.5 0]\n"
        "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Scale 2 1 2\n" +
        square(0, true));
    scene.max_depth = 1;
    return scene;
}

/// The mean over pixels of the square of the relative error.
inline double mean_squared_error(const Film& film, const Film& exact) {
    double sum = 0, n = static_cast<double>(film.pixels().size());
    for (size_t i = 0; i < film.pixels().size(); i++) {
        double error = film.pixels()[i].mean() / exact.pixels()[i].mean() - 1;
        sum += error * error / n;
    }
    return sum;
}
