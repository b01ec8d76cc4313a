// Do all methods say the same? In total, block by block, for each path length and class of path.
#include <cstdio>
#include <map>

#include "common/base/error.h"
#include "common/scene/prepare.h"
#include "tests/measure/measure.h"

namespace {

/// The values of each quantity, batch by batch: "total", "block 16,32", "length 2", "class LDE";
/// and "part of 16,32: LDE", which is not judged but tells what a method may miss in a block.
using Batches = std::map<std::string, std::vector<double>>;

constexpr int block = 16;  // pixels

double block_mean(const Image& image, int x0, int y0) {
    RunningStats mean;
    for (int y = y0; y < std::min(image.height, y0 + block); y++) {
        for (int x = x0; x < std::min(image.width, x0 + block); x++) {
            mean.add(static_cast<double>(average(image.at(x, y))));
        }
    }
    return mean.mean();
}

void add_batch(const Rendering& r, size_t batch, size_t count, Batches& batches) {
    auto at = [&](const std::string& key) -> double& {
        std::vector<double>& values = batches[key];
        values.resize(count);
        return values[batch];
    };
    auto add_blocks = [&](const Image& image, const std::string& before, const std::string& after) {
        for (int y = 0; y < image.height; y += block) {
            for (int x = 0; x < image.width; x += block) {
                std::string place = std::to_string(x) + "," + std::to_string(y);
                at(before + place + after) += block_mean(image, x, y);
            }
        }
    };
    at("total") = r.film.mean();
    add_blocks(r.film.image(), "block ", "");
    for (const auto& [path_class, film] : r.classes) {
        bool is_long = path_class == "longer";
        std::string length = is_long ? path_class : std::to_string(path_class.size() - 2);
        at("class " + path_class) += film.mean();
        add_blocks(film.image(), "part of ", ": " + path_class);
        at("length " + length) += film.mean();
    }
}

/// Renders `runs` batches, in about `seconds` together.
Batches measure(const NamedMethod& method, size_t index, Scene& scene, const MeasureOptions& o,
                double seconds) {
    auto seed = [&](int run) {
        return static_cast<uint32_t>(1000 * index) + static_cast<uint32_t>(run);
    };
    int spp = samples_in(seconds / o.runs, method, scene, o, true);
    Batches batches;
    for (int run = 0; run < o.runs; run++) {
        Rendering r = render_once(method, scene, o, spp, seed(run), true);
        add_batch(r, static_cast<size_t>(run), static_cast<size_t>(o.runs), batches);
    }
    return batches;
}

/// What one method found on a scene.
struct Column {
    const NamedMethod* method;
    Batches batches;
    std::map<std::string, double> worst = {};  // |z| by kind
    double z_total = NAN, relative_se = NAN;
};

/// Judges one quantity of one method: a row of the details, and a line where it fails.
void judge_one(const std::string& scene, const std::string& key, Column& c, const Estimate& e,
               const Verdict& v, Table& details, std::string& failures) {
    if (key == "total") {
        c.relative_se = e.se / e.mean;
        if (v.known) c.z_total = v.z;
    }
    auto known = [&](double x, int significant) { return v.known ? digits(x, significant) : "-"; };
    details.rows.push_back({scene, c.method->name, key, digits(e.mean, 6), digits(e.se, 3),
                            known(v.others_mean, 6), known(v.others_se, 3),
                            v.known ? digits(v.z, 3) : "too few lucky samples"});
    if (!v.known) return;
    double& worst = c.worst[key.substr(0, key.find(' '))];
    worst = std::max(worst, std::abs(v.z));
    if (std::abs(v.z) <= 5) return;
    const std::vector<std::string>& row = details.rows.back();
    failures += scene + ", chapter " + row[1] + ", " + key + ": " + row[3] + " +- " + row[4] +
                ", the others " + row[5] + " +- " + row[6] + ", z " + row[7] + "\n";
}

/// What other methods surely have found of classes of paths (those quantities that begin with
/// `kind`) of which a method has too few samples to tell how much they vary, beyond what it has.
double missed_by(const Column& c, const std::vector<Column>& all, const std::string& kind) {
    std::map<std::string, double> most;
    for (const Column& other : all) {
        for (auto i = other.batches.lower_bound(kind); i != other.batches.end(); i++) {
            const auto& [key, values] = *i;
            if (!key.starts_with(kind)) break;
            Estimate e = estimate_of(values);
            most[key] = std::max(most[key], e.mean - 3 * e.se);
        }
    }
    double missed = 0;
    for (const auto& [key, at_least] : most) {
        auto found = c.batches.find(key);
        Estimate own = found == c.batches.end() ? Estimate{} : estimate_of(found->second);
        if (!own.reliable()) missed += std::max(0.0, at_least - (own.mean + 3 * own.se));
    }
    return missed;
}

void judge_scene(const std::string& scene, std::vector<Column>& columns, Table& details,
                 std::string& failures) {
    Batches all;
    for (const Column& c : columns) all.insert(c.batches.begin(), c.batches.end());
    for (const auto& [key, unused] : all) {
        if (key.starts_with("part of ")) continue;
        bool is_class = key.starts_with("class "), is_rest = key.ends_with(" longer");
        bool is_block = key.starts_with("block ");
        std::string parts = is_block ? "part of " + key.substr(6) + ": " : "class ";
        std::vector<Estimate> estimates;
        for (size_t i = 0; i < columns.size(); i++) {
            const Batches& batches = columns[i].batches;
            auto found = batches.find(key);
            Estimate e = found == batches.end() ? Estimate{} : estimate_of(found->second);
            // Who misses some classes by chance may miss some of those that are counted together.
            double missed = missed_by(columns[i], columns, parts);
            if (is_rest && missed > 0) missed = INFINITY;
            if (is_rest || !is_class) e.missed = missed;
            estimates.push_back(e);
        }
        for (size_t i = 0; i < estimates.size(); i++) {
            judge_one(scene, key, columns[i], estimates[i], judge(estimates, i), details, failures);
        }
    }
}

std::string cell(const Column& c) {
    double worst = 0;
    for (const auto& [kind, z] : c.worst) worst = std::max(worst, z);
    if (std::isnan(c.z_total)) return "?";
    return format("%+.1f %4.1f", c.z_total, worst) + (c.relative_se > 0.01 ? "*" : " ");
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        MeasureOptions o = parse_measure_options(
            argc, argv, "[SCENE...]",
            "z values of every method against all others, on every scene: in total, in blocks of "
            "16x16 pixels, for each path length and each class of path. Beyond 5 it fails. 23 to "
            "25, which blur light, take part only when they are named.",
            {.spp = 0, .runs = 64, .width = 64, .height = 64, .seconds = 300});
        if (o.words.empty()) o.words = all_scenes();
        bool all = o.methods.empty();
        if (all) o.methods = {"all", "13-bsdf"};
        std::vector<NamedMethod> methods = methods_named(o.methods);
        // Photons blur light: with these few passes their picture is meant to be another one.
        if (all) std::erase_if(methods, [](const NamedMethod& m) { return m.biased(); });
        Table matrix{{"scene"}, {}};
        for (const NamedMethod& m : methods) matrix.columns.push_back(m.name);
        Table details{{"scene", "chapter", "quantity", "mean", "standard error", "mean of others",
                       "standard error of others", "z"},
                      {}};
        std::string failures;
        double cell_seconds = o.seconds / static_cast<double>(o.words.size() * methods.size());
        Work work("agree: " + std::to_string(methods.size()) + " methods against each other on " +
                      std::to_string(o.words.size()) + " scenes",
                  static_cast<double>(o.words.size() * methods.size()), o.seconds);
        for (const std::string& word : o.words) {
            try {
                Scene scene = load_scene_for(find_scene(word), o);
                std::string name = scene_name(scene.origin->file);
                std::vector<Column> columns;  // of the methods that can render it
                for (size_t m = 0; m < methods.size(); m++) {
                    work.next(name + ", " + methods[m].name);
                    if (!can_render(methods[m], scene)) continue;
                    columns.push_back(
                        {&methods[m], measure(methods[m], m, scene, o, cell_seconds)});
                }
                judge_scene(name, columns, details, failures);
                matrix.rows.emplace_back(matrix.columns.size(), "-");
                matrix.rows.back()[0] = name;
                for (const Column& c : columns) {
                    auto column = static_cast<size_t>(c.method - methods.data()) + 1;
                    matrix.rows.back()[column] = cell(c);
                }
            } catch (const InputError& e) {
                std::printf("left out: %s\n", e.what());
            }
        }
        std::printf("%s", aligned(matrix).c_str());
        std::printf(
            "z of the image mean, then the largest |z| of blocks, lengths and classes.\n"
            "*: its standard error is above 1 %% of the mean; ?: too few lucky samples.\n%s",
            failures.c_str());
        write_table(o.out, "agree", details);
        return failures.empty() ? 0 : 1;
    });
}
