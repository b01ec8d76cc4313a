// Rays per second of each step of chapter 06, beside Embree where it is installed.
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <thread>

#include "chapters/06_bvh/estimator.h"
#include "common/base/error.h"
#include "tests/measure/bench_chart.h"
#include "tests/measure/bench_embree.h"
#include "tests/measure/bench_rays.h"
#include "tests/measure/measure.h"
#include "tests/support/work.h"

namespace {

struct BenchOptions {
    int runs = 5, size = 384;  // size^2 primary rays
    int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::string out = "out";
    std::vector<std::string> meshes = {};  // parts of names; empty: all
};

/// Something that finds hits: traces all rays, and returns a sum over what it found.
struct Contender {
    std::string name;
    std::function<double(const std::vector<Ray>& rays, bool any)> trace;
};

/// A sum over the rays; closest(ray) is a distance or infinity, any(ray) a truth.
template <typename Closest, typename Any>
Contender contender(const std::string& name, const Closest& closest, const Any& any_hit) {
    return {name, [=](const std::vector<Ray>& rays, bool any) {
                double sum = 0;
                if (any) {
                    for (const Ray& ray : rays) sum += any_hit(ray);
                } else {
                    for (const Ray& ray : rays) {
                        float t = closest(ray);
                        if (t < infinity) sum += static_cast<double>(t);
                    }
                }
                return sum;
            }};
}

/// Seconds of processor time per ray: the median over runs in which all take turns, so that what
/// else the machine does slows all of them alike. The slow ones trace
/// some of the rays only, evenly taken.
std::vector<double> seconds_per_ray(const std::vector<Contender>& contenders, const RaySet& set,
                                    int runs) {
    constexpr double enough = 0.04;  // s, for one run of a slow one
    std::vector<std::vector<Ray>> rays;
    auto every = [&](size_t stride) {
        std::vector<Ray> some;
        for (size_t i = 0; i < set.rays.size(); i += stride) some.push_back(set.rays[i]);
        return some;
    };
    std::vector<Ray> few = every(set.rays.size() / 50 + 1);
    for (const Contender& c : contenders) {
        Stopwatch watch;
        c.trace(few, set.any);
        double all = watch.seconds() * static_cast<double>(set.rays.size() / few.size());
        bool fast = c.name == "wide" || c.name.starts_with("Embree");
        rays.push_back(every(fast ? 1 : static_cast<size_t>(all / enough) + 1));
    }
    std::vector<std::vector<double>> seconds(contenders.size());
    for (int run = 0; run < runs; run++) {
        for (size_t i = 0; i < contenders.size(); i++) {
            Stopwatch watch;
            volatile double sum = contenders[i].trace(rays[i], set.any);
            static_cast<void>(sum);
            seconds[i].push_back(watch.seconds() / static_cast<double>(rays[i].size()));
        }
    }
    std::vector<double> medians;
    for (const auto& s : seconds) medians.push_back(median(s));
    return medians;
}

/// Median seconds of a build, of the processors and by the clock on the wall.
struct BuildTime {
    double processor, wall;
};
/// What is to be done before a build, and the build.
struct Build {
    std::function<void()> prepare, build;
};
/// Over runs in which all take turns: as many as asked for, fewer when they take twenty seconds, up
/// to ten times as many when they are short.
std::vector<BuildTime> build_times(const std::vector<Build>& builds, int runs) {
    std::vector<std::vector<double>> processor(builds.size()), wall(builds.size());
    double sum = 0;
    for (int run = 0; sum < (run < runs ? 20 : 1) && run < 10 * runs; run++) {
        for (size_t i = 0; i < builds.size(); i++) {
            builds[i].prepare();
            Stopwatch watch;
            auto begin = std::chrono::steady_clock::now();
            builds[i].build();
            std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
            processor[i].push_back(watch.seconds());
            wall[i].push_back(taken.count());
            sum += taken.count();
        }
    }
    std::vector<BuildTime> medians;
    for (size_t i = 0; i < builds.size(); i++)
        medians.push_back({median(processor[i]), median(wall[i])});
    return medians;
}

/// All that is measured: a table of rays, one of builds, and the ratios to Embree's better one.
struct Results {
    Table rays{{"M rays/s", "rays", "linear", "median", "sah", "ordered", "four", "wide",
                "Embree medium", "Embree high", "wide/Embree"},
               {}};
    Table builds{{"build: s per M", "triangles", "SAH median", "SAH sah", "median", "sah", "wide",
                  "by threads", "bytes", "Embree medium", "its by threads", "its bytes",
                  "Embree high", "high bytes"},
                 {}};
    std::map<std::string, std::vector<double>> ratios = {};  // by the kind of ray
    std::map<std::string, std::vector<double>> gains = {};   // of a step over the one before
    double differ = 0;  // largest share of rays in a cell for which Embree finds something else
};

/// The hierarchies over one mesh.
class Bench {
public:
    Bench(const BenchMesh& mesh, const BenchOptions& o) : mesh_(mesh), o_(o) {
        scene_.geometry = mesh.make();
    }

