// The rule of promotion: what chapter N teaches stands in common/ for the chapters after it,
// unchanged, comments included; a header that begins with "// taught by chapter NN" holds that and
// nothing else, and no chapter up to NN reads it.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/files.h"
#include "common/base/system.h"

namespace {

/// What a chapter taught, and where it stands now.
struct Promoted {
    std::string chapter, header;
    std::vector<std::string> definitions;
    std::string file = "estimator.h";  // of the chapter
};
const std::vector<Promoted> promoted = {
    {"01", "common/base/stats.h", {"RunningStats"}},
    {"02",
     "common/path/points.h",
     {"Points", "random_pair", "below_1", "estimate", "quarter_circle", "product"}},
    {"02", "common/path/sampler.h", {"jitter_in_stratum"}},
    {"03", "common/path/sampler.h", {"sobol_second", "scramble_reversed", "owen_scramble"}},
    {"05", "common/scene/camera.h", {"CameraView", "camera_view", "camera_ray"}},
    {"05", "common/material/optics.h", {"reflect", "refract", "fresnel_dielectric"}},
    {"07",
     "common/material/bsdf.h",
     {"BsdfSample", "sample_uniform_hemisphere", "pdf_uniform_hemisphere",
      "invert_uniform_hemisphere", "sample_mirror", "sample_dielectric"}},
    {"08", "common/path/roulette.h", {"survival_probability"}},
    {"10",
     "common/material/cosine.h",
     {"sample_cosine_hemisphere", "pdf_cosine_hemisphere", "invert_cosine_hemisphere"}},
    {"10", "common/material/basic_bsdf.h", {"eval_bsdf", "pdf_bsdf", "sample_bsdf"}},
    {"10", "common/light/lights.h", {"LightSample", "sample_area_light", "sample_one_light"}},
    {"11",
     "common/light/light_table.h",
     {"light_power", "light_pmf", "AliasColumn", "LightTable", "build_light_table", "pick_light",
      "pmf_light", "sample_light"}},
    {"12",
     "common/light/resampling.h",
     {"LightBounds", "light_bounds", "target", "Reservoir", "Proposal", "resample_lights"}},
    {"13",
     "common/material/ggx.h",
     {"ggx_D", "ggx_lambda", "sample_ggx_normal", "pdf_ggx_normal", "invert_ggx_normal",
      "eval_rough_conductor", "pdf_rough_conductor", "sample_rough_conductor", "eval_bsdf",
      "pdf_bsdf", "sample_bsdf"}},
    {"14",
     "common/path/mis.h",
     {"balance_heuristic", "power_heuristic", "sample_beside_bsdf", "pdf_beside_bsdf"}},
    {"15",
     "common/path/many_lights.h",
     {"Lights", "prepare", "Candidates", "lobe_share", "choose_candidates", "pdf_sampled",
      "light_sample", "direct_light", "mis_emission"}},
    {"16", "common/path/lens.h", {"through_lens", "sample_time"}},
    {"17",
     "common/path/image_light.h",
     {"image_cdf", "LightsAndSky", "prepare", "pdf_image", "sample_image", "image_light",
      "image_emission", "DirectNumbers", "draw_numbers"}},
    {"18", "common/path/dispersion.h", {"Wavelength", "sample_wavelength", "set_index", "trace"}},
    {"20",
     "common/path/light_paths.h",
     {"Pinhole", "pinhole_of", "importance_cos", "CameraImportance", "camera_importance",
      "Endpoints", "endpoints_of", "Emission", "sample_sphere", "sample_emission", "seen_from",
      "adjoint_bsdf", "connect_to_camera", "sample_light_bsdf"}},
    {"21",
     "common/path/subpaths.h",
     {"Vertex", "Path", "is_far", "can_be_hit", "direction", "vertex_at", "random_walk",
      "light_subpath", "place_light", "pdf_onwards", "pdf_emission", "connect"}},
    {"22",
     "common/path/stored_subpaths.h",
     {"Kept", "Subpath", "pdf_forward", "unweighted", "direct_light"}},
    {"23",
     "common/path/photon_map.h",
     {"Photon", "PhotonMap", "LightVertex", "is_diffuse", "PhotonMaps", "build_maps"},
     "photon_map.h"},
    {"23", "common/path/first_radius.h", {"pixel_width", "first_radius"}, "first_radius.h"},
    {"23",
     "common/path/photons.h",
     {"PhotonSettings", "trace_light_path", "trace_light_paths", "choose_radius"}},
    {"24", "common/path/shrinking_radius.h", {"radius_of"}},
};

/// The name that a definition gives which starts with this line.
std::string name_of(const std::string& line) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "enum") words >> word;
    if (word == "struct" || word == "class" || word == "using") {
        words >> word;
        return word;
    }
    size_t end = line.find('('), begin = line.find_last_of(" *&", end) + 1;
    return end == std::string::npos ? line : line.substr(begin, end - begin);
}

