// Scenes on which methods fail, and what theory says of how they do.
#pragma once
#include <string>
#include <vector>

/// What is measured over many runs of 1000 samples of one pixel.
enum class Metric {
    relative_variance,  // of one sample, Var X / E[X]^2
    coverage,           // share of the runs whose 95 % interval holds the truth
    below_half,         // share of the runs whose estimate is below half of the truth
    black,              // share of the runs that say 0 +- 0
    mean,               // of all runs, over the truth
};

/// A number that theory predicts.
struct Prediction {
    Metric metric;
    double value;
    bool fails = false;    // it is a failure
    bool at_most = false;  // the value is a bound
    double spread = 0;     // of a relative variance: standard deviation of one (X / E[X] - 1)^2
};

/// One scene, one pixel; `truth` is its radiance.
struct StabilityCase {
    std::string name;
    std::string scene;  // pbrt text
    double truth;
    struct Expected {
        std::string methods;  // names, with commas
        std::vector<Prediction> predictions = {};
    };
    std::vector<Expected> expected;
    std::string refuse = {};  // the methods that must refuse the scene
};

inline Prediction variance(double x, double spread = 0) {
    return {Metric::relative_variance, x, false, false, spread};
}
inline Prediction bad_variance(double x, double spread = 0) {
    return {Metric::relative_variance, x, true, false, spread};
}
inline Prediction covers(double x) { return {Metric::coverage, x}; }
inline Prediction bad_coverage(double x) { return {Metric::coverage, x, true}; }
inline Prediction black_runs(double x) { return {Metric::black, x, true}; }
/// Of photons, about ten in a run.
inline std::vector<Prediction> too_dark(double mean) {
    return {{Metric::mean, mean, true}, {Metric::coverage, 0.95, true, true}};
}

/// One pixel of a thousandth of a degree, and grey paint.
inline std::string look(const std::string& from_to_up, int max_depth = 100) {
    return "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
           "Integrator \"path\" \"integer maxdepth\" " +
           std::to_string(max_depth) + "\nLookAt " + from_to_up +
           "\nCamera \"perspective\" \"float fov\" 0.001\nWorldBegin\n"
           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n";
}
inline std::string quad(const std::string& corners) {
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + corners +
           "]\n";
}
/// A disk that looks down from a height.
inline std::string disk(const std::string& radius, const std::string& height) {
    return "Translate 0 " + height + " 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" " +
           radius + "\n";
}