    void measure(Results& results) {
        build(results.builds);
        for (const RaySet& set : rays_for(mesh_, scene_.geometry, wide_, o_.size)) {
            measure(set, results);
        }
    }

private:
    void build(Table& table) {
        const Geometry& g = scene_.geometry;
        double n = static_cast<double>(g.size()), millions = n / 1e6;
        auto step = [&](ch06::Finder& finder, ch06::Step which) {
            Build build{[] {}, [&finder, which, this] { finder = make_finder(scene_, which); }};
            return build_times({build}, 1)[0];
        };
        BuildTime by_median = step(median_, ch06::Step::median);
        BuildTime by_sah = step(sah_, ch06::Step::sah);
        four_ = make_finder(scene_, ch06::Step::four);
        auto own = [&](int threads) {
            return Build{[&] { wide_ = {}; }, [&, threads] { wide_ = build_bvh(g, threads); }};
        };
        auto embree = [&](std::unique_ptr<Embree>& built, bool high, int threads) {
            return Build{[&, high, threads] { built = std::make_unique<Embree>(g, high, threads); },
                         [&built] { built->commit(); }};
        };
        std::vector<BuildTime> times =
            build_times({own(1), own(o_.threads), embree(medium_, false, o_.threads),
                         embree(medium_, false, 1)},
                        o_.runs);
        BuildTime wide = times[0], wide_parallel = times[1];
        BuildTime medium_parallel = times[2], medium = times[3];
        BuildTime high = build_times({embree(high_, true, 1)}, 1)[0];
        double bytes = static_cast<double>(wide_.nodes.size() * sizeof(BvhNode) +
                                           wide_.blocks.size() * sizeof(BvhBlock));
        table.rows.push_back({mesh_.name, std::to_string(g.size())});
        for (double x : {sah_cost(median_.hierarchy), sah_cost(sah_.hierarchy),
                         by_median.processor / millions, by_sah.processor / millions,
                         wide.processor / millions, wide.wall / wide_parallel.wall, bytes / n}) {
            table.rows.back().push_back(short_number(x));
        }
        for (double x : {medium.processor / millions, medium.wall / medium_parallel.wall,
                         medium_->bytes() / n, high.processor / millions, high_->bytes() / n}) {
            table.rows.back().push_back(have_embree ? short_number(x) : "-");
        }
    }

    std::vector<Contender> contenders() {
        const Geometry& g = scene_.geometry;
        // The chapter's own steps have no way to ask for any hit: they look for the nearest.
        auto step = [&g](ch06::Finder& finder, ch06::Step which) {
            auto closest = [&g, &finder, which](const Ray& ray) {
                ch06::Work work;
                finder.step = which;
                return find(finder, g, ray, work).t;
            };
            return contender(ch06::step_names[static_cast<size_t>(which)], closest,
                             [=](const Ray& ray) { return closest(ray) < infinity; });
        };
        std::vector<Contender> all;
        if (g.size() < 1000) all.push_back(step(linear_, ch06::Step::linear));
        all.push_back(step(median_, ch06::Step::median));
        all.push_back(step(sah_, ch06::Step::sah));
        all.push_back(step(sah_, ch06::Step::ordered));
        all.push_back(step(four_, ch06::Step::four));
        all.push_back(contender(
            "wide", [this](const Ray& ray) { return closest_hit(wide_, scene_.geometry, ray).t; },
            [this](const Ray& ray) { return any_hit(wide_, scene_.geometry, ray); }));
        if (!have_embree) return all;
        for (Embree* embree : {medium_.get(), high_.get()}) {
            all.push_back(contender(
                embree == medium_.get() ? "Embree medium" : "Embree high",
                [embree](const Ray& ray) { return embree->closest_t(ray); },
                [embree](const Ray& ray) { return embree->any_hit(ray); }));
        }
        return all;
    }

    void measure(const RaySet& set, Results& results) {
        std::vector<Contender> all = contenders();
        std::vector<double> seconds = seconds_per_ray(all, set, o_.runs);
        std::vector<std::string> row = {mesh_.name, set.name};
        if (all[0].name != "linear") row.push_back("-");
        for (double s : seconds) row.push_back(short_number(1e-6 / s));
        for (size_t i = 1; i < all.size() && all[i].name.rfind("Embree", 0) != 0; i++) {
            results.gains[all[i].name].push_back(seconds[i - 1] / seconds[i]);
        }
        if (have_embree) {
            size_t n = seconds.size();
            double ratio = std::min(seconds[n - 2], seconds[n - 1]) / seconds[n - 3];
            results.ratios[set.name].push_back(ratio);
            row.push_back(short_number(ratio));
            results.differ = std::max(results.differ, differing_share(set));
        }
        row.resize(results.rays.columns.size(), "-");
        results.rays.rows.push_back(row);
    }

