// compare_scenes NN [SCENE]: renders the known scenes by chapter NN, or one of them, and says what
// is not as it should be.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <set>
#include <string>
#include <thread>

#include "common/base/error.h"
#include "common/base/ray_count.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/check/findings.h"
#include "tests/measure/measure.h"
#include "tests/methods/table.h"
#include "tests/support/seal.h"

namespace {

/// While it lives, the program ends with code 4 and says where, if one path traces very many rays,
/// or if a path, or what is prepared before the paths, takes this long.
class Watch {
public:
    static constexpr uint64_t most_rays = 30000;  // of one path

    /// most      s, of processor time
    explicit Watch(double most) : most_(most) {}
    ~Watch() {
        ends_ = true;
        looks_.join();
    }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

    /// What follows renders this scene.
    void renders(const std::string& scene) {
        std::lock_guard lock(mutex_);
        scene_ = scene;
    }

    /// The same method, watched.
    NamedMethod watched(NamedMethod method) {
        method.make = [this, make = method.make](const Scene& scene, RenderOptions& options) {
            Method made = make(scene, options);
            made.trace = [this, trace = made.trace](const Scene& s, const Ray& ray, Splats& splats,
                                                    Sampler& sampler, Recorder& recorder) {
                OnAPath path(*this);
                return trace(s, ray, splats, sampler, recorder);
            };
            return made;
        };
        return method;
    }

private:
    struct OnAPath {
        explicit OnAPath(Watch& w) : watch(w) {
            std::lock_guard lock(watch.mutex_);
            watch.rays_before_ = rays_traced;
            watch.rays_ = &rays_traced;
        }
        ~OnAPath() {
            std::lock_guard lock(watch.mutex_);
            watch.rays_ = nullptr;
            watch.steps_++;
        }
        Watch& watch;
    };

    void look() {
        constexpr std::chrono::milliseconds pause(30);
        double last_step = 0;
        for (uint64_t seen = 0; !ends_; std::this_thread::sleep_for(pause)) {
            double now = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
            std::lock_guard lock(mutex_);
            if (steps_ != seen) seen = steps_, last_step = now;
            uint64_t rays = rays_ != nullptr ? *rays_ - rays_before_ : 0;
            if (rays > most_rays || now - last_step > most_) end(rays, now - last_step);
        }
    }
    [[noreturn]] void end(uint64_t rays, double seconds) const {
        std::string what = "what is prepared before the paths has no end";
        if (rays_ != nullptr)
            what = "a path has no end: it traced " + std::to_string(rays) + " rays";
        std::printf("No end: in `%s` %s in %.1f s.\n", scene_.c_str(), what.c_str(), seconds);
        std::fflush(stdout);
        std::_Exit(4);
    }