inline std::vector<StabilityCase> stability_cases() {
    // From here on all is black; after `lamp` it shines as well.
    const std::string black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
    const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n" + black;
    const std::string mirror = "Material \"conductor\" \"rgb reflectance\" [1 1 1]\n";
    const std::string ground = quad("-50 0 -50  -50 0 50  50 0 50  50 0 -50");
    const std::string near_view = look("0 0.5 -1  0 0 0  0 1 0");
    // A point light of intensity 1, and others with 1000 times its power.
    const std::string point = "LightSource \"point\" \"point3 from\" [0 1 0]\n";
    const std::string bright = "LightSource \"point\" \"rgb I\" [1000 1000 1000] \"point3 from\" ";
    const std::string wall = black + disk("1", "1.5");
    const std::string random_hits = "07,08,13-bsdf";
    // A black roof: the sky shows below the elevation whose sine is 0.1.
    const std::string roof = black + disk("29.8496231", "3"), level = "0 1 -2  0 0 0  0 1 0";
    const std::string sun =
        look(level, 1) +
        "AttributeBegin Rotate -90 1 0 0\n"
        "LightSource \"infinite\" \"string filename\" \"scenes/sky.pfm\" AttributeEnd\n" +
        ground;
    const std::string before_17 = "07,08,09,10,11,12,13,14,15,16";
    // Sunlight from a mirror, 2.5 mm from the edge of the floor.
    const std::string edge =
        "LightSource \"distant\" \"point3 from\" [0 0 0] \"point3 to\" [-1 1 0]\n" +
        quad("-0.5 0 -0.5  -0.5 0 0.5  0 0 0.5  0 0 -0.5") + mirror +
        quad("0.5 1 -0.5  1.5 1 -0.5  1.5 1 0.5  0.5 1 0.5");
    // The share of the radius 1 cm of 23 that is on the floor, by the integral of its kernel; of 24
    // and 25, whose radius shrinks, the mean over 1000 passes.
    const StabilityCase::Expected photons[] = {{"23-few", too_dark(0.70563782)},
                                               {"24-few", too_dark(0.83015172)},
                                               {"25-few", too_dark(0.75870647)}};
    const double edge_truth = 0.1125395395;  // 0.5 / pi cos 45

    // Variances of directions: E[X^2] / E[X]^2 - 1, by quadrature of value^2 / pdf; of RIS and of
    // lights that are chosen: by all outcomes. Coverage: of k hits among 1000 samples, binomial.
    return {// A disk light of radius 1: under its middle, the ground is seen from in between.
            {"disk light 1 above",
             near_view + ground + lamp + disk("1", "1"),
             0.25,
             {{"07,08", {variance(2.4477153)}},
              {"09-area", {variance(1 / 6.0)}},
              {"09,10,11,12,13", {variance(0.14923842)}},
              {"14,15,16", {variance(0.14397693)}},
              {"13-bsdf", {variance(1), covers(0.94632215)}}}},
            {"disk light 0.1 above",
             look("0 0.05 -0.1  0 0 0  0 1 0") + ground + lamp + disk("1", "0.1"),
             0.5 / 1.01,
             {{"07,08", {variance(0.35879335)}},
              {"09-area", {bad_variance(33.0033), covers(0.918)}},
              {"09,10,11,12,13", {variance(0.23696543)}},
              {"14,15,16", {variance(0.046169845)}},
              {"13-bsdf", {variance(0.01), covers(0.92378793)}}}},
            {"disk light 0.01 above",
             look("0 0.005 -0.01  0 0 0  0 1 0") + ground + lamp + disk("1", "0.01"),
             0.5 / 1.0001,
             {{"07,08", {variance(0.33359868)}},
              {"09-area", {{Metric::below_half, 0.649, true}, bad_coverage(0.382)}},
              {"09,10,11,12,13", {variance(0.32159257)}},
              {"14,15,16", {variance(0.051824079)}},
              {"13-bsdf", {variance(1e-4), bad_coverage(0.095157982)}}}},
            // Most runs of what does not sample lights see nothing, and claim an error of 0.
            {"light of 1 cm, 1 m above",
             near_view + ground + lamp + disk("0.01", "1"),
             0.5 / 10001,
             {{"07,08", {black_runs(0.9512318), bad_coverage(0.048767949)}},
              {"13-bsdf", {black_runs(0.90484194), bad_coverage(0.095157982)}},
              {"09,10,11,12,13,14,15,16", {{Metric::relative_variance, 1e-3, false, true}}}}},
            // The bright light is far away, and gives a thousandth.
            {"far and bright, near and weak",
             near_view + ground + point + bright + "[0 1000 0]\n",
             0.159314098,
             {{"09,10", {variance(0.99600799)}},
              {"11,13,14", {variance(6.936454, 15.6588)}},
              {"12-m2", {variance(2.969369, 3.40141)}},
              {"12", {variance(0.0029192111, 0.0261801)}},
              {"12-m32", {variance(0.0014418955, 0.00897375)}},
              {"15,15-m16", {variance(0)}}},
             random_hits},
            // All is in the few samples that keep the weak light.
            {"bright light behind a wall",
             near_view + ground + point + bright + "[0 2 0]\n" + wall,
             0.1591549431,
             {{"09,10", {variance(1)}},
              {"11,13,14", {variance(6.9523337, 15.6947)}},
              {"12-m2", {bad_variance(145.95574, 1751.24), covers(0.90390658)}},
              {"12", {bad_variance(249.89771, 3935.11), covers(0.90510537)}},
              {"12-m32", {bad_variance(249.94948, 3936.04), covers(0.9050487)}},
              {"15,15-m16", {variance(0)}}},
             random_hits},
            // Of three lights 15 samples two, the likelier the more they could give.
            {"two bright lights behind a wall",
             near_view + ground + point + bright + "[0 2 0]\n" + bright + "[0 2 0]\n" + wall,
             0.1591549431,
             {{"09,10", {variance(2)}},
              {"11,13,14", {variance(10.946269)}},
              {"15,15-m16,16", {variance(13.232955)}}},
             random_hits},
            {"sky below sine 0.1",
             look(level) + "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" + ground + roof,
             0.005,
             {{"07,08,09", {variance(37 / 3.0)}},
              {"10,11,12,13,13-bsdf", {bad_variance(99)}},
              {"14,15,16", {variance(11.808154)}}}},
            // A sun has half the light of scenes/sky.pfm.
            {"sky with a sun",
             sun,
             0.7673254228,
             {{"17,18", {variance(0.016352159)}}, {"17-plain", {variance(0.37000393)}}},
             before_17},
            {"haze below a roof",
             sun + roof,
             0.004386634389,
             {{"17,18", {bad_variance(46.071971)}}, {"17-plain", {bad_variance(19.096234)}}},
             before_17},
            // A lamp with its back to the ground, under a mirror in which the eye sees the ground:
            // LSDSE, found by random hits alone. 22 takes sixteen samples for one.
            {"ground lit and seen by a mirror",
             look("0 0.5 -0.5  0 2 0  0 1 0", 3) +
                 "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n" + ground + mirror +
                 quad("-9 1 -9  9 1 -9  9 1 9  -9 1 9") + lamp +
                 "Translate 1 0.2 0 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 0.1\n",
             0.001800996397,  // the form factor
             {{"10,11,12,13,13-bsdf,14,15,16,21,22-weights",
               {bad_variance(554.2482), covers(0.83258593)}},
              {"22", {bad_variance(34.640512)}}},
             "20"},
            {"light near the floor's edge, by a mirror",
             look("-0.0025 0.5 0  -0.0025 0 0  0 0 1", 2) + edge,
             edge_truth,
             {photons[0], photons[1], photons[2]}},
            // No connection finds this light: only photons do.
            {"the same edge, seen in the mirror",
             look("1.8 0.2 0  -0.0025 2 0  0 0 1", 3) + edge,
             edge_truth,
             {photons[0],
              photons[1],
              photons[2],
              {"15,21,22", {{Metric::mean, 0, true}, black_runs(1), bad_coverage(0)}}}}};
}
