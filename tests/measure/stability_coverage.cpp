#include "tests/measure/stability_coverage.h"

#include <cstdio>

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

}  // namespace

size_t coverage_steps() { return std::size(cases) * judged_methods().size(); }

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
