#include <doctest/doctest.h>

#include <algorithm>

#include "common/base/files.h"
#include "common/path/sampler.h"
#include "tests/diagnose/judge.h"
#include "tests/support/folder.h"

namespace {

/// Pictures of all scenes as they should be, but where a mistake says otherwise, with normal noise.
Folder pictures_of(const References& references, const Hypothesis& mistake, double noise) {
    Folder folder;
    Sampler sampler(SamplerType::independent, 1, 1);
    sampler.start(0, 0);
    for (const SmallScene& scene : small_scenes()) {
        SmallPicture& m = folder.scenes[scene.name];
        const Tiles& should = references.at(scene.name);
        for (size_t i = 0; i < should.size(); i++) {
            auto found = mistake.predicted.find(key_of(scene.name, should, i));
            double mean = should[i].mean, normal = -6;
            if (found != mistake.predicted.end()) mean = found->second.mean * scale_of(should, i);
            for (int k = 0; k < 12; k++) normal += double{sampler.u1()};
            m.tiles.push_back({mean * (1 + noise * normal), noise * mean});
        }
    }
    return folder;
}

/// A small picture, grey but for noise of this seed.
Image grey(uint32_t seed, int width = 16, float value = 0.03f) {
    Image image(width, 16);
    Sampler sampler(SamplerType::independent, seed, 1);
    sampler.start(0, 0);
    for (Rgb& pixel : image.pixels) {
        float x = value * (0.9f + 0.2f * sampler.u1());
        pixel = {x, x, x};
    }
    return image;
}

}  // namespace

TEST_SUITE("diagnose") {
    TEST_CASE("truth: the mistake in another renderer's pictures is named" * doctest::skip()) {
        References references = read_references();
        std::vector<Hypothesis> effects = read_effects(references);
        for (double noise : {0.003, 0.01, 0.05})
            CHECK(judge(pictures_of(references, {}, noise), references, effects).off == 0);
        int named = 0, tried = 0;
        for (size_t i = 0; i < effects.size(); i += 11) {
            CAPTURE(effects[i].text);
            Diagnosis d = judge(pictures_of(references, effects[i], 0.004), references, effects);
            CAPTURE(d.text);
            tried++, named += d.name == effects[i].text;
            CHECK((d.name.empty() || d.name.find(effects[i].text) != std::string::npos));
        }
        CHECK(named > tried / 2);
    }

    TEST_CASE("input: pictures that cannot be judged, and why") {
        TemporaryFolder folder;
        auto notes = [&] {
            std::string text;
            for (const std::string& note : read_folder(folder.path()).notes) text += note + "\n";
            return text.substr(std::min(text.find("floor"), text.size()));
        };
        CHECK(read_folder(folder.path()).missing.size() == small_scenes().size());
        write_file_atomically(folder / "floor.exr", "");
        CHECK(
            notes() ==
            "floor.exr: error: this format is not read; the page shows how to make a .pfm of it\n");
        write_image(folder / "floor.pfm", grey(1), "");
        CHECK(notes() ==
              "floor: error: how noisy is it? There is neither floor.2.pfm (another seed) nor "
              "floor.err.pfm\n");
        write_image(folder / "floor.2.pfm", grey(2, 20), "");
        CHECK(notes() == "floor.2.pfm: error: 20 x 16 pixels, not 16 x 16\n");
        Image bad = grey(2);
        bad.at(3, 4).g = NAN;
        write_image(folder / "floor.2.pfm", bad, "");
        CHECK(notes() ==
              "floor.2.pfm: error: a pixel is not finite, column 4 of row 5 from the top\n");
        write_image(folder / "floor.2.pfm", grey(2), "");
        CHECK(notes().empty());
        // The error of a tile is that of the mean of two renders of 16 pixels.
        SmallPicture m = read_folder(folder.path()).scenes.at("floor");
        double expected = 0.03 * 0.2 / std::sqrt(12.0) / std::sqrt(32.0);
        for (Quantity q : m.tiles) CHECK(std::abs(q.mean - 0.03) < 5 * expected);
        for (Quantity q : m.tiles) CHECK((q.se > 0.5 * expected && q.se < 2 * expected));
        for (const SmallScene& scene : small_scenes()) {
            write_image(folder / (scene.name + ".pfm"), grey(1, scene.name == "wide" ? 32 : 16),
                        "");
            write_image(folder / (scene.name + ".2.pfm"), grey(1, scene.name == "wide" ? 32 : 16),
                        "");
        }
        Folder same = read_folder(folder.path());
        CHECK(same.scenes.empty());
        CHECK(same.notes.at(0).ends_with("are the same: they need different seeds"));
    }
}
