// compare_probes NN: renders small scenes by chapter NN, and says what is not as it should be.
#include <algorithm>
#include <cstdio>
#include <set>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/check/findings.h"
#include "tests/check/probes.h"
#include "tests/measure/measure.h"
#include "tests/support/seal.h"

namespace {

constexpr int batches = 16;
constexpr const char* reference_file = "tests/check/references.tsv";

/// The quantities of one probe, from the spread of several renders.
std::map<std::string, Quantity> measure(const NamedMethod& method, const Probe& probe,
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
        for (const auto& [name, film] : r.classes) values[name] = film.mean();
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
bool is_blurred(const std::string& probe, const NamedMethod& method) {
    static const std::set<std::string> uneven = {"bulb", "mirror", "leaning mirror", "wall beside",
                                                 "mirror beside"};
    return method.biased() && uneven.contains(probe);
}

bool fits(const Probe& probe, const NamedMethod& method) {
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
bool is_seen(const NamedMethod& method, const std::string& name) {
    if (!method.name.starts_with("20") || !is_class(name)) return true;
    return name != "longer" && (name == "LE" || name[name.size() - 2] == 'D');
}

Quantities measure_all(const NamedMethod& method, const MeasureOptions& o, double times,
                       uint32_t seed) {
    Quantities found;
    for (const Probe& probe : all_probes()) {
        if (!fits(probe, method)) continue;
        double more = is_blurred(probe.name, method) ? times_blurred : times;
        auto row = measure(method, probe, o, static_cast<int>(probe.samples * more), seed);
        for (const auto& [name, q] : row)
            if (is_seen(method, name)) found[probe.name][name] = q;
        if (method.name.starts_with("20")) found[probe.name].erase("all");
    }
    return found;
}

Quantities read_references(const NamedMethod& method) {
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

Findings findings_of(const NamedMethod& method, const MeasureOptions& o, double times,
                     uint32_t seed) {
    Quantities found = measure_all(method, o, times, seed), expected = read_references(method);
    for (auto row = expected.begin(); row != expected.end();)
        row = found.contains(row->first) ? std::next(row) : expected.erase(row);
    for (auto& [probe, row] : expected)
        std::erase_if(row, [&](const auto& cell) {
            bool all = cell.first == "all";
            return !is_seen(method, cell.first) || (all && method.name.starts_with("20"));
        });
    return {found, expected};
}

/// A number that is off.
struct Off {
    std::string probe, name;
    Quantity ratio;  // or what a class brings that should bring nothing: `leaks`
    bool leaks = false;
};

/// Whether a number that is no mean of light is looked at: some mistakes show in no other.
bool tells(const std::string& probe, const std::string& name) {
    static const std::set<std::pair<std::string, std::string>> all = {{"floor", "samples"},
                                                                      {"sphere", "rays"},
                                                                      {"red", "noise"},
                                                                      {"sizes", "noise"},
                                                                      {"floor", "noise"}};
    return all.contains({probe, name});
}

/// The classes of path that are off, and pictures that are, though none of their classes is.
std::vector<Off> means_off(const Findings& f) {
    std::vector<Off> all;
    std::set<std::string> probes;
    for (const auto& [probe, row] : f.expected())
        for (const auto& [name, q] : row)
            if (is_class(name) && q.mean > 0 && f.off(probe, name))
                all.push_back({probe, name, f.ratio(probe, name)}), probes.insert(probe);
    for (const auto& [probe, row] : f.measured())
        for (const auto& [name, q] : row)
            if (is_class(name) && f.leaks(probe, name))
                all.push_back({probe, name, q, true}), probes.insert(probe);
    for (const auto& [probe, row] : f.expected())
        if (row.contains("all") && f.off(probe, "all") && !probes.contains(probe))
            all.push_back({probe, "all", f.ratio(probe, "all")});
    return all;
}

/// Of pictures whose means are right: too many samples, too few rays, too much noise.
std::vector<Off> work_off(const Findings& f) {
    std::vector<Off> all;
    auto is_more = [&](const char* probe, const char* name, double times) {
        Quantity r = f.ratio(probe, name);
        return f.has(probe) && r.mean - 3 * r.se > times;
    };
    auto add = [&](const char* probe, const char* name) {
        all.push_back({probe, name, f.ratio(probe, name)});
    };
    if (is_more("floor", "samples", 1.1)) add("floor", "samples");
    if (f.has("sphere") && f.ratio("sphere", "rays").mean < 0.9) add("sphere", "rays");
    if (is_more("red", "noise", 1.25)) add("red", "noise");
    if (is_more("sizes", "noise", 1.5) && !is_more("floor", "noise", 1.3)) add("sizes", "noise");
    return all;
}

/// "LDE in a floor under a lamp is 0.318 (1/pi) of what it should be": of what is off most surely.
std::string worst_of(const std::vector<Off>& off) {
    auto distance = [](const Off& o) {
        double z = std::abs(o.ratio.mean - 1) / std::max(o.ratio.se, 1e-3);
        return o.leaks ? 0 : std::isfinite(z) ? z : 1e9;
    };
    const Off& o = *std::max_element(off.begin(), off.end(), [&](const Off& a, const Off& b) {
        return distance(a) < distance(b);
    });
    std::string what, factor = name_factor(o.ratio.mean);
    for (const Probe& probe : all_probes())
        if (probe.name == o.probe) what = probe.what;
    what = (o.name == "all" ? "the light" : o.name) + " in " + what + " is ";
    if (o.leaks) return what + "there, and should not be";
    char number[40];
    std::snprintf(number, sizeof number, "%.3g", o.ratio.mean);
    return what + number + (factor.empty() ? "" : " (" + factor + ")") + " of what it should be";
}

/// What is off, by one way in which the chapter finds light. Returns whether anything is.
bool print_off(const Findings& f, const std::string& way) {
    constexpr size_t most = 12;
    std::vector<Off> off = means_off(f);
    int classes = 0;
    for (const auto& [probe, row] : f.expected())
        for (const auto& [name, q] : row) classes += is_class(name);
    if (off.empty()) off = work_off(f);
    size_t of_paths = static_cast<size_t>(
        std::count_if(off.begin(), off.end(), [](const Off& o) { return is_class(o.name); }));
    if (off.empty()) return false;
    std::printf("%zu of %d classes of path are off%s. Most surely: %s.\n", of_paths, classes,
                way.c_str(), worst_of(off).c_str());
    for (size_t i = 0; i < std::min(off.size(), most); i++) {
        const Off& o = off[i];
        std::printf("    %-18s %-10s ", o.probe.c_str(), o.name.c_str());
        if (o.leaks)
            std::printf("light where there should be none\n");
        else
            std::printf("%8.4f +- %.4f\n", o.ratio.mean, o.ratio.se);
    }
    return true;
}

/// What all chapters say of each quantity, and what each says of itself.
struct Answers {
    std::map<std::string, std::map<std::string, std::vector<Quantity>>> of_all;
    Quantities own;
};
Answers ask_all(const MeasureOptions& o) {
    Answers answers;
    for (const NamedMethod& method : all_methods()) {
        bool second = method.name == "09-area" || method.name == "13-bsdf";
        if ((method.is_variant() && !second) || (method.biased() && method.name != "25")) continue;
        std::printf("%s\n", method.name.c_str());
        std::fflush(stdout);
        for (const auto& [probe, row] :
             measure_all(method, o, method.biased() ? times_checked : 16, 1000))
            for (const auto& [name, q] : row) {
                // What depends on how a chapter works has its name behind it in the file.
                bool of_noise = name == "noise" || name == "rays";
                bool own = of_noise || is_blurred(probe, method);
                if (!is_class(name) && name != "all" && !tells(probe, name)) continue;
                if (name == "samples" || (method.biased() && (of_noise || !own))) continue;
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
        "# together: build/compare_probes --references. Noise and rays are those of one chapter.\n";
    auto add = [&](const std::string& probe, const std::string& name, Quantity q) {
        char line[200];
        std::snprintf(line, sizeof line, "%s\t%s\t%.6g\t%.2g\n", probe.c_str(), name.c_str(),
                      q.mean, q.se);
        text += line;
    };
    int disagree = 0;
    for (const auto& [probe, row] : answers.of_all) {
        if (tells(probe, "samples")) add(probe, "samples", {1, 0});
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

int check(const std::string& chapter, const MeasureOptions& o) {
    const std::map<std::string, std::string> as = {{"23", "23-few"}, {"24", "24-few"}};
    const NamedMethod method =
        methods_named({as.contains(chapter) ? as.at(chapter) : chapter}).at(0);
    Findings found = findings_of(method, o, times_checked, 1);
    if (found.black()) {
        std::printf("All pictures are black: trace brings no light at all. Does it return L?\n");
        return 1;
    }
    bool off = print_off(found, "");
    for (const NamedMethod& m : all_methods()) {
        bool by_area = m.name == chapter + "-area", by_bsdf = m.name == chapter + "-bsdf";
        if (!by_area && !by_bsdf) continue;
        off |= print_off(findings_of(m, o, times_checked, 1),
                         by_area ? ", by area" : ", by the BSDF alone");
    }
    if (!off) std::printf("Light comes by every class of path as it should.\n");
    return off ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return seal(run_program([&] {
        bool references = false;
        std::vector<Option> flags = {{"references", "",
                                      "measure what is right by all chapters, and write it down",
                                      [&](const std::string&) { references = true; }}};
        MeasureOptions o = parse_measure_options(argc, argv, "CHAPTER",
                                                 "Renders small scenes by a chapter, and says "
                                                 "what is not as it should be.",
                                                 {}, flags);
        if (references) return write_references(o);
        if (o.words.size() != 1) throw UsageError("error: one chapter is needed, such as 09");
        return check(o.words[0], o);
    }));
}
