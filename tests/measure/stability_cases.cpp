#include "tests/measure/stability_cases.h"

#include <cstdio>

#include "common/scene_file/reader.h"
#include "tests/measure/stability_theory.h"

namespace {

using std::numbers::pi;

constexpr int N = 1000;  // samples of a run

template <typename... Args>
std::string format(const char* pattern, Args... args) {
    char text[2000];
    std::snprintf(text, sizeof text, pattern, args...);
    return text;
}

/// One pixel of a thousandth of a degree, and grey paint.
std::string look(const std::string& from_to_up, int max_depth = 100, double fov = 0.001) {
    return format(
        "Film \"rgb\" \"integer xresolution\" [1] \"integer yresolution\" [1]\n"
        "Integrator \"path\" \"integer maxdepth\" [%d]\nLookAt %s\n"
        "Camera \"perspective\" \"float fov\" [%g]\nWorldBegin\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n",
        max_depth, from_to_up.c_str(), fov);
}

/// From here on all is black; after `lamp` it shines as well.
constexpr const char* black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
const std::string lamp = std::string("AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n") + black;
constexpr const char* mirror = "Material \"conductor\" \"rgb reflectance\" [1 1 1]\n";
constexpr const char* sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

/// Four corners.
std::string quad(const std::string& corners) {
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + corners +
           "]\n";
}
const std::string ground = quad("-50 0 -50  -50 0 50  50 0 50  50 0 -50");

/// A disk that looks down from height h.
std::string disk(double radius, double h) {
    return format("Translate 0 %g 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [%.9g]\n", h,
                  radius);
}

Prediction relvar(double x) { return {Metric::relative_variance, x}; }
Prediction bad_relvar(double x) { return {Metric::relative_variance, x, true}; }
Prediction variance_of(const Outcomes& all, bool fails = false) {
    double variance = relative_moment(all, 2), fourth = relative_moment(all, 4);
    double spread = std::sqrt(std::max(0.0, fourth - variance * variance));
    return {Metric::relative_variance, variance, fails, false, spread};
}
Prediction covers(double x) { return {Metric::coverage, x}; }
Prediction bad_coverage(double x) { return {Metric::coverage, x, true}; }

/// A disk light of radius 1 at height h: under its middle, the ground is seen from in between.
StabilityCase near_disk(double h) {
    double hit = 1 / (1 + h * h);
    std::vector<Part> seen = rings(h / std::sqrt(1 + h * h), 1);
    // Draws from the square around the disk; what misses the disk is 0.
    auto by_square = [=](const Part&) { return 1 / (4 * std::asin(hit)); };
    auto by_area = [=](const Part& p) { return h * h / (p.cos * p.cos * p.cos * pi); };
    StabilityCase::Expected area{{"09-area"}, {relvar(variance_by(seen, by_area))}};
    if (h < 0.5) {
        // By the same samples without a renderer: 2000 runs of 1000.
        area.predictions = {bad_relvar(variance_by(seen, by_area)), covers(0.918)};
    }
    if (h < 0.05) {
        area.predictions = {{Metric::below_half, 0.649, true}, bad_coverage(0.382)};
    }
    double covered = coverage_of_rare(hit, N);
    return {
        format("disk light %g above", h),
        look(format("0 %g -%g  0 0 0  0 1 0", 0.5 * h, h)) + ground + lamp + disk(1, h),
        0.5 * hit,
        N,
        {{{"07", "08"}, {relvar(variance_by(seen, pdf_uniform))}},
         area,
         {{"09", "10", "11", "12", "13"}, {relvar(variance_by(seen, by_square))}},
         {{"14", "15", "16"}, {relvar(variance_of_mis(seen, by_square, pdf_cosine))}},
         {{"13-bsdf"}, {relvar(h * h), covered < 0.5 ? bad_coverage(covered) : covers(covered)}}}};
}

/// So small that most runs of what does not sample lights see nothing, and claim an error of 0.
StabilityCase small_light() {
    double hit = 1 / 10001.0, hit_uniform = 1 - 1 / std::sqrt(1.0001);
    auto misses = [](double p) {
        return std::vector<Prediction>{{Metric::black, std::pow(1 - p, N), true},
                                       bad_coverage(coverage_of_rare(p, N))};
    };
    return {"light of 1 cm, 1 m above",
            look("0 0.5 -1  0 0 0  0 1 0") + ground + lamp + disk(0.01, 1),
            0.5 * hit,
            N,
            {{{"07", "08"}, misses(hit_uniform)},
             {{"13-bsdf"}, misses(hit)},
             {{"09", "10", "11", "12", "13", "14", "15", "16"},
              {{Metric::relative_variance, 1e-3, false, true}}}}};
}

/// Two point lights, the other one with 1000 times the power of the near one: far away, where it
/// gives a thousandth, or behind a plate.
StabilityCase two_points(bool hidden) {
    Choice other{1000.0 / 1001, hidden ? 250 : 1e-3, hidden ? 0 : 1e-3}, near{1 / 1001.0, 1, 1};
    auto with_pmf = [](Choice c, double pmf) { return Choice{pmf, c.p_hat, c.f}; };
    auto shared = [&](Choice c) { return with_pmf(c, 0.75 * c.pmf + 0.125); };
    // Behind the wall all is in the few samples that keep the near light.
    auto of_ris = [&](int M) {
        Prediction spread = variance_of(resampled(shared(other), shared(near), M), hidden);
        std::vector<Prediction> all = {spread};
        if (hidden) all.push_back(covers(coverage_of_rare(1 / (1 + spread.value), N)));
        return all;
    };
    auto even = chosen(with_pmf(other, 0.5), with_pmf(near, 0.5));
    return {hidden ? "bright light behind a wall" : "far and bright, near and weak",
            look("0 0.5 -1  0 0 0  0 1 0") + ground +
                "LightSource \"point\" \"point3 from\" [0 1 0]\n"
                "LightSource \"point\" \"rgb I\" [1000 1000 1000] \"point3 from\" " +
                (hidden ? "[0 2 0]\n" : "[0 1000 0]\n") + (hidden ? black + disk(1, 1.5) : ""),
            0.5 / pi * (near.f + other.f),
            N,
            {{{"09", "10"}, {variance_of(even)}},
             {{"11", "13", "14"}, {variance_of(chosen(shared(other), shared(near)))}},
             {{"12-m2"}, of_ris(2)},
             {{"12"}, of_ris(16)},
             {{"12-m32"}, of_ris(32)},
             {{"15", "15-m16"}, {relvar(0)}}},
            {"07", "08", "13-bsdf"}};
}

/// The point light of before, and two of 1000 times its power, both behind a plate. Of three lights
/// chapter 15 samples two, the likelier the more they could give: seldom the one that is seen.
StabilityCase two_hidden_points() {
    double power[] = {1, 1000, 1000}, w[] = {1, 250, 250};
    double mean = (w[0] + w[1] + w[2]) / 3, inclusion = 2 * (w[0] + mean / 9) / (3 * mean * 10 / 9);
    double pmf = 0.75 * power[0] / 2001 + 0.25 / 3;
    std::string bright = "LightSource \"point\" \"rgb I\" [1000 1000 1000] \"point3 from\" ";
    return {"two bright lights behind a wall",
            look("0 0.5 -1  0 0 0  0 1 0") + ground +
                "LightSource \"point\" \"point3 from\" [0 1 0]\n" + bright + "[0 2 0]\n" + bright +
                "[0 2 0]\n" + black + disk(1, 1.5),
            0.5 / pi,
            N,
            {{{"09", "10"}, {relvar(2)}},
             {{"11", "13", "14"}, {relvar(1 / pmf - 1)}},
             {{"15", "15-m16", "16"}, {relvar(1 / inclusion - 1)}}},
            {"07", "08", "13-bsdf"}};
}

/// A level ground under a black roof: the white sky shows below the elevation whose sine is e.
StabilityCase horizon(double e) {
    double height = 3;
    std::vector<Part> seen = rings(0, e);
    return {format("sky below sine %g", e),
            look("0 1 -2  0 0 0  0 1 0") + sky + ground + black +
                disk(height * std::sqrt(1 / (e * e) - 1), height),
            0.5 * e * e,
            N,
            {{{"07", "08", "09"}, {relvar(4 / (3 * e) - 1)}},
             {{"10", "11", "12", "13", "13-bsdf"}, {bad_relvar(1 / (e * e) - 1)}},
             {{"14", "15", "16"}, {relvar(variance_of_mis(seen, pdf_uniform, pdf_cosine))}}}};
}

/// Ground under scenes/sky.pfm, of which a sun has half the light; or under a black roof that hides
/// all of it but the haze below the elevation whose sine is 0.1: most light samples go to the sun.
StabilityCase sky_with_a_sun(bool roof) {
    std::string image =
        "AttributeBegin Rotate -90 1 0 0\n"
        "LightSource \"infinite\" \"string filename\" \"scenes/sky.pfm\" AttributeEnd\n";
    std::string text = look("0 1 -2  0 0 0  0 1 0", 1) + image + ground;
    const SkyImage dome = *parse_scene("sky", text, nullptr).sky_image;
    double pixels = static_cast<double>(dome.pixels.size()), mean = 0, truth = 0;
    for (Rgb L : dome.pixels) mean += double{average(L)} / pixels;
    std::vector<Part> seen;
    std::vector<double> all, above;  // densities, but for a factor
    double sum_above = 0;
    constexpr int n = 8;
    for (size_t i = 0; i < dome.pixels.size(); i++) {
        double L = double{average(dome.pixels[i])}, more = std::max(0.0, L - mean);
        sum_above += more / pixels;
        for (int k = 0; k < n * n; k++) {
            Vec2 u = {(static_cast<float>(k % n) + 0.5f) / n,
                      (static_cast<float>(k / n) + 0.5f) / n};
            double cos = double{direction_of(dome, dome.point_in(i, u)).y};
            if (cos <= 0 || (roof && cos > 0.1)) continue;
            seen.push_back({cos, L * cos * 0.5 / pi, 4 * pi / pixels / (n * n)});
            truth += seen.back().value * seen.back().omega;
            all.push_back(L / mean / (4 * pi)), above.push_back(std::max(more / (4 * pi), 1e-30));
        }
    }
    for (double& pdf : above) pdf /= sum_above;
    auto by = [&](const std::vector<double>& pdf) {
        auto of_part = [&](const Part& p) { return pdf[static_cast<size_t>(&p - seen.data())]; };
        double x = variance_of_mis(seen, of_part, pdf_cosine);
        return roof ? bad_relvar(x) : relvar(x);
    };
    return {roof ? "haze below a roof" : "sky with a sun",
            text + (roof ? black + disk(3 * std::sqrt(99.0), 3) : ""),
            truth,
            N,
            {{{"17", "18"}, {by(above)}}, {{"17-plain"}, {by(all)}}},
            {"07", "08", "09", "10", "11", "12", "13", "14", "15", "16"}};
}

/// A lamp with its back to the ground, under a mirror in which the eye sees the ground: LSDSE, met
/// by chance alone: no strategy of both ends makes it. 22 takes sixteen samples for one.
StabilityCase lit_and_seen_by_mirror() {
    double d2 = 1, h2 = 1.8 * 1.8, r2 = 0.1 * 0.1, sum = d2 + h2 + r2;
    double hit = 0.5 * (1 - (d2 + h2 - r2) / std::sqrt(sum * sum - 4 * d2 * r2));  // form factor
    return {"ground lit and seen by a mirror",
            look("0 0.5 -0.5  0 2 0  0 1 0", 3) +
                "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n" + ground + mirror +
                quad("-9 1 -9  9 1 -9  9 1 9  -9 1 9") + lamp +
                "Translate 1 0.2 0 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" [0.1]\n",
            hit,
            N,
            {{{"10", "11", "12", "13", "13-bsdf", "14", "15", "16", "21", "22-weights"},
              {bad_relvar(1 / hit - 1), covers(coverage_of_rare(hit, N))}},
             {{"22"}, {bad_relvar((1 / hit - 1) / 16)}}},
            {"20"}};
}

/// Sunlight from a mirror, near the edge of the floor: t times the radius of 23-few, 1 cm, away
/// from it. Photons are missing beyond the edge, so the floor looks too dark there.
///
///   share(t) = 8 / (3 pi) times the integral of (1 - x^2)^1.5 from -t to 1      (kernel of 23)
///
/// Chapters 24 and 25: the mean of the shares of all passes, whose radius shrinks. If the camera
/// sees the floor in the mirror as well, no connection finds this light: only photons do.
StabilityCase edge_by_photons(double t, bool in_the_mirror) {
    std::string world = "LightSource \"distant\" \"point3 from\" [0 0 0] \"point3 to\" [-1 1 0]\n" +
                        quad("-0.5 0 -0.5  -0.5 0 0.5  0 0 0.5  0 0 -0.5") + mirror +
                        quad("0.5 1 -0.5  1.5 1 -0.5  1.5 1 0.5  0.5 1 0.5");
    auto view = [&](double x) {
        std::string above = format("%g 0.5 0  %g 0 0  0 0 1", x, x);
        std::string by_mirror = format("1.8 0.2 0  %g 2 0  0 0 1", x);  // the floor's image: y = 2
        return (in_the_mirror ? look(by_mirror, 3) : look(above, 2)) + world;
    };
    double away = t * 0.01;
    auto share = [](double at) {
        constexpr int n = 1000;
        double sum = 0, width = (1 + std::min(at, 1.0)) / n;
        for (int i = 0; i < n; i++) sum += std::pow(1 - std::pow(1 - (i + 0.5) * width, 2), 1.5);
        return 8 / (3 * pi) * sum * width;
    };
    auto shrinking_from = [&](double radius) {
        double r2 = radius * radius, mean = 0;
        for (double i = 1; i <= N; i++) {
            mean += share(away / std::sqrt(r2)) / N;
            r2 *= (i + 2.0 / 3) / (i + 1);
        }
        return mean;
    };
    // About ten photons in a run.
    auto too_dark = [](double mean) {
        return std::vector<Prediction>{{Metric::mean, mean, true},
                                       {Metric::coverage, 0.95, true, true}};
    };
    StabilityCase c{in_the_mirror ? "the same edge, seen in the mirror"
                                  : "light near the floor's edge, by a mirror",
                    view(-away),
                    0.5 / pi * std::numbers::sqrt2 / 2,
                    N,
                    {{{"23-few"}, too_dark(share(t))},
                     {{"24-few"}, too_dark(shrinking_from(0.015))},
                     {{"25-few"}, too_dark(shrinking_from(0.02))}}};
    if (in_the_mirror) {
        std::vector<Prediction> nothing = {
            {Metric::mean, 0, true}, {Metric::black, 1, true}, {Metric::coverage, 0, true}};
        c.expected.push_back({{"15", "21", "22"}, nothing});
    }
    return c;
}

}  // namespace

std::vector<StabilityCase> stability_cases() {
    return {near_disk(1),
            near_disk(0.1),
            near_disk(0.01),
            small_light(),
            two_points(false),
            two_points(true),
            two_hidden_points(),
            horizon(0.1),
            sky_with_a_sun(false),
            sky_with_a_sun(true),
            lit_and_seen_by_mirror(),
            edge_by_photons(0.25, false),
            edge_by_photons(0.25, true)};
}
