// Chapter against chapter: variance at equal samples, time, and both in one number.
#include <cstdio>

#include "tests/measure/measure.h"
#include "tests/support/work.h"

namespace {

/// Renders of a method on a scene.
struct Renders {
    Spread spread = {};
    std::vector<double> seconds = {};
    double rel_mse = 0;  // of one render

    void add(const Rendering& r) {
        spread.add(r.film.image());
        seconds.push_back(r.stats.seconds);
    }
    double efficiency() const { return 1 / (rel_mse * median(seconds)); }
};

/// A method on a scene.
struct Contender {
    const NamedMethod* method;
    Scene scene;
    int spp;
    Renders all = {};
    std::vector<Renders> without = {};  // i: all but render i
    bool listed = true;
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

/// Renders by turns, so that what else the machine does slows all of them alike.
void run(std::vector<Contender>& contenders, const MeasureOptions& o, Work& work) {
    for (Contender& c : contenders) c.all = {}, c.without.assign(static_cast<size_t>(o.runs), {});
    for (int run = 0; run < o.runs; run++) {
        work.next(contenders[0].scene.file + ", render " + std::to_string(run + 1) + " of each");
        for (Contender& c : contenders) {
            Rendering r = render_once(*c.method, c.scene, o, c.spp, static_cast<uint32_t>(run));
            c.all.add(r);
            for (int i = 0; i < o.runs; i++)
                if (i != run) c.without[static_cast<size_t>(i)].add(r);
        }
    }

    // Compare all of them with one long render of the quietest: the means of so few renders as
    // these miss pixels that are bright in one of them only.
    auto noise = [](const Contender& c) { return c.all.spread.rel_mse(c.all.spread.mean()); };
    Contender& best =
        *std::min_element(contenders.begin(), contenders.end(),
                          [&](const auto& a, const auto& b) { return noise(a) < noise(b); });
    work.next(best.scene.file + ", the long render that all are compared with");
    Image truth =
        render_once(*best.method, best.scene, o, 8 * best.spp, static_cast<uint32_t>(o.runs))
            .film.image();
    for (Contender& c : contenders) {
        c.all.rel_mse = c.all.spread.rel_mse(truth);
        for (Renders& r : c.without) r.rel_mse = r.spread.rel_mse(truth);
    }
}

/// Gives each as many samples as it makes in the time of the first.
void take_equal_time(std::vector<Contender>& contenders) {
    double seconds = median(contenders[0].all.seconds);
    for (Contender& c : contenders) {
        double spp = c.spp * seconds / median(c.all.seconds);
        c.spp = std::max(1, static_cast<int>(std::lround(spp)));
    }
}

/// The efficiency of c divided by that of the first; and the least and the largest such number when
/// one render of each is left out.
std::string times_of(const Contender& c, const Contender& first) {
    std::vector<double> times = {c.all.efficiency() / first.all.efficiency()};
    std::string of_all = short_number(times[0]);
    if (&c == &first || c.without.size() < 3) return of_all;
    for (size_t i = 0; i < c.without.size(); i++)
        times.push_back(c.without[i].efficiency() / first.without[i].efficiency());
    auto [least, most] = std::minmax_element(times.begin(), times.end());
    return of_all + " (" + short_number(*least) + " to " + short_number(*most) + ")";
}

Table table_of(const std::string& scene, const std::vector<Contender>& contenders) {
    const Contender& first = contenders[0];
    Table table{{scene, "spp", "relMSE", "efficiency", "times " + first.method->name}, {}};
    for (const Contender& c : contenders) {
        if (!c.listed) continue;
        table.rows.push_back({c.method->label, std::to_string(c.spp), short_number(c.all.rel_mse),
                              short_number(c.all.efficiency()), times_of(c, first)});
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
            run(contenders, o, work);
            Table table = table_of(scene_name(path), contenders);
            std::printf("\n%s", markdown(table).c_str());
            write_table(o.out, "efficiency-" + name, table);
            if (!equal_time) continue;
            take_equal_time(contenders);
            run(contenders, o, work);
            table = table_of("in equal time", contenders);
            std::printf("\n%s", markdown(table).c_str());
            write_table(o.out, "equal-time-" + name, table);
        }
        return 0;
    });
}
