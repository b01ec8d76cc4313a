// compare_scenes NN [SCENE]: renders the known scenes by chapter NN, or one of them, and says what
// is not as it should be. Then, with --worlds FILE, random scenes, beside what the chapter's own
// file rendered of them.
// compare_scenes NN write: renders these, and writes FILE.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <set>
#include <thread>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/check/findings.h"
#include "tests/check/watch.h"
#include "tests/check/worlds.h"
#include "tests/measure/measure.h"
#include "tests/support/seal.h"

namespace {

constexpr int batches = 16;

/// Where a sample was not a number: the scene's file is written, for the command that shows the
/// path.
struct BadSample {
    std::string folder;  // for that file
    std::string says = "not a number", command = {};

    void take(const KnownScene& known, const NamedMethod& method, const SampleCounts& counts) {
        if (counts.not_finite == 0 || !command.empty()) return;
        std::string file = folder + "/" + known.name + ".pbrt";
        std::string pixel = std::to_string(counts.bad.x) + "," + std::to_string(counts.bad.y);
        write_file_atomically(file, known.text);
        says += ", first in pixel " + pixel;
        command = "make mine CH=" + method.name.substr(0, 2) + " ARGS='" + file +
                  " --sampler independent --seed " + std::to_string(counts.bad.seed) +
                  " --explain " + counts.bad.text() + "'";
    }
};

/// What each class of path brings, from the spread of several renders; "all": the picture's mean.
std::map<std::string, Quantity> measure(const NamedMethod& method, const KnownScene& known,
                                        const MeasureOptions& o, int samples, uint32_t first_seed,
                                        BadSample& bad) {
    Scene scene = parse_scene("known.pbrt", known.text, nullptr);
    prepare(scene, o.threads);
    std::map<std::string, RunningStats> stats;
    // Chapter 19 shares out only what is left after the first 16 samples.
    bool shared_out = method.name.starts_with("19") && known.name == "rare-light";
    int spp = std::max(samples / batches, shared_out ? 32 : 2);
    for (int batch = 0; batch < batches; batch++) {
        Rendering r =
            render_once(method, scene, o, spp, first_seed + static_cast<uint32_t>(batch), true);
        bad.take(known, method, r.stats);
        std::map<std::string, double> values = {{"all", r.film.mean()}};
        for (const auto& [name, film] : r.classes) values[name] = film.mean();
        for (const auto& [name, value] : values) stats[name];
        for (auto& [name, s] : stats) {
            while (s.count() < static_cast<uint64_t>(batch)) s.add(0);  // had nothing before
            s.add(values[name]);
        }
    }
    std::map<std::string, Quantity> result;
    for (const auto& [name, s] : stats) result[name] = {s.mean(), s.standard_error()};
    return result;
}

/// Photons blur light that is not even: there the error of chapter 25 may be larger.
bool is_blurred(const KnownScene& scene, const NamedMethod& method) {
    static const std::set<std::string> uneven = {"bulb", "mirror", "leaning-mirror", "wall-beside",
                                                 "mirror-beside"};
    return method.biased() && uneven.contains(scene.name);
}

bool fits(const KnownScene& scene, const NamedMethod& method) {
    bool classes_known = scene.light.size() > 1 || scene.light.at("all").mean < 1e-3;
    if (!classes_known) return false;
    int chapter = std::stoi(method.name.substr(0, 2));
    auto has = [&](const char* word) { return scene.text.find(word) != std::string::npos; };
    // From a sky, hardly any path meets what most of these small pictures show.
    bool is_small =
        scene.name == "sky" || scene.name == "sky-picture" || scene.name == "picture-lamps";
    if (chapter == 20 && has("infinite") && !is_small) return false;
    if (chapter != 25 && is_blurred(scene, method)) return false;
    if (method.biased() && scene.name == "still-life") return false;  // has edges everywhere
    if (method.biased() && has("ActiveTransform")) return false;      // not supported
    // Random directions never find lights without a size.
    bool no_size = has("LightSource \"point\"") || has("LightSource \"distant\"");
    if (method.name == "13-bsdf" && no_size) return false;
    return chapter >= scene.first_chapter && std::min(chapter, 21) <= scene.last_chapter;
}

/// Of chapter 20 what it can see: where the last vertex is no mirror and no glass.
bool is_seen(const NamedMethod& method, const std::string& name) {
    if (!method.name.starts_with("20")) return true;
    return name == "LE" || (name[0] == 'L' && name[name.size() - 2] == 'D');
}

/// A class of path that is off, or a picture that is ("all"), though none of its classes is.
struct Off {
    std::string scene, what;  // its name, and what it shows
    std::string name;
    Quantity ratio;      // measured over expected
    bool leaks = false;  // it should bring nothing
};

struct Findings {
    BadSample bad;
    std::vector<Off> off = {};
    int classes = 0;    // compared
    bool black = true;  // no class brings anything
};

/// Whether a is off more surely than b.
bool is_surer(const Off& a, const Off& b) {
    auto distance = [](const Off& o) {
        double z = std::abs(o.ratio.mean - 1) / std::max(o.ratio.se, 1e-3);
        return o.leaks ? 0 : std::isfinite(z) ? z : 1e9;
    };
    return distance(a) > distance(b);
}

/// "LDE in a floor under a lamp is 0.318 (1/pi) of what it should be": of what is off most surely.
std::string worst_of(const Findings& found) {
    const Off& o = *std::min_element(found.off.begin(), found.off.end(), is_surer);
    std::string factor = name_factor(o.ratio);
    std::string what = (o.name == "all" ? "the light" : o.name) + " in " + o.what + " is ";
    if (o.leaks) return what + "there, and should not be";
    if (!std::isfinite(o.ratio.mean)) return what + found.bad.says;
    return what + short_number(o.ratio.mean) +
           (factor.empty() || factor == short_number(o.ratio.mean) ? "" : " (" + factor + ")") +
           (o.ratio.mean > 1.5 ? " times what it should be" : " of what it should be");
}

/// For who waits: the check says it at once.
void say_first(const Findings& found) {
    std::printf("off     %s\n", worst_of(found).c_str());
    std::fflush(stdout);
}

/// The same, of what is right.
void say_so_far(size_t right, size_t all, const char* what) {
    std::printf("so far: %zu of %zu %s pictures\n", right, all, what);
    std::fflush(stdout);
}

void compare(const KnownScene& scene, const NamedMethod& method, const MeasureOptions& o,
             Findings& findings) {
    constexpr int times_blurred = 40, times = 3;  // as many samples as the scene says
    bool blurred = is_blurred(scene, method);
    int samples = scene.samples * (blurred ? times_blurred : times);
    double least = blurred ? 0.12 : 0.008;
    auto measured = measure(method, scene, o, samples, 1, findings.bad);
    auto expected = scene.light;
    for (const auto& [name, q] : measured) expected.insert({name, Quantity{}});
    std::vector<Off> off;
    bool is_sure = false;
    auto look_at = [&](const std::string& name, Quantity should) {
        Quantity is = measured[name];
        if (!is_seen(method, name) || !is_off(is, should, least)) return;
        bool leaks = !(should.mean > 0);
        Quantity ratio = leaks ? is : ratio_of(is, should);
        off.push_back({scene.name, scene.what, name, ratio, leaks});
        is_sure |= !(std::abs(ratio.mean - 1) < 20 * ratio.se) && is.mean != 0 && !leaks;
    };
    for (const auto& [name, should] : expected) {
        if (!is_class(name)) continue;
        findings.classes++;
        findings.black &= measured[name].mean == 0;
        look_at(name, should);
    }
    if (off.empty()) look_at("all", expected["all"]);
    if (findings.off.empty() && !off.empty() && !is_sure) {
        // A rare path may be missing, or there too often, by chance: but not twice.
        auto again = measure(method, scene, o, 8 * samples, 1000, findings.bad);
        std::erase_if(off, [&](const Off& found) {
            return !is_off(again[found.name], expected[found.name], least);
        });
    }
    bool is_first = findings.off.empty() && !off.empty();
    findings.off.insert(findings.off.end(), off.begin(), off.end());
    if (is_first && !findings.black) say_first(findings);
}

/// folder    where the scene of a path that is not a number is written
Findings findings_of(const NamedMethod& method, const MeasureOptions& o, const std::string& folder,
                     Watch& watch) {
    Findings findings{{folder}};
    NamedMethod watched = watch.watched(method);
    bool one_alone = o.words.size() > 1;
    std::vector<KnownScene> scenes = known_scenes();
    std::erase_if(scenes, [&](const KnownScene& scene) {
        return !fits(scene, method) || (one_alone && scene.name != o.words[1]);
    });
    size_t right = 0;
    for (const KnownScene& scene : scenes) {
        watch.renders(scene.name);
        size_t off = findings.off.size();
        compare(scene, watched, o, findings);
        right += findings.off.size() == off;
        say_so_far(right, scenes.size(), "small");
    }
    return findings;
}

void print_rows(Findings found) {
    std::stable_sort(found.off.begin(), found.off.end(), is_surer);
    constexpr size_t most = 12;
    for (size_t i = 0; i < std::min(found.off.size(), most); i++) {
        const Off& o = found.off[i];
        std::printf("    %-18s %-10s ", o.scene.c_str(), o.name.c_str());
        if (o.leaks)
            std::printf("light where there should be none\n");
        else if (!std::isfinite(o.ratio.mean))
            std::printf("not a number\n");
        else
            std::printf("%8.4f +- %.4f\n", o.ratio.mean, o.ratio.se);
    }
    if (found.off.size() > most)
        std::printf("    ... and %d more\n", static_cast<int>(found.off.size() - most));
    if (!found.bad.command.empty())
        std::printf("To see that path: %s\n", found.bad.command.c_str());
}

/// What is off, by one way in which the chapter finds light. Returns whether anything is.
bool print_off(const Findings& found, const std::string& way) {
    if (found.off.empty()) return false;
    auto of_paths = std::count_if(found.off.begin(), found.off.end(),
                                  [](const Off& o) { return is_class(o.name); });
    std::printf("%d of %d classes of path are off%s. Most surely: %s.\n",
                static_cast<int>(of_paths), found.classes, way.c_str(), worst_of(found).c_str());
    print_rows(found);
    return true;
}

/// Renders the worlds that the chapter has rendered, until a few are off. Returns whether any is.
bool compare_worlds(const std::string& chapter, const MeasureOptions& o, const std::string& file,
                    const std::string& folder, Watch& watch) {
    // Another process may still be writing it.
    for (int tenths = 0; !std::filesystem::exists(file); tenths++) {
        if (tenths > 600) throw InputError("error: nothing wrote " + file);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    const WorldValues right = worlds::read(file);
    constexpr size_t enough = 12;
    auto all = static_cast<size_t>(std::count_if(right.begin(), right.end(), [](const auto& value) {
        return std::get<2>(value.first) == "noise";
    }));
    size_t done = 0;
    Findings found{{folder}};
    std::set<int> rendered;
    for (const NamedMethod& method : methods_named({chapter + "+"})) {
        NamedMethod watched = watch.watched(method);
        int more_noise = 0, less_noise = 0;
        RunningStats noise;  // the logarithm of mine over the chapter's
        Off most_noise;
        for (const auto& [at, unused] : right) {
            auto [name, number, first] = at;
            if (name != method.name || first != "noise" || found.off.size() >= enough) continue;
            std::string world = "world-" + std::to_string(number);
            watch.renders(world);
            rendered.insert(number);
            WorldValues mine;
            worlds::measure(watched, o, number, mine);
            for (auto from = right.lower_bound({name, number, ""});
                 from != right.end() && std::get<0>(from->first) == name &&
                 std::get<1>(from->first) == number;
                 ++from)
                mine.insert({from->first, {}});  // what the reader's file does not bring
            for (const auto& [key, values] : mine) {
                auto theirs = right.find(key);
                const std::string& what = std::get<2>(key);
                Quantity ratio = worlds::ratio_of(
                    values, theirs == right.end() ? std::vector<double>{} : theirs->second);
                Off here = {world, world, what, ratio, std::isinf(ratio.mean)};
                if (worlds::is_off(what, ratio)) {
                    found.off.push_back(here);
                    if (found.off.size() == 1) say_first(found);
                }
                if (what != "noise") continue;
                if (ratio.mean > most_noise.ratio.mean) most_noise = here;
                more_noise += ratio.mean > 1.5;
                less_noise += ratio.mean < 1 / 1.5;
                if (ratio.mean > 0) noise.add(std::log(std::min(ratio.mean, 10.0)));
            }
            done++;
            if (found.off.empty()) say_so_far(done, all, "random");
        }
        // Other random numbers make as often more noise as less, and as much.
        bool often = more_noise - less_noise > 4.2 * std::sqrt(more_noise + less_noise);
        bool everywhere = noise.mean() > std::max(0.1, 5 * noise.standard_error());
        if (found.off.empty() && (often || everywhere)) {
            most_noise.what += " (there is more in " + std::to_string(more_noise) + " scenes)";
            found.off.push_back(most_noise);
        }
    }
    if (found.off.empty()) {
        std::printf("In %zu random scenes the light is the chapter's.\n", rendered.size());
        return false;
    }
    const std::string& worst = found.off[0].scene;
    std::string path = folder + "/" + worst + ".pbrt";
    auto number = static_cast<uint32_t>(std::stoi(worst.substr(6)));
    write_file_atomically(path, random_world(std::stoi(chapter), number));
    std::printf("Random scenes are off, beside the chapter's own file. Most surely: %s.\n",
                worst_of(found).c_str());
    print_rows(found);
    std::printf("To see the first: make mine CH=%s ARGS='%s'\n", chapter.c_str(), path.c_str());
    return true;
}

int check(const std::string& chapter, const MeasureOptions& o, const std::string& worlds,
          const std::string& folder) {
    Watch watch(o.seconds);
    const std::map<std::string, std::string> as = {{"23", "23-few"}, {"24", "24-few"}};
    Findings found = findings_of(
        methods_named({as.contains(chapter) ? as.at(chapter) : chapter}).at(0), o, folder, watch);
    if (found.black) {
        std::printf("All pictures are black: trace brings no light at all. Does it return L?\n");
        return 1;
    }
    bool off = print_off(found, "");
    for (const NamedMethod& m : all_methods()) {
        bool by_area = m.name == chapter + "-area", by_bsdf = m.name == chapter + "-bsdf";
        if (by_area || by_bsdf)
            off |= print_off(findings_of(m, o, folder, watch),
                             by_area ? ", by area" : ", by the BSDF alone");
    }
    if (off) return 1;
    std::printf("Light comes by every class of path as it should.\n");
    return !worlds.empty() && compare_worlds(chapter, o, worlds, folder, watch) ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return seal(run_program([&] {
        std::string file;
        MeasureOptions o = parse_measure_options(
            argc, argv, "CHAPTER [SCENE|write]",
            "Renders the known scenes by a chapter, and says what is not as it should be.",
            {.seconds = 10},
            {{"worlds", "FILE", "also random scenes, beside this file's",
              [&](const std::string& text) { file = text; }}});
        if (o.words.empty()) throw UsageError("error: one chapter is needed, such as 09");
        if (o.words.size() == 2 && o.words[1] == "write") {
            worlds::write(worlds::measure_all(o.words[0], o), file);
            return 0;
        }
        return check(o.words[0], o, file, std::filesystem::path(argv[0]).parent_path().string());
    }));
}
