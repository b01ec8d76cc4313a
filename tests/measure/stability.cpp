// Do methods fail where theory says, as it says, and nowhere else?
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/measure/measure.h"

namespace {

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

Prediction variance(double x, double spread = 0) {
    return {Metric::relative_variance, x, false, false, spread};
}
Prediction bad_variance(double x, double spread = 0) {
    return {Metric::relative_variance, x, true, false, spread};
}
Prediction covers(double x) { return {Metric::coverage, x}; }
Prediction bad_coverage(double x) { return {Metric::coverage, x, true}; }
Prediction black_runs(double x) { return {Metric::black, x, true}; }
/// Of photons, about ten in a run.
std::vector<Prediction> too_dark(double mean) {
    return {{Metric::mean, mean, true}, {Metric::coverage, 0.95, true, true}};
}

/// One pixel of a thousandth of a degree, and grey paint.
std::string look(const std::string& from_to_up, int max_depth = 100) {
    return "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n"
           "Integrator \"path\" \"integer maxdepth\" " +
           std::to_string(max_depth) + "\nLookAt " + from_to_up +
           "\nCamera \"perspective\" \"float fov\" 0.001\nWorldBegin\n"
           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n";
}
std::string quad(const std::string& corners) {
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + corners +
           "]\n";
}
/// A disk that looks down from a height.
std::string disk(const std::string& radius, const std::string& height) {
    return "Translate 0 " + height + " 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" " +
           radius + "\n";
}

std::vector<StabilityCase> stability_cases() {
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

/// Many runs of one pixel.
struct Observed {
    RunningStats mean;     // of each run
    RunningStats squares;  // mean of (X - truth)^2 of each run
    double runs = 0, covered = 0, below_half = 0, black = 0;
    double not_finite = 0;
};

constexpr double rounding = 1e-5;  // relative, of float
constexpr int N = 1000;            // samples of a run

Observed observe(const NamedMethod& method, Scene& scene, const StabilityCase& c,
                 const MeasureOptions& o) {
    Observed seen;
    for (int run = 0; run < o.runs; run++) {
        Rendering r = render_once(method, scene, o, N, static_cast<uint32_t>(run));
        double mean = r.film.mean(), se = r.film.standard_error();
        double sum = mean * N, effective = r.film.error().samples;
        double sum_of_squares = effective > 0 ? sum * sum / effective : 0;
        seen.runs++;
        seen.mean.add(mean);
        seen.squares.add(sum_of_squares / N - 2 * mean * c.truth + c.truth * c.truth);
        seen.covered += std::abs(mean - c.truth) <= 1.96 * se + rounding * c.truth;
        seen.below_half += mean < c.truth / 2;
        seen.black += mean == 0;
        seen.not_finite += static_cast<double>(r.stats.not_finite);
    }
    return seen;
}

/// A measured number and its standard error.
struct Number {
    double value, se;
};

Number measured(const Prediction& p, const Observed& seen, const StabilityCase& c) {
    auto share = [&](double count) {
        double variance = std::max(p.value * (1 - p.value), 1 / seen.runs);
        return Number{count / seen.runs, std::sqrt(variance / seen.runs)};
    };
    double truth2 = c.truth * c.truth;
    switch (p.metric) {
        case Metric::coverage: return share(seen.covered);
        case Metric::below_half: return share(seen.below_half);
        case Metric::black: return share(seen.black);
        case Metric::mean:
            return {seen.mean.mean() / c.truth, seen.mean.standard_error() / c.truth};
        default:
            // Rare samples that carry much have perhaps not come: theory knows of them.
            return {seen.squares.mean() / truth2, std::max(seen.squares.standard_error() / truth2,
                                                           p.spread / std::sqrt(seen.runs * N))};
    }
}

constexpr const char* metrics[] = {"relative variance", "coverage", "runs below half the truth",
                                   "runs of 0 +- 0", "mean over truth"};

/// Whether the numbers are what was predicted. What nobody predicted to fail must hold: all samples
/// finite, no bias, and intervals that cover the truth.
std::string judge(const Observed& seen, const StabilityCase& c,
                  const std::vector<Prediction>& predictions) {
    std::string word = "holds", said;
    bool right = true;
    auto say = [&](const std::string& text, bool agrees) {
        said += (said.empty() ? ": " : "; ") + text + (agrees ? "" : ", NOT SO");
        right = right && agrees;
    };
    std::map<Metric, bool> predicted;
    for (const Prediction& p : predictions) {
        predicted[p.metric] = true;
        Number m = measured(p, seen, c);
        double away = m.value - p.value, gate = 5 * m.se + rounding * (1 + p.value);
        say(std::string(metrics[static_cast<int>(p.metric)]) + " " + short_number(m.value) +
                (p.at_most ? " (at most " : " (") + short_number(p.value) + ")",
            p.at_most ? away <= gate : std::abs(away) <= gate);
        if (p.fails) word = "fails as predicted";
    }
    double bias = std::abs(seen.mean.mean() - c.truth);
    double gate = 5 * seen.mean.standard_error() + rounding * c.truth;
    if (!predicted[Metric::mean] && !(bias <= gate)) say("no bias", false);
    // 0.87: 5 standard errors of 200 runs below 0.95.
    bool covers = seen.covered / seen.runs >= 0.87;
    if (!predicted[Metric::coverage] && !covers) say("intervals that cover", false);
    if (seen.not_finite > 0) say("finite samples", false);
    return (right ? word : "FAILS") + said;
}

void judge_case(const StabilityCase& c, const MeasureOptions& o, Table& rows, Work& work) {
    work.next(c.name);
    Scene scene = parse_scene(c.name, c.scene, nullptr);
    prepare(scene, 1);
    for (const StabilityCase::Expected& expected : c.expected) {
        for (const NamedMethod& method : methods_named(split_list(expected.methods))) {
            if (!can_render(method, scene))
                throw InputError("error: " + method.name + " refuses " + c.name);
            Observed seen = observe(method, scene, c, o);
            double away = seen.mean.mean() - c.truth;
            bool exact = std::abs(away) <= rounding * c.truth;
            rows.rows.push_back({c.name, method.name, short_number(seen.mean.mean()),
                                 exact ? "0" : short_number(away / seen.mean.standard_error()),
                                 short_number(100 * (seen.covered / seen.runs)),
                                 short_number(seen.not_finite),
                                 judge(seen, c, expected.predictions)});
        }
    }
    for (const NamedMethod& method : methods_named(split_list(c.refuse))) {
        std::string verdict = can_render(method, scene) ? "FAILS" : "refuses";
        rows.rows.push_back({c.name, method.name, "-", "-", "-", "-", verdict});
    }
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[WORD...]",
            "Every method on scenes on which some fail: whether each holds, or fails as theory "
            "predicts. 200 runs of one pixel each. Anything else makes it fail. WORD: only the "
            "scenes with this in their name.",
            {.spp = 0, .runs = 200});
        Table rows{
            {"scene", "method", "mean", "bias (s.e.)", "coverage %", "not finite", "verdict"}, {}};
        std::vector<StabilityCase> cases = stability_cases();
        std::erase_if(cases, [&](const StabilityCase& c) {
            auto has = [&](const std::string& word) {
                return c.name.find(word) != std::string::npos;
            };
            return !o.words.empty() && std::none_of(o.words.begin(), o.words.end(), has);
        });
        Work work("stability: " + std::to_string(cases.size()) + " scenes on which methods fail",
                  static_cast<double>(cases.size()));
        for (const StabilityCase& c : cases) judge_case(c, o, rows, work);
        Table verdicts{{"scene", "holds", "as predicted", "refuses", "FAILS"}, {}};
        for (const auto& row : rows.rows) {
            if (verdicts.rows.empty() || verdicts.rows.back()[0] != row[0])
                verdicts.rows.push_back({row[0], "", "", "", ""});
            size_t column = 1;
            while (row.back().find(verdicts.columns[column]) == std::string::npos) column++;
            std::string& methods = verdicts.rows.back()[column];
            methods += (methods.empty() ? "" : " ") + row[1];
        }
        std::printf("%s", markdown(verdicts).c_str());
        write_table(o.out, "stability", rows);
        std::erase_if(rows.rows, [](const auto& row) { return !row.back().starts_with("FAILS"); });
        if (!rows.rows.empty()) std::printf("\n%s", markdown(rows).c_str());
        return rows.rows.empty() ? 0 : 1;
    });
}
