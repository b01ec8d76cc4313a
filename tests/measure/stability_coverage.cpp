#include "tests/measure/stability_coverage.h"

#include <cstdio>
#include <mutex>

#include "common/base/parallel.h"
#include "common/base/stats.h"
#include "common/results/warnings.h"
#include "tests/measure/spread.h"

namespace {

constexpr int runs = 60, spp = 16, side = 32;
constexpr SamplerType samplers[] = {SamplerType::independent, SamplerType::stratified,
                                    SamplerType::sobol};

struct CoverageCase {
    const char* scene;
    bool smooth;
};
constexpr CoverageCase cases[] = {{"color-bleeding", true},
                                  {"cornell", true},  // an edge of a lamp in view
                                  {"cornell-spheres", false},
                                  {"thousand-lights", false}};

/// What was seen of one method with one sampler.
struct Coverage {
    double ratio = 0;    // reported error over real one
    double covered = 0;  // share of the runs
    double warned = 0;   // share of the runs

    bool holds(bool smooth) const {
        // The spread of so many runs is itself known to 1 / sqrt(2 (runs - 1)) of its value; and of
        // a right interval so many miss the truth by chance.
        constexpr double noise = 3 / 10.9, least = 0.95 - 5 * 0.0281;
        bool is_right = ratio < 1.25 * (1 + noise) && ratio > 0.8 * (1 - noise);
        return (covered >= least && (is_right || !smooth)) || (!smooth && warned >= 0.5);
    }
    std::string text(bool smooth) const {
        return short_number(ratio) + "  " + std::to_string(std::lround(100 * covered)) + " %" +
               (warned >= 0.5 ? " w" : "") + (holds(smooth) ? "" : " FAILS");
    }
};

Coverage coverage_of(const Method& method, const Scene& scene, SamplerType sampler, double truth) {
    std::vector<double> means(runs), errors(runs), warned(runs);
    parallel_for(runs, static_cast<int>(std::thread::hardware_concurrency()), [&](int run) {
        Scene own = scene;
        MeasureOptions o;
        o.threads = 1, o.sampler = sampler;
        Rendering r = render_once(method, own, o, spp, static_cast<uint32_t>(run) + 1);
        size_t i = static_cast<size_t>(run);
        means[i] = r.film.mean(), errors[i] = r.film.standard_error();
        warned[i] = !warnings_of(r.film, r.stats).empty();
    });
    RunningStats mean, covered, warnings;
    for (size_t i = 0; i < means.size(); i++) {
        mean.add(means[i]);
        covered.add(std::abs(means[i] - truth) <= 1.96 * errors[i] + 1e-6 * truth);
        warnings.add(warned[i]);
    }
    return {median(errors) / std::sqrt(mean.variance()), covered.mean(), warnings.mean()};
}

/// All but those that blur: the reported error does not include that bias.
std::vector<Method> judged_methods() {
    std::vector<Method> all = methods_named({"all"});
    std::erase_if(all, [](const Method& m) { return m.biased; });
    return all;
}

constexpr struct {
    const char* scene;
    const char* true_by;  // a method that does not blur there, or hardly, after so many passes
    int spp;
} blurred_cases[] = {{"cornell", "15", 1 << 13},
                     {"caustic", "22", 1 << 14},
                     {"sds", "24", 1 << 10},
                     {"pool", "24", 1 << 10}};

/// What was seen of chapter 25.
struct BlurredCoverage {
    RunningStats mean, error, covered, warned;
    RunningStats covered_without;  // of the runs without the warning of a bias

