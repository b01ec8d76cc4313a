// The tools that compare pictures and measurements with each other.
#include <doctest/doctest.h>

#include <cmath>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/picture/comparison.h"
#include "common/picture/film.h"
#include "tests/measure/numbers.h"
#include "tests/support/folder.h"
#include "tests/support/gates.h"

namespace {

Image plain(int width, int height, float level) {
    Image image(width, height);
    for (Rgb& p : image.pixels) p = {level, level, level};
    return image;
}

/// Noise of standard deviation `sigma` in every pixel.
Image noisy(Image image, float sigma, uint32_t seed) {
    Sampler sampler(SamplerType::independent, seed, 1);
    for (uint32_t i = 0; i < image.pixels.size(); i++) {
        sampler.start(i, 0);
        float x = sigma * std::sqrt(12.0f) * (sampler.u1() - 0.5f);
        image.pixels[i] += Rgb{x, x, x};
    }
    return image;
}

}  // namespace

TEST_SUITE("comparison") {
    TEST_CASE("truth: verdicts, by what counts first") {
        Comparison c;
        c.rows = {{"brightness", 1.01, 1}}, c.mse = 0.1, c.blocks = 64;
        Picture a, b;
        auto says = [&](double standard_error, const char* words) {
            c.rows[0].standard_error = standard_error;
            std::string line = verdict(c, a, b);
            CAPTURE(line);
            CHECK(line.starts_with(words));
        };
        says(0.0021, "the same mean within the noise (4.76 standard errors)");
        says(0.0019, "other means: A is 1 % brighter than B (5.26 standard errors)");
        says(NAN, "how sure the means are is not known");
        c.rows[0].beyond_5 = 3;
        says(0.01, "the same mean within the noise, but not everywhere: 3 of 64 blocks");
        c.blocks = 600;
        says(0.01, "the same mean within the noise (");
        c.rows[0].beyond_5 = 2, c.blocks = 64;
        says(0.01, "the same mean within the noise (");
        // The difference of two scenes is no noise, also where only one has stand-ins.
        for (auto [x, y] : {std::pair("1", "2"), {"1", ""}}) {
            const char* name = *y == 0 ? "stand-ins" : "checksum";
            a.notes = {{name, x}}, b.notes = {{name, y}};
            says(0.001, "the pictures show different scenes");
        }
        b.notes = a.notes, c.rows[0].mean_b = c.rows[0].mean_a * (1 + 1e-7);  // rounding
        says(1e-9, "the same mean within the noise (0 ");
        c.mse = 0;
        says(0.01, "the same picture");
    }

    TEST_CASE("truth: the verdict names the channels that differ") {
        Image b = noisy(plain(64, 64, 1), 0.1f, 1), a = b, exchanged = b, brighter = b;
        for (Rgb& p : b.pixels) p = {0.5f * p.r, p.g, 0.2f * p.b};
        for (size_t i = 0; i < b.pixels.size(); i++) {
            Rgb p = b.pixels[i];
            exchanged.pixels[i] = {p.b, p.g, p.r};
            brighter.pixels[i] = 1.02f * p;
            float by = i % 16 < 8 ? 0.1f : -0.1f;  // errors that cancel in each channel's mean
            a.pixels[i] = p + by * Rgb{1, -1, 0};
        }
        auto verdict_of = [&](const Image& other) { return verdict(compare(other, b), {}, {}); };
        CHECK(verdict_of(exchanged).find("60 % darker in red, 150 % brighter in blue than B") !=
              std::string::npos);
        CHECK(verdict_of(brighter).find("A is 2 % brighter than B (") != std::string::npos);
        CHECK(verdict_of(a).find("64 of 64 blocks differ by more than") != std::string::npos);
    }

    TEST_CASE("identity: notes are read from a .ppm and a .png as they were written") {
        TemporaryFolder folder;
        const Notes notes = {{"scene", "a name # with \"blanks\".pbrt"}, {"paths", "LD(S|D)*E"}};
        // Letters that a format cannot keep are '?'; a name cannot make a note of its own. A
        // comment of another program is none of ours.
        const std::pair<std::string, Notes> comments[] = {
            {comment_of(notes), notes},
            {comment_of({{"scene", "a\nspp 9\x1b[2J \xc3\xa4.pbrt"}}),
             {{"scene", "a?spp 9?[2J ??.pbrt"}}},
            {"spp 4\nscene a.pbrt", {}}};
        for (const auto& [comment, read] : comments)
            for (const std::string& file : {folder / "a.ppm", folder / "a.png"}) {
                write_image(file, plain(4, 3, 0.5f), comment);
                CHECK(notes_in(decode_comment(file, read_file(file))) == read);
                CHECK(read_image(file).width == 4);
            }
        write_image(folder / "c.pfm", plain(4, 3, 0.5f), comment_of(notes));
        CHECK(decode_comment("c.pfm", read_file(folder / "c.pfm")).empty());
    }

    TEST_CASE("identity: a film tells compare what its picture shows, and its error") {
        TemporaryFolder folder;
        FilmLabel label;
        label.options = {{"checksum", "1"}, {"code", "2"}, {"paths", ""}};
        label.samples = {{7, 0, 2}};
        Film film(3, 1);
        for (size_t i = 0; i < 6; i++) film.add(i / 2, grey(static_cast<double>(i * i)));
        write_film(folder / "a.film", label, film);
        Picture picture = read_picture(folder / "a.film");
        CHECK(picture.image.pixels == film.image().pixels);
        CHECK(picture.standard_error == film.standard_error());
        CHECK(picture.notes == Notes{{"checksum", "1"}, {"spp", "2"}, {"seed", "7"}});
    }

    TEST_CASE("truth: relMSE from the spread of renders") {
        // Two pixels: one of mean 2 and variance 1/2, one of mean 0.
        Image a(2, 1), b(2, 1);
        a.pixels = {{1.5f, 1.5f, 1.5f}, {0, 0, 0}};
        b.pixels = {{2.5f, 2.5f, 2.5f}, {0, 0, 0}};
        Spread spread;
        spread.add(a);
        spread.add(b);
        CHECK(spread.mean().pixels[0] == Rgb{2, 2, 2});
        CHECK(spread.rel_mse(spread.mean()) == nearly(0.5 / 4.01 / 2, 1e-12));
        // One bright and rare pixel: a better mean makes it count for what it is.
        CHECK(spread.rel_mse(plain(2, 1, 0)) == nearly(25));
    }

    TEST_CASE("truth: z of three estimates") {
        // The others: (1/4 * 10 + 1 * 12) / (5/4), with variance 4/5.
        std::vector<Estimate> e = {{13, 1, 0}, {10, 2, 0}, {12, 1, 0}, {99, 0.1, 5}};
        Verdict v = judge(e, 0);
        CHECK(v.known);
        CHECK(v.others_mean == nearly(11.6, 1e-12));
        CHECK(v.z == nearly(1.4 / std::sqrt(1.8), 1e-12));
        CHECK(!judge(e, 3).known);                          // too few lucky samples
        CHECK(!judge({{1, 1, 0}, {1, 1, 3}}, 0).known);     // nothing to compare it with
        CHECK(!judge({{1, 1, 0}, {1, 1, 0, 2}}, 0).known);  // they missed more than their error
    }

    TEST_CASE("truth: times faster at equal error") {
        ErrorLine slow{{1, 4, 16}, {8, 2, 0.5}};  // error * seconds: 8
        ErrorLine fast{{2, 8}, {0.05, 0.0125}};   // 0.1
        ErrorLine steep{{1, 4, 16}, {4, 0.25, 0.015625}}, wavy{{1, 2, 3, 4}, {4, 1, 3, 1}};
        const std::pair<double, double> cases[] = {
            {seconds_at(slow, 4), 2},     // between two points
            {seconds_at(slow, 80), 0.1},  // before the first, after the last
            {seconds_at(slow, 0.05), 160},
            {times_faster(fast, slow), 80},
            {times_faster(slow, fast), 1 / 80.0},
            // One that falls faster counts where it ends; the other goes on as before.
            {times_faster(steep, slow), 32},
            // What rises again is there for good when it falls for the last time.
            {seconds_at(wavy, 2), 3 * std::pow(4 / 3.0, 0.369070246428)},
        };
        for (auto [found, truth] : cases) CHECK(found == nearly(truth, 1e-9));
        CHECK(std::isnan(times_faster(fast, {})));
    }
}
