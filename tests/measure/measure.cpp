#include "tests/measure/measure.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <thread>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/text.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"

namespace {

std::vector<std::string> scenes_in(const char* folder) {
    std::vector<std::string> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".pbrt") scenes.push_back(entry.path().string());
    }
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    return words;
}

MeasureOptions parse_measure_options(int argc, char** argv, const std::string& positional,
                                     const std::string& about, const MeasureOptions& defaults,
                                     const std::vector<Option>& extra) {
    MeasureOptions o = defaults;
    std::vector<Option> options = {
        {"methods", "A,B", "such as 09,15; 15+: chapter 15 and its variants; all: every chapter",
         [&](const std::string& text) { o.methods = split_list(text); }},
        whole_option("spp", "N", "samples per pixel", 1, 1 << 30, o.spp),
        whole_option("runs", "R", "renders with seeds of their own", 2, 100000, o.runs),
        {"size", "WxH", "pixels (default: as the scene says)",
         [&](const std::string& text) {
             std::vector<int> sides = split_numbers(text, 'x');
             if (sides.size() != 2) fail_value("size", text, "WIDTHxHEIGHT, such as 256x256");
             o.width = sides[0], o.height = sides[1];
         }},
        positive_option("seconds", "S", "time to spend (default " + digits(o.seconds) + ")",
                        o.seconds),
        {"out", "DIR", "where tables and charts go (default " + o.out + ")",
         [&](const std::string& text) { o.out = text; }},
    };
    options.insert(options.begin(), extra.begin(), extra.end());
    parse_options(argc, argv, positional, about, options,
                  [&](const std::string& word) { o.words.push_back(word); });
    if (o.threads == 0) {
        o.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    }
    return o;
}

Scene load_scene_for(const std::string& path, const MeasureOptions& options) {
    Scene scene = load_scene(path, nullptr);
    if (options.width > 0) scene.width = options.width, scene.height = options.height;
    if (options.max_depth >= 0) scene.max_depth = options.max_depth;
    prepare(scene, options.threads);
    return scene;
}

Rendering render_once(const NamedMethod& method, Scene& scene, const MeasureOptions& options,
                      int spp, uint32_t seed, bool classes) {
    RenderOptions o;
    o.name = method.name;
    o.threads = options.threads;
    o.sampler = options.sampler;
    o.seed = seed;
    o.quiet = true;
    if (classes) o.split = "in memory";
    scene.spp = spp;
    double start = cpu_seconds();
    Rendering r = render(method, scene, o);
    r.stats.seconds = (cpu_seconds() - start) / options.threads;
    if (r.stats.interrupted) throw InputError("error: interrupted");
    return r;
}

int samples_in(double seconds, const NamedMethod& method, Scene& scene,
               const MeasureOptions& options, bool classes) {
    constexpr int trial = 16;
    double took = render_once(method, scene, options, trial, 0, classes).stats.seconds;
    return std::max(1, static_cast<int>(trial * seconds / took));
}

std::string tab_separated(const Table& table) {
    std::string text = listed(table.columns, "\t", "\t") + '\n';
    for (const auto& cells : table.rows) text += listed(cells, "\t", "\t") + '\n';
    return text;
}

void write_table(const std::string& folder, const std::string& name, const Table& table) {
    std::filesystem::create_directories(folder);
    std::string file = folder + "/" + name + ".tsv";
    write_file_atomically(file, tab_separated(table));
    say_wrote(file);
}

void write_lines(const std::string& folder, const std::string& name, const std::string& title,
                 const std::string& x_label, const std::string& y_label,
                 const std::vector<Line>& lines) {
    Table table{{"panel", "line", x_label, y_label, "colour"}, {}};
    for (const Line& line : lines) {
        for (size_t i = 0; i < line.x.size(); i++) {
            table.rows.push_back(
                {line.panel, line.label, digits(line.x[i]), digits(line.y[i]), line.color});
        }
    }
    write_table(folder, name, table);
    std::string path = folder + "/" + name, words = title;
    std::replace(words.begin(), words.end(), '\'', ' ');
    std::string command = "gnuplot -c tests/measure/plot.gp '" + path + ".tsv' '" + words + "'";
    if (std::system(command.c_str()) != 0)
        throw InputError(path + ".tsv: error: gnuplot failed, or is not installed");
    say_wrote(path + ".svg");
}

std::string short_number(double x) {
    return format(std::abs(x) >= 100 && std::abs(x) < 1e7 ? "%.0f" : "%.3g", x);
}

std::string markdown(const Table& table) {
    // Pad the first column here; the bars then belong to the cells that are aligned.
    Table barred = table;
    barred.rows.insert(barred.rows.begin(), std::vector<std::string>(table.columns.size(), "--:"));
    barred.rows[0][0] = "---";
    size_t width = table.columns[0].size();
    for (const auto& row : barred.rows) width = std::max(width, row[0].size());
    auto add_bars = [&](std::vector<std::string>& cells) {
        cells[0] = "| " + cells[0] + std::string(width - cells[0].size(), ' ');
        for (std::string& cell : cells) cell += " |";
    };
    add_bars(barred.columns);
    for (auto& row : barred.rows) add_bars(row);
    return aligned(barred);
}

std::vector<std::string> own_scenes() { return scenes_in("scenes"); }

std::vector<std::string> all_scenes() {
    std::vector<std::string> scenes = own_scenes(), others = scenes_in("tests/pictures/references");
    scenes.insert(scenes.end(), others.begin(), others.end());
    return scenes;
}

std::string scene_name(const std::string& path) {
    std::filesystem::path p(path);
    std::string folder = p.parent_path().filename().string();
    return (folder == "scenes" ? "" : folder + "/") + p.stem().string();
}

std::string file_name(std::string scene_name) {
    std::replace(scene_name.begin(), scene_name.end(), '/', '-');
    return scene_name;
}

std::map<std::string, Reference> read_references() {
    std::map<std::string, Reference> all;
    std::istringstream lines(read_file(reference_table));
    std::string line, scene;
    std::getline(lines, line);  // the names of the columns
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        Reference r;
        cells >> scene >> r.method >> r.spp >> r.max_depth >> r.rmse;
        all[scene] = r;
    }
    return all;
}

std::string find_scene(const std::string& name) {
    if (std::filesystem::exists(name)) return name;
    std::vector<std::string> known;
    for (const std::string& path : all_scenes()) {
        known.push_back(scene_name(path));
        if (known.back() == name) return path;
    }
    std::string nearest = nearest_word(name, known);
    throw UsageError("error: no scene '" + name + "'" +
                     (nearest.empty() ? "" : " (did you mean '" + nearest + "'?)"));
}