    double bias_over_error(double truth) const { return (mean.mean() - truth) / error.mean(); }
    double reported_over_real() const { return error.mean() / std::sqrt(mean.variance()); }
    bool holds(double truth) const {
        bool is_off = std::abs(mean.mean() - truth) > error.mean() + 5 * mean.standard_error();
        return (!is_off || warned.mean() == 1) &&
               (covered_without.count() == 0 || covered_without.mean() >= 0.85);
    }
    std::vector<std::string> row(const std::string& scene, double truth) const {
        auto of_runs = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
        return {scene,
                short_number(bias_over_error(truth)),
                short_number(reported_over_real()),
                of_runs(covered.mean()),
                of_runs(warned.mean()),
                holds(truth) ? "" : "FAILS"};
    }
};

BlurredCoverage blurred_coverage_of(const Method& method, const Scene& scene, SamplerType sampler,
                                    double truth) {
    BlurredCoverage seen;
    std::mutex one_at_a_time;
    parallel_for(runs, static_cast<int>(std::thread::hardware_concurrency()), [&](int run) {
        Scene own = scene;
        MeasureOptions o;
        o.threads = 1, o.sampler = sampler;
        Rendering r = render_once(method, own, o, spp, static_cast<uint32_t>(run) + 1);
        RenderOptions options;
        options.search = method.search;
        std::string warnings;
        for (const std::string& line : warnings_of(scene, options, r)) warnings += line;
        bool warns = warnings.find("photons blur light") != std::string::npos;
        bool covers = std::abs(r.film.mean() - truth) <= 1.96 * r.film.standard_error();
        std::lock_guard<std::mutex> lock(one_at_a_time);
        seen.mean.add(r.film.mean()), seen.error.add(r.film.standard_error());
        seen.covered.add(covers), seen.warned.add(warns);
        if (!warns) seen.covered_without.add(covers);
    });
    return seen;
}

}  // namespace

size_t coverage_steps() { return std::size(cases) * judged_methods().size(); }
size_t blur_steps() { return std::size(blurred_cases); }

int show_coverage(const MeasureOptions& options, Work& work) {
    int failures = 0;
    for (const CoverageCase& c : cases) {
        MeasureOptions o;
        o.width = o.height = side, o.threads = 2, o.sampler = SamplerType::sobol;
        Scene scene = load_scene_for(find_scene(c.scene), o);
        double truth = render_once(methods_named({"15"})[0], scene, o, 1 << 13, 999).film.mean();
        Table table{{c.scene, "independent", "stratified", "Sobol"}, {}};
        for (const Method& method : judged_methods()) {
            work.next(std::string("reported errors on ") + c.scene + ", " + method.name);
            if (!can_render(method, scene)) continue;
            std::vector<std::string> row = {method.label};
            for (SamplerType sampler : samplers) {
                Coverage seen = coverage_of(method, scene, sampler, truth);
                failures += !seen.holds(c.smooth);
                row.push_back(seen.text(c.smooth));
            }
            table.rows.push_back(row);
        }
        std::printf("\n%s", markdown(table).c_str());
        write_table(options.out, std::string("coverage-") + c.scene, table);
    }
    std::printf(
        "reported error over real one, and how often mean +- 1.96 errors holds the truth, of %d\n"
        "renders of %d x %d pixels with %d samples; w: most of them warn that it may not.\n",
        runs, side, side, spp);
    return failures;
}

int show_blur(Work& work) {
    int failures = 0;
    const Method method = methods_named({"25"})[0];
    Table table{{"25 vertex merging", "bias (s.e.)", "error", "covered", "says that it blurs", ""},
                {}};
    for (const auto& c : blurred_cases) {
        MeasureOptions o;
        o.width = o.height = side, o.threads = 2;
        Scene scene = load_scene_for(find_scene(c.scene), o);
        work.next(std::string("blur on ") + c.scene);
        double truth = render_once(methods_named({c.true_by})[0], scene, o, c.spp, 999).film.mean();
        for (SamplerType sampler : {SamplerType::independent, SamplerType::sobol}) {
            BlurredCoverage seen = blurred_coverage_of(method, scene, sampler, truth);
            failures += !seen.holds(truth);
            bool sobol = sampler == SamplerType::sobol;
            table.rows.push_back(seen.row(c.scene + std::string(sobol ? ", Sobol" : ""), truth));
        }
    }
    std::printf("%s", markdown(table).c_str());
    std::printf(
        "bias over reported error (s.e.: standard error), reported error over real one, how often\n"
        "mean +- 1.96 errors holds the truth, and how many warn, of %d renders of %d x %d pixels\n"
        "with %d samples.\n",
        runs, side, side, spp);
    return failures;
}
