// The options that single chapters have: the default is what --help says, and every other value
// makes another picture.
#include <doctest/doctest.h>

#include "common/base/files.h"
#include "tests/support/folder.h"
#include "tests/support/run_program.h"

namespace {

struct OwnOption {
    std::string program, scene, name, by_default;
    Words others;
    Words more = {};  // other options, for a short run
};

const std::string many = "scenes/thousand-lights.pbrt", metal = "scenes/veach-mis.pbrt";
const Words few_photons = {"--photons", "500"}, few_patches = {"--patches", "100"};

std::vector<OwnOption> own_options() {
    std::vector<OwnOption> all = {
        {"12_ris", many, "m", "16", {"15", "17", "1"}},
        {"13_glossy", metal, "strategy", "light", {"bsdf"}},
        {"14_mis", metal, "heuristic", "power", {"balance"}},
        {"16_lens_and_shutter", "scenes/bokeh.pbrt", "pixel", "area", {"centre"}},
        {"17_sky_image", "scenes/sky.pbrt", "compensation", "on", {"off"}},
        {"19_adaptive", "scenes/high-contrast.pbrt", "pilot", "16", {"15", "17"}},
        {"19_adaptive", "scenes/high-contrast.pbrt", "judge", "other", {"own"}},
        {"22_fast_bidirectional", "scenes/light-in-glass.pbrt", "chances", "16", {"15", "0"}},
        {"22_fast_bidirectional", spheres, "direct-by", "15", {"21"}},
        {"25_vertex_merging", "scenes/sds.pbrt", "radius", "0", {"0.2"}, few_photons}};
    for (const char* program :
         {"15_mis_ris", "16_lens_and_shutter", "17_sky_image", "18_dispersion"})
        all.push_back({program, many, "m", "64", {"63", "2"}});
    for (const char* program : {"23_photon_mapping", "24_progressive_photons"}) {
        all.push_back({program, "scenes/sds.pbrt", "photons", "100000", {"99999"}});
        all.push_back({program, "scenes/sds.pbrt", "gather", "final", {"direct"}, few_photons});
        all.push_back({program, "scenes/sds.pbrt", "radius", "0", {"0.2"}, few_photons});
    }
    const std::string room = "scenes/cornell.pbrt";
    for (const auto& [name, by_default, others] :
         {std::tuple("solver", "southwell", Words{"gauss-seidel", "jacobi"}),
          std::tuple("show", "smooth", Words{"constant"})})
        all.push_back({"26_radiosity", room, name, by_default, others, few_patches});
    return all;
}

}  // namespace

TEST_SUITE("chapter options") {
    TEST_CASE("truth: options of chapters have the default that help says, and change the picture" *
              doctest::skip()) {
        TemporaryFolder folder;
        for (const OwnOption& option : own_options()) {
            CAPTURE(option.name);
            auto picture = [&](const Words& words) {
                Words all = {option.scene, "--size", "16x12", "--threads", "2", "--quiet"};
                bool radiosity = option.program == "26_radiosity";
                if (!radiosity)
                    append(all, {"--spp", option.program == "19_adaptive" ? "32" : "3"});
                append(all, {"--out", folder / "a.pfm"});
                append(all, option.more);
                append(all, words);
                Finished end = run(option.program, all);
                CHECK(end.code == 0);
                return read_file(folder / "a.pfm");
            };
            std::string usual = picture({});
            CHECK(usual == picture({"--" + option.name, option.by_default}));
            for (const std::string& other : option.others) {
                CAPTURE(other);
                CHECK(usual != picture({"--" + option.name, other}));
            }
            std::string help = run(option.program, {"--help"}).out;
            size_t at = help.find("\n  --" + option.name + " ");
            REQUIRE(at != std::string::npos);
            std::string line = help.substr(at + 1, help.find("\n  --", at + 1) - at - 1);
            CHECK(line.find("default") != std::string::npos);
            if (std::isdigit(option.by_default[0]))
                CHECK(line.find(option.by_default) != std::string::npos);
        }
    }
}