    const double most_;
    std::mutex mutex_;  // of what follows
    std::string scene_;
    uint64_t steps_ = 0;              // paths, and what was prepared
    const RayCount* rays_ = nullptr;  // of the thread that follows a path
    uint64_t rays_before_ = 0;        // this path
    std::atomic<bool> ends_ = false;
    std::thread looks_{[this] { look(); }};
};

constexpr int batches = 16;

/// What each class of path brings, from the spread of several renders; "all": the picture's mean.
std::map<std::string, Quantity> measure(const NamedMethod& method, const KnownScene& known,
                                        const MeasureOptions& o, int samples, uint32_t first_seed) {
    Scene scene = parse_scene("known.pbrt", known.text, nullptr);
    prepare(scene, o.threads);
    std::map<std::string, RunningStats> stats;
    // Chapter 19 shares out only what is left after the first 16 samples.
    bool shared_out = method.name.starts_with("19") && known.name == "rare-light";
    int spp = std::max(samples / batches, shared_out ? 32 : 2);
    for (int batch = 0; batch < batches; batch++) {
        Rendering r =
            render_once(method, scene, o, spp, first_seed + static_cast<uint32_t>(batch), true);
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
    bool is_small = scene.name == "sky" || scene.name == "sky-picture";
    if (chapter == 20 && has("infinite") && !is_small) return false;
    if (chapter != 25 && is_blurred(scene, method)) return false;
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
    const KnownScene* scene;
    std::string name;
    Quantity ratio;      // measured over expected
    bool leaks = false;  // it should bring nothing
};

struct Findings {
    std::vector<Off> off = {};
    int classes = 0;    // compared
    bool black = true;  // no class brings anything
};

void compare(const KnownScene& scene, const NamedMethod& method, const MeasureOptions& o,
             Findings& findings) {
    constexpr int times_blurred = 40, times = 3;  // as many samples as the scene says
    bool blurred = is_blurred(scene, method);
    int samples = scene.samples * (blurred ? times_blurred : times);
    double least = blurred ? 0.12 : 0.008;
    auto measured = measure(method, scene, o, samples, 1);
    auto expected = scene.light;
    for (const auto& [name, q] : measured) expected.insert({name, Quantity{}});
    std::vector<Off> off;
    bool is_sure = false;
    auto look_at = [&](const std::string& name, Quantity should) {
        Quantity is = measured[name];
        if (!is_seen(method, name) || !is_off(is, should, least)) return;
        bool leaks = !(should.mean > 0);
        Quantity ratio = leaks ? is : ratio_of(is, should);
        off.push_back({&scene, name, ratio, leaks});
        is_sure |= !(std::abs(ratio.mean - 1) < 20 * ratio.se) && is.mean != 0 && !leaks;
    };
    for (const auto& [name, should] : expected) {
        if (!is_class(name)) continue;
        findings.classes += should.mean > 0;
        findings.black &= measured[name].mean == 0;
        look_at(name, should);
    }
    if (off.empty()) look_at("all", expected["all"]);
    if (findings.off.empty() && !off.empty() && !is_sure) {
        // A rare path may be missing, or there too often, by chance: but not twice.
        auto again = measure(method, scene, o, 8 * samples, 1000);
        std::erase_if(off, [&](const Off& found) {
            return !is_off(again[found.name], expected[found.name], least);
        });
    }
    findings.off.insert(findings.off.end(), off.begin(), off.end());
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
    std::string factor = name_factor(o.ratio.mean);
    std::string what = (o.name == "all" ? "the light" : o.name) + " in " + o.scene->what + " is ";
    if (o.leaks) return what + "there, and should not be";
    if (!std::isfinite(o.ratio.mean))
        return what + "not a number: make mine names such a pixel, and what shows its path";
    return what + short_number(o.ratio.mean) + (factor.empty() ? "" : " (" + factor + ")") +
           " of what it should be";
}

Findings findings_of(const NamedMethod& method, const MeasureOptions& o, Watch& watch) {
    Findings findings;
    NamedMethod watched = watch.watched(method);
    bool one_alone = o.words.size() > 1;
    for (const KnownScene& scene : known_scenes()) {
        if (!fits(scene, method) || (one_alone && scene.name != o.words[1])) continue;
        watch.renders(scene.name);
        compare(scene, watched, o, findings);
    }
    return findings;
}

/// What is off, by one way in which the chapter finds light. Returns whether anything is.
bool print_off(const Findings& found, const std::string& way) {
    if (found.off.empty()) return false;
    auto of_paths = std::count_if(found.off.begin(), found.off.end(),
                                  [](const Off& o) { return is_class(o.name); });
    std::printf("%d of %d classes of path are off%s. Most surely: %s.\n",
                static_cast<int>(of_paths), found.classes, way.c_str(),
                worst_of(found.off).c_str());
    for (size_t i = 0; i < std::min<size_t>(found.off.size(), 12); i++) {
        const Off& o = found.off[i];
        std::printf("    %-18s %-10s ", o.scene->name.c_str(), o.name.c_str());
        if (o.leaks)
            std::printf("light where there should be none\n");
        else if (!std::isfinite(o.ratio.mean))
            std::printf("not a number\n");
        else
            std::printf("%8.4f +- %.4f\n", o.ratio.mean, o.ratio.se);
    }
    return true;
}

int check(const std::string& chapter, const MeasureOptions& o) {
    Watch watch(o.seconds);
    const std::map<std::string, std::string> as = {{"23", "23-few"}, {"24", "24-few"}};
    Findings found = findings_of(
        methods_named({as.contains(chapter) ? as.at(chapter) : chapter}).at(0), o, watch);
    if (found.black) {
        std::printf("All pictures are black: trace brings no light at all. Does it return L?\n");
        return 1;
    }
    bool off = print_off(found, "");
    for (const NamedMethod& m : all_methods()) {
        bool by_area = m.name == chapter + "-area", by_bsdf = m.name == chapter + "-bsdf";
        if (by_area || by_bsdf)
            off |=
                print_off(findings_of(m, o, watch), by_area ? ", by area" : ", by the BSDF alone");
    }
    if (!off) std::printf("Light comes by every class of path as it should.\n");
    return off ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return seal(run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "CHAPTER [SCENE]",
            "Renders the known scenes by a chapter, and says what is not as it should be.",
            {.seconds = 10});
        if (o.words.empty()) throw UsageError("error: one chapter is needed, such as 09");
        return check(o.words[0], o);
    }));
}
