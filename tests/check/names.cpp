// names NN: renders small scenes by chapter NN, and says which mistake would make them as they are.
#include <cstdio>
#include <filesystem>
#include <set>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/check/naming.h"
#include "tests/check/probes.h"
#include "tests/measure/measure.h"
#include "tests/support/seal.h"

namespace {

constexpr int batches = 16;
constexpr const char* reference_file = "tests/check/references.tsv";
constexpr const char* hypotheses_file = "tests/check/hypotheses.tsv";

/// The quantities of one probe, from the spread of several renders.
std::map<std::string, Quantity> measure(const Method& method, const Probe& probe,
                                        const MeasureOptions& o, int samples, uint32_t seed) {
    Scene scene = parse_scene("probe.pbrt", probe.text, nullptr);
    prepare(scene, o.threads);
    std::map<std::string, RunningStats> stats;
    bool shared_out =
        method.name.starts_with("19") && (probe.name == "floor" || probe.name == "rare light");
    int spp = std::max(samples / batches, shared_out ? 32 : 2);
    for (int batch = 0; batch < batches; batch++) {
        Rendering r = render_once(method, scene, o, spp, seed + static_cast<uint32_t>(batch), true);
        std::map<std::string, double> values = {{"all", r.film.mean()}};
        double taken = static_cast<double>(r.film.samples());
        double asked = static_cast<double>(spp) * scene.width * scene.height;
        values["samples"] = taken / asked;
        values["rays"] = static_cast<double>(r.stats.rays) / taken;
        double noise = r.film.standard_error() * std::sqrt(taken) / r.film.mean();
        if (std::isfinite(noise)) values["noise"] = noise;
        double& parts = values["parts"];
        for (const auto& [name, film] : r.classes) values[name] = film.mean(), parts += film.mean();
        for (const auto& [name, value] : values) {
            RunningStats& s = stats[name];
            while (s.count() < static_cast<uint64_t>(batch)) s.add(0);  // had nothing before
            s.add(value);
        }
        for (auto& [name, s] : stats)
            if (s.count() == static_cast<uint64_t>(batch)) s.add(0);
    }
    std::map<std::string, Quantity> result;
    for (const auto& [name, s] : stats) result[name] = {s.mean(), s.standard_error()};
    return result;
}

// How many times as many samples as the probe says: of what photons blur, and of the rest.
constexpr double times_blurred = 40, times_checked = 3;

/// Photons blur light that is not even. Chapter 25, which makes photons nowhere else, is compared
/// with its own pictures there, of as many passes: its radius shrinks from pass to pass.
bool is_blurred(const std::string& probe, const Method& method) {
    static const std::set<std::string> uneven = {"bulb", "mirror", "leaning mirror", "wall beside",
                                                 "mirror beside"};
    return method.biased && uneven.contains(probe);
}

bool fits(const Probe& probe, const Method& method) {
    int chapter = std::stoi(method.name.substr(0, 2));
    // From a sky, hardly any path meets what most of these small pictures show.
    bool is_small = probe.name == "sky" || probe.name == "sky picture";
    if (chapter == 20 && probe.text.find("infinite") != std::string::npos && !is_small)
        return false;
    if (chapter != 25 && is_blurred(probe.name, method)) return false;
    // Random directions never find lights without a size.
    bool no_size = probe.text.find("LightSource \"point\"") != std::string::npos ||
                   probe.text.find("LightSource \"distant\"") != std::string::npos;
    if (method.name == "13-bsdf" && no_size) return false;
    return chapter >= probe.first_chapter && std::min(chapter, 21) <= probe.last_chapter;
}

/// Of chapter 20 what it can see: where the last vertex is no mirror and no glass.
bool is_seen(const Method& method, const std::string& name) {
    if (!method.name.starts_with("20") || !is_class(name)) return true;
    return name != "longer" && (name == "LE" || name[name.size() - 2] == 'D');
}

Quantities measure_all(const Method& method, const MeasureOptions& o, double times, uint32_t seed) {
    Quantities found;
    for (const Probe& probe : all_probes()) {
        if (!fits(probe, method)) continue;
        double more = is_blurred(probe.name, method) ? times_blurred : times;
        auto row = measure(method, probe, o, static_cast<int>(probe.samples * more), seed);
        for (const auto& [name, q] : row)
            if (is_seen(method, name)) found[probe.name][name] = q;
        bool all_seen = !method.name.starts_with("20");
        if (!all_seen) found[probe.name].erase("all"), found[probe.name].erase("parts");
    }
    return found;
}

Quantities read_references(const Method& method) {
    Quantities expected;
    std::string text = read_file(reference_file);
    for (size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
        std::string line = text.substr(at, end - at), cells[4];
        for (size_t i = 0, from = 0; i < 4; i++) {
            size_t tab = std::min(line.find('\t', from), line.size());
            cells[i] = line.substr(from, tab - from), from = std::min(tab + 1, line.size());
        }
        if (line.empty() || line[0] == '#') continue;
        std::string name = cells[1];
        size_t space = name.find(' ');
        if (space != std::string::npos) {
            if (name.substr(space + 1) != method.name) continue;
            name.resize(space);
        }
        expected[cells[0]][name] = {std::stod(cells[2]), std::stod(cells[3])};
    }
    return expected;
}

Findings findings_of(const Method& method, const MeasureOptions& o, double times, uint32_t seed) {
    Quantities found = measure_all(method, o, times, seed), expected = read_references(method);
    for (auto row = expected.begin(); row != expected.end();)
        row = found.contains(row->first) ? std::next(row) : expected.erase(row);
    for (auto& [probe, row] : expected)
        std::erase_if(row, [&](const auto& cell) {
            bool all = cell.first == "all" || cell.first == "parts";
            return !is_seen(method, cell.first) || (all && method.name.starts_with("20"));
        });
    return {found, expected};
}

/// Everything that is off, for who wants to think for himself.
void print_rest(const Findings& f, const char* way, int most) {
    int count = 0, classes = 0;
    for (const auto& [probe, row] : f.expected())
        for (const auto& [name, q] : row) {
            if (!is_class(name)) continue;
            classes++;
            if (!f.off(probe, name) || ++count > most) continue;
            Quantity r = f.ratio(probe, name);
            std::printf("    %-18s %-10s %8.4f +- %.4f  %s\n", probe.c_str(), name.c_str(), r.mean,
                        r.se, way);
        }
    for (const auto& [probe, row] : f.measured()) {
        std::string leak = f.leak(probe);
        if (!leak.empty() && ++count <= most)
            std::printf("    %-18s %-10s light where there should be none  %s\n", probe.c_str(),
                        leak.c_str(), way);
    }
    std::printf("%d of %d classes of path are off%s%s\n", count, classes, *way ? ", " : "", way);
}

/// What all chapters say of each quantity, and what each says of itself.
struct Answers {
    std::map<std::string, std::map<std::string, std::vector<Quantity>>> of_all;
    Quantities own;
};
Answers ask_all(const MeasureOptions& o) {
    Answers answers;
    for (const Method& method : all_methods()) {
        bool second = method.name == "09-area" || method.name == "13-bsdf";
        if ((is_variant(method) && !second) || (method.biased && method.name != "25")) continue;
        std::printf("%s\n", method.name.c_str());
        std::fflush(stdout);
        for (const auto& [probe, row] :
             measure_all(method, o, method.biased ? times_checked : 16, 1000))
            for (const auto& [name, q] : row) {
                // What depends on how a chapter works has its name behind it in the file.
                bool of_noise = name == "noise" || name == "rays";
                bool own = of_noise || is_blurred(probe, method);
                if (name == "samples" || (method.biased && (of_noise || !own))) continue;
                if (own) answers.own[probe][name + " " + method.name] = q;
                if (!own) answers.of_all[probe][name].push_back(q);
            }
    }
    return answers;
}

/// The mean of measurements, each weighed by its error. Counts and prints those that are far off.
Quantity pooled(const std::string& what, const std::vector<Quantity>& values, int& disagree) {
    double weights = 0, sum = 0;
    for (Quantity q : values) {
        double w = 1 / (q.se * q.se + 1e-12 * q.mean * q.mean + 1e-20);
        weights += w, sum += w * q.mean;
    }
    Quantity mean{sum / weights, 1 / std::sqrt(weights)};
    for (Quantity q : values) {
        double z = (q.mean - mean.mean) / std::hypot(q.se, 1e-5 * mean.mean + 1e-12);
        if (q.mean == mean.mean || std::abs(z) < 6) continue;
        std::printf("%s: %g +- %g beside %g\n", what.c_str(), q.mean, q.se, mean.mean);
        disagree++;
    }
    return mean;
}

/// The references, by all chapters together. Returns 1 when they do not agree.
int write_references(const MeasureOptions& o) {
    Answers answers = ask_all(o);
    std::string text =
        "# What each class of path brings in the probes: mean, standard error. By all chapters\n"
        "# together: build/names --references. Noise and rays are those of one chapter.\n";
    auto add = [&](const std::string& probe, const std::string& name, Quantity q) {
        char line[200];
        std::snprintf(line, sizeof line, "%s\t%s\t%.6g\t%.2g\n", probe.c_str(), name.c_str(),
                      q.mean, q.se);
        text += line;
    };
    int disagree = 0;
    for (const auto& [probe, row] : answers.of_all) {
        add(probe, "samples", {1, 0});
        for (const auto& [name, values] : row) {
            Quantity mean = pooled(probe + " " + name, values, disagree);
            if (mean.mean > 1e-4 || !is_class(name)) add(probe, name, mean);
        }
        for (const auto& [name, q] : answers.own[probe]) add(probe, name, q);
    }
    write_file_atomically(reference_file, text);
    std::printf("wrote %s; %d values disagree\n", reference_file, disagree);
    return disagree == 0 ? 0 : 1;
}

/// The chapter's own code, in which the routines stand that are named.
std::string solution_of(const std::string& chapter) {
    for (const auto& entry : std::filesystem::directory_iterator("chapters"))
        if (entry.path().filename().string().starts_with(chapter + "_"))
            return read_file((entry.path() / "estimator.h").string());
    return "";
}

int check(const std::string& chapter, const MeasureOptions& o, bool predicts) {
    const std::map<std::string, std::string> as = {{"23", "23-few"}, {"24", "24-few"}};
    const Method method = methods_named({as.contains(chapter) ? as.at(chapter) : chapter}).at(0);
    // Predictions are measured with other random numbers, and with fewer, since there are many.
    uint32_t seed = predicts ? 100 : 1;
    double times = predicts ? 1.5 : times_checked;
    Findings found = findings_of(method, o, times, seed);
    std::vector<Findings> other;
    for (const Method& m : all_methods())
        if (m.name == chapter + "-area" || m.name == chapter + "-bsdf")
            other.push_back(findings_of(m, o, times, seed));
    const Findings* second = other.empty() ? nullptr : other.data();
    if (predicts) {
        std::printf("%s\n", prediction_text(evidence_of(found, second)).c_str());
        return 0;
    }
    if (found.black()) {
        std::printf(
            "All pictures are black: trace brings no light at all. Is it written, and does it "
            "return L?\n");
        return 1;
    }
    const char* way = chapter == "09" ? "by area" : "by the BSDF alone";
    std::vector<Hypothesis> hypotheses =
        read_hypotheses(read_file(hypotheses_file), chapter, solution_of(chapter));
    std::string name = name_mistake(hypotheses, found, second);
    if (name.empty()) name = "Light comes by every class of path as it should.";
    std::printf("%s\n\n", name.c_str());
    print_rest(found, "", 12);
    if (second) print_rest(*second, way, 6);
    // For who does not want to read the name yet: tests/check/check.
    std::string where = where_to_look(evidence_of(found, second));
    if (!where.empty() && name.find(where) == std::string::npos)
        std::printf("Where to look: %s\n", where.c_str());
    return name.starts_with("Light comes") ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    return seal(run_program([&] {
        bool references = false, predicts = false;
        std::vector<Option> flags = {
            {"references", "", "measure what is right by all chapters, and write it down",
             [&](const std::string&) { references = true; }},
            {"prediction", "",
             "print what is not as it should be, as tests/check/hypotheses.tsv has it",
             [&](const std::string&) { predicts = true; }}};
        MeasureOptions o = parse_measure_options(argc, argv, "CHAPTER",
                                                 "Renders small scenes by a chapter, and says "
                                                 "which mistake would make them as they are.",
                                                 {}, flags);
        if (references) return write_references(o);
        if (o.words.size() != 1) throw UsageError("error: one chapter is needed, such as 09");
        return check(o.words[0], o, predicts);
    }));
}
