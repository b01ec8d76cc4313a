#include "tests/measure/stability_cases.h"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace {

using std::numbers::pi;

template <typename... Args>
std::string format(const char* pattern, Args... args) {
    char text[2000];
    std::snprintf(text, sizeof text, pattern, args...);
    return text;
}

/// One pixel of a thousandth of a degree.
std::string look(const char* from_to_up, int max_depth) {
    return format(
        "Film \"rgb\" \"integer xresolution\" [1] \"integer yresolution\" [1]\n"
        "Integrator \"path\" \"integer maxdepth\" [%d]\nLookAt %s\n"
        "Camera \"perspective\" \"float fov\" [0.001]\nWorldBegin\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n",
        max_depth, from_to_up);
}

constexpr const char* floor_quad =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
    "  \"point3 P\" [-50 0 -50  -50 0 50  50 0 50  50 0 -50]\n";

/// A disk of radius `r` at height h that shines down on the floor, seen from between.
std::string disk_over_floor(double r, double h) {
    return look(format("0 %g -%g  0 0 0  0 1 0", 0.5 * h, h).c_str(), 1) + floor_quad +
           format(
               "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
               "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
               "Translate 0 %g 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [%g]\n",
               h, r);
}

/// Reflected radiance under the middle of that disk: albedo r^2 / (r^2 + h^2).
double under_disk(double r, double h) { return 0.5 * r * r / (r * r + h * h); }

/// Relative variance of sampling the disk by area.      source  integral of 1 / distance^8
double variance_by_area(double r, double h) {
    double k = h / r, a = 1 + k * k;
    return a * a * (1 / (k * k) - k * k * k * k / (a * a * a)) / 3 - 1;
}

/// A wall, and at its top a unit square that shines down; the point is z below their edge.
std::string wall_under_light(double z) {
    return look(format("0 -%g 2  0 -%g 0  0 1 0", z, z).c_str(), 1) +
           "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
           "  \"point3 P\" [-5 -5 0  5 -5 0  5 0 0  -5 0 0]\n"
           "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
           "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
           "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
           "  \"point3 P\" [-0.5 0 0  0.5 0 0  0.5 0 1  -0.5 0 1]\n";
}

double on_wall(double z) {
    double a = std::sqrt(1 + z * z);
    return 0.5 / pi * (std::atan(1 / (2 * z)) - z / a * std::atan(1 / (2 * a)));
}

/// Two point lights over a floor: `bright` times 1000 m away, and one of the same contribution 1
/// over pi times the albedo near; `blocked`: a plate keeps the bright one out.
std::string two_points(bool blocked) {
    std::string text = look("0 0.5 -1  0 0 0  0 1 0", 1) + floor_quad +
                       "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 1 0]\n"
                       "LightSource \"point\" \"rgb I\" [1000 1000 1000] \"point3 from\" " +
                       std::string(blocked ? "[0 2 0]\n" : "[0 1000 0]\n");
    if (!blocked) return text;
    return text + "Translate 0 1.5 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [1]\n";
}

/// A light that is drawn with probability pmf, and what it gives to the candidates' competition
/// (p_hat) and, if it is seen, to the estimate (f).
struct Choice {
    double pmf, p_hat, f;
};

/// Relative variance of RIS over two lights: the sum over how many of M candidates are the second.
///
///   E[X^2] = sum_k Binomial(M, k) sum over the winner y of  w_y / weight_sum (f_y W)^2
double variance_of_ris(Choice a, Choice b, int M) {
    double mean = 0, squares = 0, ways = 1;
    for (int k = 0; k <= M; k++) {
        double chance = ways * std::pow(a.pmf, M - k) * std::pow(b.pmf, k);
        double weight_a = (M - k) * a.p_hat / a.pmf, weight_b = k * b.p_hat / b.pmf;
        double sum = weight_a + weight_b;
        for (auto [weight, light] : {std::pair(weight_a, a), std::pair(weight_b, b)}) {
            if (weight == 0) continue;
            double x = light.f * sum / (M * light.p_hat);
            mean += chance * weight / sum * x;
            squares += chance * weight / sum * x * x;
        }
        ways = ways * (M - k) / (k + 1);
    }
    return squares / (mean * mean) - 1;
}

/// A level floor under a black roof: the sky shows below the elevation whose sine is 0.1.
std::string horizon() {
    return look("0 1 -2  0 0 0  0 1 0", 1) + "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" +
           floor_quad +
           "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
           "Translate 0 3 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [29.8496231]\n";
}

/// The inside of a sphere whose wall emits 1 and reflects `albedo`.
std::string closed_sphere(double albedo, int max_depth) {
    return look("0 0 0  0 0 1  0 1 0", max_depth) + "ReverseOrientation\n" +
           format(
               "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
               "Material \"diffuse\" \"rgb reflectance\" [%g %g %g]\n"
               "Shape \"sphere\" \"float radius\" [1]\n",
               albedo, albedo, albedo);
}

/// Inside a glass cube, towards a corner: total reflection on every side, for ever.
std::string glass_cube() {
    return look("0 0 0  1 1 1  0 1 0", 100) +
           "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
           "Material \"dielectric\" \"float eta\" [1.5]\n"
           "Shape \"trianglemesh\" \"integer indices\"\n"
           "  [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  1 2 6 1 6 5  2 3 7 2 7 6  3 0 4 3 4 7]\n"
           "  \"point3 P\" [-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1]\n";
}

