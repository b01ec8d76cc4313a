// Chapter against chapter: variance at equal samples, time, and both in one number.
#include <cstdio>

#include "common/scene/prepare.h"
#include "tests/measure/measure.h"

namespace {

/// A method on a scene, and its renders.
struct Contender {
    const NamedMethod* method;
    Scene scene;
    int spp;
    bool listed = true;
    std::vector<Image> images = {};
    std::vector<double> seconds = {};  // of each

    /// Of all renders but number `left_out`.
    Spread spread(size_t left_out = SIZE_MAX) const {
        Spread spread;
        for (size_t i = 0; i < images.size(); i++)
            if (i != left_out) spread.add(images[i]);
        return spread;
    }
    double efficiency(const Image& truth, size_t left_out = SIZE_MAX) const {
        std::vector<double> times = seconds;
        if (left_out < times.size()) times.erase(times.begin() + static_cast<int>(left_out));
        return 1 / (spread(left_out).rel_mse(truth) * median(times));
    }
};

std::vector<Contender> contenders_on(const std::string& path,
                                     const std::vector<NamedMethod>& methods,
                                     const MeasureOptions& o) {
    Scene scene = load_scene_for(path, o);
    std::vector<Contender> contenders;
    for (const NamedMethod& method : methods) {
        if (can_render(method, scene)) contenders.push_back({&method, scene, o.spp});
    }
    if (contenders.empty()) return contenders;

    // The last chapter renders too, though nobody asked for it: where all others are noisy, the
    // truth below would be.
    const NamedMethod* last = nullptr;
    for (const NamedMethod& method : all_methods()) {
        if (!method.biased() && !method.is_variant() && can_render(method, scene)) last = &method;
    }
    bool asked = std::any_of(contenders.begin(), contenders.end(), [&](const Contender& c) {
        return last && c.method->name == last->name;
    });
    if (last && !asked) {
        contenders.push_back({.method = last, .scene = scene, .spp = o.spp, .listed = false});
    }
    return contenders;
}

/// Renders by turns, so that what else the machine does slows all of them alike. Returns what all
/// are compared with, one long render of the quietest: the means of so few renders as these miss
/// pixels that are bright in one of them only.
Image run(std::vector<Contender>& contenders, const MeasureOptions& o, Work& work) {
    for (Contender& c : contenders) c.images.clear(), c.seconds.clear();
    for (int run = 0; run < o.runs; run++) {
        work.next(contenders[0].scene.origin->file + ", render " + std::to_string(run + 1) +
                  " of each");
        for (Contender& c : contenders) {
            Rendering r = render_once(*c.method, c.scene, o, c.spp, static_cast<uint32_t>(run));
            c.images.push_back(r.film.image());
            c.seconds.push_back(r.stats.seconds);
        }
    }
    auto noise = [](const Contender& c) { return c.spread().rel_mse(c.spread().mean()); };
    Contender& best =
        *std::min_element(contenders.begin(), contenders.end(),
                          [&](const auto& a, const auto& b) { return noise(a) < noise(b); });
    work.next(best.scene.origin->file + ", the long render that all are compared with");
    return render_once(*best.method, best.scene, o, 8 * best.spp, static_cast<uint32_t>(o.runs))
        .film.image();
}

/// Gives each as many samples as it makes in the time of the first.
void take_equal_time(std::vector<Contender>& contenders) {
    double seconds = median(contenders[0].seconds);
    for (Contender& c : contenders) {
        double spp = c.spp * seconds / median(c.seconds);
        c.spp = std::max(1, static_cast<int>(std::lround(spp)));
    }
}

/// The efficiency of c divided by that of the first; and the least and the largest such number when
/// one render of each is left out.
std::string times_of(const Contender& c, const Contender& first, const Image& truth) {
    std::vector<double> times = {c.efficiency(truth) / first.efficiency(truth)};
    std::string of_all = short_number(times[0]);
    if (&c == &first || c.images.size() < 3) return of_all;
    for (size_t i = 0; i < c.images.size(); i++)
        times.push_back(c.efficiency(truth, i) / first.efficiency(truth, i));
    auto [least, most] = std::minmax_element(times.begin(), times.end());
    return of_all + " (" + short_number(*least) + " to " + short_number(*most) + ")";
}

Table table_of(const std::string& scene, const std::vector<Contender>& contenders,
               const Image& truth) {
    const Contender& first = contenders[0];
    Table table{{scene, "spp", "relMSE", "efficiency", "times " + first.method->name}, {}};
    for (const Contender& c : contenders) {
        if (!c.listed) continue;
        table.rows.push_back({c.method->label, std::to_string(c.spp),
                              short_number(c.spread().rel_mse(truth)),
                              short_number(c.efficiency(truth)), times_of(c, first, truth)});
    }
    return table;
}

/// A chapter's number stands for the chapter before, it and its variants, on its scenes.
void expand_chapter(MeasureOptions& o) {
    if (o.words.size() != 1 || o.words[0].size() != 2) return;
    std::string before;
    for (const NamedMethod& m : all_methods()) {
        if (m.name < o.words[0] && !m.is_variant()) before = m.name;
    }
    NamedMethod chapter = methods_named({o.words[0]})[0];
    if (o.methods.empty()) {
        if (!before.empty()) o.methods.push_back(before);
        o.methods.push_back(chapter.name + "+");
    }
    o.words = chapter.scenes;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        bool equal_time = false;
        Option also = {"equal-time", "", "then once more, with what each makes in equal time",
                       [&](const std::string&) { equal_time = true; }};
        MeasureOptions o = parse_measure_options(
            argc, argv, "CHAPTER|SCENE...",
            "Variance at equal samples, time, and efficiency 1 / (relMSE seconds), of several "
            "methods. A chapter's number stands for the chapter before, it and its variants, on "
            "its scenes. Seconds are of the processors, over threads.",
            {.spp = 64, .runs = 3, .width = 256, .height = 256}, {also});
        expand_chapter(o);
        if (o.words.empty()) o.words = {"cornell"};
        if (o.methods.empty()) o.methods = {"all"};
        std::vector<NamedMethod> methods = methods_named(o.methods);
        std::printf("%dx%d pixels, %d renders each, %d threads\n", o.width, o.height, o.runs,
                    o.threads);
        double rounds = static_cast<double>(o.words.size()) * (equal_time ? 2 : 1);
        Work work("efficiency: " + std::to_string(methods.size()) + " methods at equal samples" +
                      (equal_time ? ", then in equal time" : ""),
                  rounds * (o.runs + 1));
        for (const std::string& word : o.words) {
            std::string path = find_scene(word), name = file_name(scene_name(path));
            std::vector<Contender> contenders = contenders_on(path, methods, o);
            if (contenders.empty()) continue;
            Image truth = run(contenders, o, work);
            Table table = table_of(scene_name(path), contenders, truth);
            std::printf("\n%s", markdown(table).c_str());
            write_table(o.out, "efficiency-" + name, table);
            if (!equal_time) continue;
            take_equal_time(contenders);
            truth = run(contenders, o, work);
            table = table_of("in equal time", contenders, truth);
            std::printf("\n%s", markdown(table).c_str());
            write_table(o.out, "equal-time-" + name, table);
        }
        return 0;
    });
}