    /// Of the rays, those for which Embree finds nothing, or something more than 1 % away.
    double differing_share(const RaySet& set) {
        const Geometry& g = scene_.geometry;
        double differing = 0;
        for (const Ray& ray : set.rays) {
            if (set.any) {
                differing += any_hit(wide_, g, ray) != medium_->any_hit(ray);
            } else {
                float t = closest_hit(wide_, g, ray).t, embree = medium_->closest_t(ray);
                differing += t != embree && !(std::abs(t - embree) < 0.01f * t);
            }
        }
        return differing / static_cast<double>(set.rays.size());
    }

    const BenchMesh& mesh_;
    const BenchOptions& o_;
    Scene scene_;
    ch06::Finder linear_, median_, sah_, four_;
    Bvh wide_;
    std::unique_ptr<Embree> medium_, high_;
};

double geometric_mean(const std::vector<double>& values) {
    double sum = 0;
    for (double x : values) sum += std::log(x);
    return std::exp(sum / static_cast<double>(values.size()));
}

std::string summary(const Results& results) {
    std::string text =
        "bytes: of the hierarchy, for each triangle; by threads: how many times faster with all\n"
        "each step over the one before, geometric means:";
    for (const char* step : {"sah", "ordered", "four", "wide"}) {
        text +=
            std::string(" ") + step + " " + short_number(geometric_mean(results.gains.at(step)));
    }
    if (!have_embree) return text + "\nEmbree is not installed (libembree-dev): no ratios\n";
    std::vector<double> all;
    text += "\nwide / the better Embree, geometric means:";
    for (const auto& [name, ratios] : results.ratios) {
        text += " " + name + " " + short_number(geometric_mean(ratios)) + ",";
        all.insert(all.end(), ratios.begin(), ratios.end());
    }
    return text + " all " + short_number(geometric_mean(all)) + "; least " +
           short_number(*std::min_element(all.begin(), all.end())) +
           "\nEmbree finds another hit for at most " + short_number(1e6 * results.differ) +
           " rays in a million\n";
}

BenchOptions parse_bench_options(int argc, char** argv) {
    BenchOptions o;
    auto integer = [](const char* name, int& value, int low, int high) {
        return [=, &value](const std::string& text) {
            value = static_cast<int>(parse_integer(name, text, low, high));
        };
    };
    std::vector<Option> options = {
        {"runs", "R", "of which the median counts (default 5)", integer("runs", o.runs, 1, 1000)},
        {"size", "N", "N x N primary rays (default 384)", integer("size", o.size, 8, 10000)},
        {"threads", "T", "of the parallel build (default: one for each processor)",
         integer("threads", o.threads, 1, 1024)},
        {"out", "DIR", "where bench.tsv, bench-build.tsv and the chart go (default out)",
         [&](const std::string& text) { o.out = text; }}};
    parse_options(argc, argv, "MESH...",
                  "Rays per second of the steps of chapter 06, on one thread, beside Embree where "
                  "it is installed. MESH: part of a name, such as hall.",
                  options, [&](const std::string& word) { o.meshes.push_back(word); });
    return o;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        BenchOptions o = parse_bench_options(argc, argv);
        std::vector<BenchMesh> meshes;
        for (const BenchMesh& mesh : all_meshes()) {
            auto named = [&](const std::string& word) {
                return mesh.name.find(word) != std::string::npos;
            };
            if (o.meshes.empty() || std::any_of(o.meshes.begin(), o.meshes.end(), named))
                meshes.push_back(mesh);
        }
        if (meshes.empty()) throw UsageError("error: no mesh has a name with that in it");
        Work work(have_embree ? "bench: rays per second on one thread, beside Embree"
                              : "bench: rays per second on one thread. Embree is not installed "
                                "(libembree-dev), so nothing stands beside it",
                  static_cast<double>(meshes.size()));
        Results results;
        for (const BenchMesh& mesh : meshes) {
            work.next(mesh.name);
            Bench(mesh, o).measure(results);
        }
        std::printf("%s\n%s\n%s", markdown(results.builds).c_str(), markdown(results.rays).c_str(),
                    summary(results).c_str());
        write_table(o.out, "bench", results.rays);
        write_table(o.out, "bench-build", results.builds);
        if (!results.rays.rows.empty()) draw_bench(o.out + "/bench", results.rays, 8);
        return 0;
    });
}