/// A ball in a white sky, far from the origin, where floats are coarse.
std::string far_away() {
    return look("10000 0 -4  10000 0 0  0 1 0", 8) +
           "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
           "Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n"
           "Translate 10000 0 0 Shape \"sphere\" \"float radius\" [1]\n";
}

const std::vector<std::string> aiming = {"08", "09", "10", "11", "12"};

StabilityCase near_disk(double h, double coverage, double below_half) {
    auto relvar = [](double x) { return Prediction{Metric::relative_variance, x}; };
    Prediction bounded{Metric::relative_variance, 1.0 / 3, true};
    Prediction area{Metric::relative_variance, variance_by_area(1, h), false, true};
    if (h < 0.05) area = {Metric::below_half, below_half, false, true};
    double c = h / std::sqrt(1 + h * h);
    double by_uniform = 4 * pi * pi * (1 - c * c * c) / 3 / std::pow(pi / (1 + h * h), 2) - 1;
    return {format("disk light %g above", h),
            disk_over_floor(1, h),
            under_disk(1, h),
            1000,
            {{{"06", "07"}, {relvar(by_uniform)}},
             {{"12-bsdf"}, {relvar(h * h)}},
             {{"08-area"}, {area, {Metric::coverage, coverage, false, h < 0.05}}},
             {aiming, {bounded}}},
            {}};
}

}  // namespace

std::vector<StabilityCase> stability_cases() {
    auto relvar = [](double x, bool fails = false) {
        return Prediction{Metric::relative_variance, x, false, fails};
    };
    constexpr double d = 0.25;  // what chapter 10 deals out evenly
    auto share = [](double power) { return (1 - d) * power + d / 2; };
    Choice far = {share(1000.0 / 1001), 1e-3, 1e-3}, near = {share(1 / 1001.0), 1, 1};
    Choice hidden = {far.pmf, 250, 0};  // 1000 at twice the distance
    double choose_far = variance_of_ris(far, near, 1),
           by_half = variance_of_ris({0.5, 1e-3, 1e-3}, {0.5, 1, 1}, 1);
    double choose_hidden = variance_of_ris(hidden, near, 1), half_hidden = 1;
    return {
        near_disk(0.1, 0.918, 0),
        near_disk(0.01, 0.382, 0.649),
        {"wall 0.1 under a light's edge",
         wall_under_light(0.1),
         on_wall(0.1),
         1000,
         {{{"08-area"}, {relvar(6.423288931219, true)}}, {aiming, {relvar(0.3338560490858)}}},
         {}},
        {"light of 1 cm at 1 m",
         disk_over_floor(0.01, 1),
         under_disk(0.01, 1),
         1000,
         {{{"06", "07"}, {{Metric::black, std::pow(1 / std::sqrt(1.0001), 1000), false, true}}},
          {{"12-bsdf"}, {{Metric::black, std::pow(1 - 1 / 10001.0, 1000), false, true}}},
          {aiming, {{Metric::relative_variance, 1e-3, true}}}},
         {}},
        {"far bright, near weak",
         two_points(false),
         0.5 / pi * 1.001,
         1000,
         {{{"08", "09"}, {relvar(by_half)}},
          {{"10", "12"}, {relvar(choose_far)}},
          {{"11", "12-m8"}, {relvar(variance_of_ris(far, near, 8))}}},
         {"06", "07", "12-bsdf"}},
        {"bright light behind a wall",
         two_points(true),
         0.5 / pi,
         1000,
         {{{"08", "09"}, {relvar(half_hidden)}},
          {{"10", "12"}, {relvar(choose_hidden)}},
          {{"11", "12-m8"}, {relvar(variance_of_ris(hidden, near, 8), true)}}},
         {"06", "07", "12-bsdf"}},
        {"sky at the horizon",
         horizon(),
         0.5 * 0.01,
         1000,
         {{{"06", "07", "08"}, {relvar(4 / 0.3 - 1)}},
          {{"09", "10", "11"}, {relvar(99, true)}},
          {{"12"}, {relvar(49.5, true)}}},
         {}},
        {"closed sphere, albedo 0.5",
         closed_sphere(0.5, 60),
         2,
         1000,
         {{{"06"}, {relvar(0.125)}}, {{"07", "08", "09", "10", "11", "12"}, {}}},
         {}},
        {"the same, 0.8, cut after 4",
         closed_sphere(0.8, 4),
         5,
         1000,
         {{{"06", "07", "08", "09", "10", "11", "12"},
           {{Metric::mean, 1 - std::pow(0.8, 5), false, true}}}},
         {}},
        {"inside a glass cube",
         glass_cube(),
         0,
         100,
         {{{"06"}, {{Metric::cut, 1, false, true}}},
          {{"07", "08", "09", "10", "11", "12"}, {{Metric::cut, 0.05, true}}}},
         {}},
        {"ball 10,000 from the origin",
         far_away(),
         0.8,
         1000,
         {{{"06", "07", "08", "09", "10", "11", "12"}, {{Metric::mean, 1}}}},
         {}},
    };
}
