// Do methods fail where theory says, as it says, and nowhere else?
#include <algorithm>
#include <cstdio>
#include <map>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/measure/measure.h"
#include "tests/measure/stability_cases.h"
#include "tests/support/work.h"

namespace {

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
        double sum = mean * N, effective = r.film.effective_samples();
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

constexpr const char* legend =
    "bias: in standard errors; coverage: of the truth by the 95 %% intervals of %d runs of 1000\n"
    "samples.\n"
    "In brackets: what theory predicts, within 5 standard errors. Below, \"as predicted\":\n"
    "fails as predicted; \"refuses\": says that it cannot render the scene.\n";

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
        std::printf("%s\n", markdown(rows).c_str());
        std::printf(legend, o.runs);
        std::printf("\n%s", markdown(verdicts).c_str());
        write_table(o.out, "stability", rows);
        return std::any_of(rows.rows.begin(), rows.rows.end(),
                           [](const auto& row) { return row.back().starts_with("FAILS"); });
    });
}
