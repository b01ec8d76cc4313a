#include <doctest/doctest.h>

#include <algorithm>

#include "common/path/sampler.h"
#include "tests/diagnose/judge.h"
#include "tests/support/folder.h"

namespace {

/// Pictures of all scenes as they should be, but where a mistake says otherwise, with normal noise.
Folder pictures_of(const Hypothesis& mistake, double noise) {
    Folder folder;
    Sampler sampler(SamplerType::independent, 1, 1);
    sampler.start(0, 0);
    for (const SmallScene& scene : small_scenes())
        for (size_t i = 0; i < scene.should.size(); i++) {
            auto found = mistake.predicted.find(key_of(scene, i));
            double mean = scene.should[i].mean, normal = -6;
            if (found != mistake.predicted.end()) mean = found->second.mean * scale_of(scene, i);
            for (int k = 0; k < 12; k++) normal += double{sampler.u1()};
            folder.scenes[scene.name].push_back({mean * (1 + noise * normal), noise * mean});
        }
    return folder;
}

/// A small picture, grey but for noise of this seed.
Image grey(uint32_t seed, int width = 16) {
    Image image(width, 16);
    Sampler sampler(SamplerType::independent, seed, 1);
    sampler.start(0, 0);
    for (Rgb& pixel : image.pixels) {
        float x = 0.03f * (0.9f + 0.2f * sampler.u1());
        pixel = {x, x, x};
    }
    return image;
}

}  // namespace

TEST_SUITE("diagnose") {
    TEST_CASE("truth: the mistake in another renderer's pictures is named" * doctest::skip()) {
        std::vector<Hypothesis> effects = read_effects();
        for (double noise : {0.003, 0.01, 0.05})
            CHECK(judge(pictures_of({}, noise), effects).off == 0);
        int named = 0, tried = 0;
        for (size_t i = 0; i < effects.size(); i += 11) {
            CAPTURE(effects[i].text);
            Diagnosis d = judge(pictures_of(effects[i], 0.004), effects);
            CAPTURE(d.text);
            tried++, named += d.name == effects[i].text;
            CHECK((d.name.empty() || d.name.find(effects[i].text) != std::string::npos));
        }
        CHECK(named > tried / 2);
    }

    TEST_CASE("input: pictures that cannot be judged, and why") {
        TemporaryFolder folder;
        auto note = [&] {
            std::vector<std::string> notes = read_folder(folder.path()).notes;
            return notes.empty() ? "" : notes[0].substr(notes[0].find("floor"));
        };
        CHECK(read_folder(folder.path()).missing.size() == small_scenes().size());
        write_image(folder / "floor.pfm", grey(1), "");
        CHECK(note() == "floor: error: how noisy is it? There is no floor.2.pfm (another seed)");
        write_image(folder / "floor.2.pfm", grey(2, 20), "");
        CHECK(note().starts_with("floor.2.pfm: error: "));
        write_image(folder / "floor.2.pfm", grey(2), "");
        CHECK(note() == "");
        // The error of a tile is that of the mean of two renders of 16 pixels.
        double expected = 0.03 * 0.2 / std::sqrt(12.0) / std::sqrt(32.0);
        Tiles tiles = read_folder(folder.path()).scenes.at("floor");
        for (Quantity q : tiles) {
            CHECK(std::abs(q.mean - 0.03) < 5 * expected);
            CHECK((q.se > 0.5 * expected && q.se < 2 * expected));
        }
        for (const SmallScene& scene : small_scenes())
            for (const char* ending : {".pfm", ".2.pfm"})
                write_image(folder / (scene.name + ending), grey(1, scene.width), "");
        Folder same = read_folder(folder.path());
        CHECK(same.scenes.empty());
        CHECK(same.notes.at(0).ends_with("are the same: they need different seeds"));
    }
}