/// What a source file defines, by name, each with the comment above it: from a line that begins
/// with a letter to the line that closes it. Overloads are taken together.
std::map<std::string, std::string> definitions_of(const std::string& text) {
    std::map<std::string, std::string> definitions;
    std::string line, above, name, body;
    for (std::istringstream lines(text); std::getline(lines, line);) {
        bool is_name_elsewhere = line.starts_with("using") && line.find('=') == std::string::npos;
        bool opens = name.empty() && !line.empty() && line[0] >= 'a' && line[0] <= 'z' &&
                     !line.starts_with("namespace") && !line.starts_with("template") &&
                     !is_name_elsewhere;
        if (opens) name = name_of(line), body = above;
        if (!name.empty()) body += line + "\n";
        std::string code = line.substr(0, line.find("  //"));
        if (!name.empty() &&
            (line.starts_with("}") || (opens && (code.ends_with(";") || code.ends_with("}"))))) {
            definitions[name] += body;
            name.clear();
        }
        bool goes_on = line.starts_with("//") || line.starts_with("template");
        above = goes_on ? above + line + "\n" : "";
    }
    return definitions;
}

std::string folder_of(const std::string& chapter) {
    for (const auto& entry : std::filesystem::directory_iterator("chapters")) {
        std::string name = entry.path().filename().string();
        if (name.starts_with(chapter + "_")) return "chapters/" + name;
    }
    return "";
}

/// The files that this one reads, and those that they read.
void add_includes(const std::string& path, std::set<std::string>& found) {
    const std::string mark = "#include \"", text = read_file(path);
    for (size_t at = 0; (at = text.find(mark, at)) != std::string::npos;) {
        at += mark.size();
        std::string file = text.substr(at, text.find('"', at) - at);
        if (found.insert(file).second) add_includes(file, found);
    }
}

/// All that the programs of chapters 01 to `last` read.
std::set<std::string> read_by_chapters_up_to(const std::string& last) {
    std::set<std::string> found;
    for (const auto& folder : std::filesystem::directory_iterator("chapters")) {
        if (folder.path().filename().string().substr(0, 2) > last) continue;
        add_includes(folder.path().string() + "/main.cpp", found);
    }
    return found;
}

}  // namespace

TEST_SUITE("promotion") {
    TEST_CASE("identity: what a chapter taught stands unchanged in common/") {
        for (const Promoted& row : promoted) {
            auto taught = definitions_of(read_file(folder_of(row.chapter) + "/" + row.file));
            auto kept = definitions_of(read_file(row.header));
            for (const std::string& name : row.definitions) {
                CAPTURE(row.header);
                CAPTURE(name);
                REQUIRE(taught.count(name) == 1);
                CHECK(kept[name] == taught[name]);
            }
        }
    }

    TEST_CASE("identity: a header says who taught it, and then holds nothing else") {
        std::set<std::string> headers, rows;
        for (const Promoted& row : promoted) rows.insert(row.header);
        for (const auto& file : std::filesystem::recursive_directory_iterator("common")) {
            if (file.path().extension() != ".h") continue;
            std::string header = file_name(file.path()), text = read_file(header);
            std::string first_line = text.substr(0, text.find('\n'));
            if (first_line.find("taught by chapter") == std::string::npos) continue;
            CAPTURE(header);
            headers.insert(header);
            auto row = std::find_if(promoted.begin(), promoted.end(),
                                    [&](const Promoted& p) { return p.header == header; });
            REQUIRE(row != promoted.end());
            if (first_line.starts_with("// in part taught by chapters 02 (strata) and 03 ("))
                continue;
            CHECK(first_line == "// taught by chapter " + row->chapter);
            std::set<std::string> held, named(row->definitions.begin(), row->definitions.end());
            for (const auto& [name, body] : definitions_of(text)) held.insert(name);
            CHECK(held == named);
        }
        CHECK(headers == rows);
    }

    TEST_CASE("identity: no chapter reads what it or a later one teaches") {
        for (const Promoted& row : promoted) {
            if (row.header == "common/path/sampler.h") continue;  // in part; 01 draws from it
            CAPTURE(row.header);
            CHECK(read_by_chapters_up_to(row.chapter).count(row.header) == 0);
        }
        CHECK(read_by_chapters_up_to("13").count("common/light/resampling.h") == 0);
        CHECK(read_by_chapters_up_to("11").count("common/light/lights.h") == 1);
    }

    TEST_CASE("teeth: a changed letter, a changed comment and a function that hides are seen") {
        const std::string text =
            "// A file.\n#pragma once\n\nnamespace ch {\n\n/// One.\ninline int one() {\n"
            "    return 1;\n}\ninline int two() { return 2; }\nusing Three = int;  // three\n"
            "/// Four.\ntemplate <class T>\nstruct Four {\n    T t;\n};\n\n}  // namespace ch\n";
        auto definitions = definitions_of(text);
        CHECK(definitions.size() == 4);
        CHECK(definitions["one"] == "/// One.\ninline int one() {\n    return 1;\n}\n");
        CHECK(definitions["two"] == "inline int two() { return 2; }\n");
        CHECK(definitions["Three"] == "using Three = int;  // three\n");
        CHECK(definitions["Four"].starts_with("/// Four.\ntemplate <class T>\nstruct Four {"));
        for (auto [was, is] : {std::pair{"return 1", "return 3"}, {"/// One.", "/// Uno."}}) {
            std::string changed = text;
            changed.replace(text.find(was), 8, is);
            CHECK(definitions_of(changed)["one"] != definitions["one"]);
        }
        CHECK(definitions_of(text + "inline int hidden() { return 5; }\n").count("hidden") == 1);
    }
}
