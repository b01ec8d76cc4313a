// Do methods fail where theory says, as it says, and nowhere else?
#include <cstdio>

#include "common/error.h"
#include "common/parallel.h"
#include "common/pbrt_reader.h"
#include "tests/measure/measure.h"
#include "tests/measure/stability_cases.h"

namespace {

/// Many runs of one pixel.
struct Observed {
    RunningStats mean;     // over the runs
    RunningStats squares;  // mean of X^2 of each run
    double runs = 0, covered = 0, below_half = 0, black = 0, fireflies = 0;
    double largest = 0, sum = 0, sum_of_squares = 0;  // of samples
    double cut = 0, not_finite = 0, samples = 0;
};

Observed observe(const Method& method, Scene& scene, const StabilityCase& c,
                 const MeasureOptions& o) {
    Observed seen;
    for (int run = 0; run < o.runs; run++) {
        Rendering r = render_once(method, scene, o, c.spp, static_cast<uint32_t>(run));
        double mean = r.film.mean(), se = r.film.standard_error();
        double sum = mean * c.spp, effective = r.film.effective_samples();
        double sum_of_squares = effective > 0 ? sum * sum / effective : 0;
        seen.runs++;
        seen.mean.add(mean);
        seen.squares.add(sum_of_squares / c.spp);
        seen.covered += std::abs(mean - c.truth) <= 1.96 * se + 1e-5 * c.truth;  // and rounding
        seen.below_half += mean < c.truth / 2;
        seen.black += mean == 0;
        seen.fireflies += mean > 5 * c.truth;
        seen.largest = std::max(seen.largest, r.stats.largest);
        seen.sum += sum;
        seen.sum_of_squares += sum_of_squares;
        seen.cut += static_cast<double>(r.stats.paths_cut);
        seen.not_finite += static_cast<double>(r.stats.not_finite);
        seen.samples += c.spp;
    }
    return seen;
}

/// A measured number and its standard error.
struct Number {
    double value, se;
};

Number measured(Metric metric, double predicted, const Observed& seen, const StabilityCase& c) {
    auto share = [&](double count) {
        double variance = std::max(predicted * (1 - predicted), 1 / seen.runs);
        return Number{count / seen.runs, std::sqrt(variance / seen.runs)};
    };
    double truth2 = c.truth * c.truth;
    switch (metric) {
        case Metric::relative_variance:
            return {seen.squares.mean() / truth2 - 1, seen.squares.standard_error() / truth2};
        case Metric::coverage: return share(seen.covered);
        case Metric::below_half: return share(seen.below_half);
        case Metric::black: return share(seen.black);
        case Metric::mean:
            return {seen.mean.mean() / c.truth, seen.mean.standard_error() / c.truth + 2e-4};
        case Metric::cut: return {seen.cut / seen.samples, 1e-3};
    }
    return {NAN, NAN};
}

const char* name_of(Metric metric) {
    switch (metric) {
        case Metric::relative_variance: return "relative variance";
        case Metric::coverage: return "coverage";
        case Metric::below_half: return "runs below half the truth";
        case Metric::black: return "runs of 0 +- 0";
        case Metric::mean: return "mean over truth";
        case Metric::cut: return "paths cut";
    }
    return "";
}

/// Whether the numbers are what was predicted; without prediction, whether the method holds: no
/// bias, and intervals that cover. Adds to `said` what was measured and what predicted.
bool as_expected(const Observed& seen, const StabilityCase& c,
                 const std::vector<Prediction>& predictions, std::string& said) {
    bool right = seen.not_finite == 0;
    for (const Prediction& p : predictions) {
        Number m = measured(p.metric, p.value, seen, c);
        double away = m.value - p.value, gate = 5 * m.se + 1e-5 * p.value;
        bool agrees = p.at_most ? away <= gate : std::abs(away) <= gate;
        right = right && agrees;
        said += (said.empty() ? "" : "; ") + std::string(name_of(p.metric)) + " " +
                short_number(m.value) + (p.at_most ? " (at most " : " (") + short_number(p.value) +
                (agrees ? ")" : ", NOT SO)");
    }
    if (!predictions.empty()) return right;
    double bias = std::abs(seen.mean.mean() - c.truth);
    bool unbiased = bias <= 5 * seen.mean.standard_error() + 1e-5 * c.truth;
    bool covers = seen.covered / seen.runs >= 0.87;  // 5 standard errors of 200 runs
    if (!unbiased) said += "biased ";
    if (!covers) said += "intervals too small";
    return right && unbiased && covers;
}

std::vector<std::string> row_of(const StabilityCase& c, const Method& method, const Observed& seen,
                                const std::string& verdict) {
    double se = seen.mean.standard_error(), away = seen.mean.mean() - c.truth;
    auto percent = [](double share) { return short_number(100 * share); };
    double effective = seen.sum * seen.sum / seen.sum_of_squares / seen.samples;
    bool black = seen.sum == 0;
    return {c.name,
            method.name,
            short_number(seen.mean.mean()),
            std::abs(away) <= 1e-5 * c.truth ? "0" : short_number(away / se),
            percent(seen.covered / seen.runs),
            black ? "-" : percent(seen.largest / seen.sum),
            black ? "-" : percent(effective),
            short_number(seen.fireflies),
            short_number(seen.not_finite),
            percent(seen.cut / seen.samples),
            verdict};
}

/// All methods of one case; returns how many fail.
int judge_case(const StabilityCase& c, const MeasureOptions& o, Table& table) {
    Scene scene = parse_scene(c.name, c.scene, nullptr);
    prepare(scene, 1);
    int failures = 0;
    for (const StabilityCase::Expected& expected : c.expected) {
        for (const Method& method : methods_named(expected.methods)) {
            Scene prepared = prepared_for(method, scene).value();
            Observed seen = observe(method, prepared, c, o);
            std::string said;
            bool right = as_expected(seen, c, expected.predictions, said), fails = false;
            for (const Prediction& p : expected.predictions) fails = fails || p.fails;
            std::string verdict = !right ? "FAILS" : fails ? "fails as predicted" : "holds";
            if (!said.empty()) verdict += ": " + said;
            table.rows.push_back(row_of(c, method, seen, verdict));
            failures += !right;
        }
    }
    for (const Method& method : methods_named(c.refuse)) {
        bool refuses = !prepared_for(method, scene).has_value();
        table.rows.push_back({c.name, method.name, "-", "-", "-", "-", "-", "-", "-", "-",
                              refuses ? "holds: refuses the scene" : "FAILS: takes the scene"});
        failures += !refuses;
    }
    return failures;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "",
            "Every method on scenes on which some fail: whether each holds, or fails as theory "
            "predicts. 200 runs of one pixel each. Anything else makes it fail.",
            {.spp = 0, .runs = 200});
        Table table{{"scene", "method", "mean", "bias (s.e.)", "coverage %", "largest %",
                     "effective %", "fireflies", "not finite", "cut %", "verdict"},
                    {}};
        int failures = 0;
        for (const StabilityCase& c : stability_cases()) failures += judge_case(c, o, table);
        std::printf(
            "%s\ncoverage: of the truth by the 95 %% intervals of %d runs; largest: share "
            "of the largest of all samples;\neffective: (sum X)^2 / sum X^2 over the "
            "samples; fireflies: runs above 5 times the truth.\nIn brackets: what theory "
            "predicts.\n",
            markdown(table).c_str(), o.runs);
        write_table(o.out, "stability", table);
        return failures == 0 ? 0 : 1;
    });
}
