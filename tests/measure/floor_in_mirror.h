// A floor that a point light reaches after one reflection in a mirror, and that the camera sees in
// the mirror: paths of class LSDSE alone, which only photons find. Every pixel is known exactly.
#pragma once
#include "chapters/25_vertex_merging/estimator.h"
#include "common/rendering/render_film.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

/// The mirror is at height 1, and the light just below it: its image is at height h over the floor.
struct FloorInMirror {
    static constexpr int side = 8;  // pixels
    static constexpr double h = 1.05;
    static constexpr PhotonSettings settings{.light_paths = 1000, .radius = 0.6f};
    Scene scene = parse_scene("floor in a mirror", R"(
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Integrator "path" "integer maxdepth" 3
LookAt 0 0.2 0  0 1 0  0 0 1 Camera "perspective" "float fov" 60
WorldBegin
LightSource "point" "rgb I" [1 1 1] "point3 from" [0 0.95 0]
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-5 0 -5  -5 0 5  5 0 5  5 0 -5]
Material "conductor" "rgb reflectance" [1 1 1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 1 -2  2 1 -2  2 1 2  -2 1 2]
)",
                              nullptr);

    FloorInMirror() { prepare(scene, 1); }

    /// Radiance of the floor whose squared distance from the middle is d2, m^2.
    ///     rho / pi  I h / (h^2 + d2)^(3/2)
    static double radiance(double d2) { return 0.5 / double{pi} * h / std::pow(h * h + d2, 1.5); }

    /// What a pixel shows by photons of this radius, without noise; radius 0: the truth.
    static double pixel(int i, double radius) {
        constexpr int n = 8, angles = 16;
        double half = 1.8 * std::tan(double{pi} / 6), sum = 0;  // of the picture, on the floor
        for (int k = 0; k < n * n; k++) {
            double x = half * (2 * (i % side + (k % n + 0.5) / n) / side - 1);
            double y = half * (2 * (i / side + (k / n + 0.5) / n) / side - 1);
            for (int at = 0; at < n * angles; at++) {
                double u2 = (at % n + 0.5) / n, phi = 2 * double{pi} * at / (n * angles);
                double u = radius * std::sqrt(u2);
                double vx = x + u * std::cos(phi), vy = y + u * std::sin(phi);
                sum += 2 * (1 - u2) * radiance(vx * vx + vy * vy) / (n * n * n * angles);
            }
        }
        return sum;
    }

    /// Mean over the pixels of the squared relative error.
    template <typename Pixel>
    static double error(const Pixel& picture) {
        double sum = 0;
        for (int i = 0; i < side * side; i++) {
            double relative = picture(i) / pixel(i, 0) - 1;
            sum += relative * relative / (side * side);
        }
        return sum;
    }
    /// Of photons of the first radius without noise: the square of the bias.
    static double bias2() {
        return error([=](int i) { return pixel(i, double{settings.radius}); });
    }

    /// Of a render of chapter 25 whose radius shrinks, or stays.
    double error(int passes, bool shrinks, uint32_t seed) const {
        Scene own = scene;
        own.spp = passes;
        PhotonSettings of_seed = settings;
        of_seed.seed = seed;
        RenderOptions options;
        options.seed = seed, options.threads = 1, options.quiet = true, options.paths = "LSDSE";
        Method trace = shrinks ? ch25::merging_passes(own, of_seed) : with_one_radius(own, of_seed);
        Image image = render_film(own, options, trace).film.image();
        return error([&](int i) { return double{image.pixels[static_cast<size_t>(i)].g}; });
    }

    /// Chapter 25 whose every pass is a first pass, with light paths of its own.
    static Method with_one_radius(const Scene& scene, const PhotonSettings& of_seed) {
        auto now = std::make_shared<Method>();
        Method method;
        method.prepare = [=, &scene](uint32_t pass, int threads, const Stopped& stopped) {
            PhotonSettings own = of_seed;
            own.seed = of_seed.seed * 1000003u + pass;
            *now = ch25::merging_passes(scene, own);
            now->prepare(0, threads, stopped);
        };
        method.splats = true;
        method.trace = [=](const Scene& s, const Ray& ray, Splats& splats, Sampler& sampler,
                           Recorder& recorder) {
            return now->trace(s, ray, splats, sampler, recorder);
        };
        return method;
    }
};
