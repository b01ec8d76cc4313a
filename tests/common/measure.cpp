// The tools that hold pictures and measurements against each other.
#include <doctest/doctest.h>

#include <cmath>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/picture/comparison.h"
#include "common/picture/stats_file.h"
#include "common/picture/verdict.h"
#include "tests/measure/agreement.h"
#include "tests/measure/finding.h"
#include "tests/measure/spread.h"
#include "tests/support/folder.h"

namespace {

Image grey(int width, int height, float level) {
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
    TEST_CASE("truth: the numbers of a comparison, worked out by hand") {
        // b: 1 0 / 2 4; a differs by +0.1 in one channel, by -1 in all, by +3 in all.
        Image b(2, 2), a(2, 2);
        b.pixels = {{1, 1, 1}, {0, 0, 0}, {2, 2, 2}, {4, 4, 4}};
        a.pixels = {{1.5f, 1, 1}, {0, 0, 0}, {1, 1, 1}, {7, 7, 7}};
        Comparison c = compare(a, b);
        auto near = [](double x) { return doctest::Approx(x).epsilon(1e-6).scale(0); };
        CHECK(c.mean_b == near(7.0 / 4));
        CHECK(c.mean_a == near((3.5 / 3 + 0 + 1 + 7) / 4));
        CHECK(c.mse == near((0.25 / 3 + 1 + 9) / 4));
        CHECK(c.rmse == near(std::sqrt((0.25 / 3 + 1 + 9) / 4)));
        CHECK(c.rel_mse == near((0.25 / 1.01 / 3 + 1 / 4.01 + 9 / 16.01) / 4));
        CHECK(c.worst_share == near(9 / (0.25 / 3 + 1 + 9)));
        CHECK(c.median_ratio == near(3.5 / 3));  // of 0.5, 1.1667, 1.75
        CHECK(c.blocks == 0);
        CHECK(std::isnan(c.standard_error));

        // Without the worst pixel of four, which is the last.
        Comparison trimmed = compare(a, b, 25);
        CHECK(trimmed.mse == near((0.25 / 3 + 1) / 3));
        CHECK(trimmed.rel_mse == near((0.25 / 1.01 / 3 + 1 / 4.01) / 3));
        CHECK(trimmed.mean_a == c.mean_a);
    }

    TEST_CASE("truth: verdicts") {
        Comparison c;
        c.mean_a = 1.01, c.mean_b = 1, c.mse = 0.1, c.blocks = 64;
        PictureFacts a, b;
        CHECK(verdict(c, 0.01, a, b) == "the same mean within the noise");
        CHECK(verdict(c, 0.001, a, b) ==
              "other means: A is 1 % brighter than B, and noise does not do that (10 standard "
              "errors)");
        CHECK(verdict(c, NAN, a, b) == "how sure the means are is not known");
        c.beyond_5 = 3;
        CHECK(verdict(c, 0.01, a, b) ==
              "the same mean within the noise, but not everywhere: 3 of 64 blocks differ by more "
              "than noise does");
        c.beyond_5 = 0;
        a = {std::sqrt(33.0) * 0.001, 16, "", ""}, b = {0.001, 16, "", ""};
        CHECK(verdict(c, 0.01, a, b) ==
              "the same mean within the noise; B has 97 % less squared error: at equal samples "
              "that is 33 times fewer");
        CHECK(verdict(c, 0.01, b, a).find("; A has 97 % less") != std::string::npos);
        b.spp = 64;  // a quarter of that is due to samples
        CHECK(verdict(c, 0.01, a, b)
                  .find("with 64 samples against 16: sample by sample 8.2 times "
                        "fewer") != std::string::npos);
        b.spp = 1024;
        CHECK(verdict(c, 0.01, a, b).find("sample by sample 1.9 times more") != std::string::npos);
        c.mse = 0;
        CHECK(verdict(c, 0.01, a, b) == "the same picture");
    }

    TEST_CASE("truth: pictures of other scenes, and of 8 bits, are told") {
        TemporaryFolder folder;
        std::string png = folder / "a.png", pfm = folder / "b.pfm";
        write_image(png, grey(4, 4, 2), "build/08_light_sampling scenes/near-light.pbrt --spp 1");
        write_image(pfm, grey(4, 4, 2), "");
        CHECK(read_comment(png) == "build/08_light_sampling scenes/near-light.pbrt --spp 1");
        CHECK(read_comment(pfm) == "");
        PictureFacts a = facts_of(png), b = facts_of(pfm);
        CHECK(a.scene == "scenes/near-light.pbrt");
        CHECK(b.scene == "");
        std::vector<std::string> told = doubts(png, a, pfm, b);
        REQUIRE(told.size() == 1);
        CHECK(told[0].find("has 8 bits") != std::string::npos);
        b.scene = "elsewhere/near-light.pbrt";  // the same file from another folder
        CHECK(doubts(pfm, a, pfm, b).empty());
        b.scene = "scenes/cornell.pbrt";
        REQUIRE(doubts(pfm, a, pfm, b).size() == 1);
        CHECK(doubts(pfm, a, pfm, b)[0] == "A shows scenes/near-light.pbrt, B scenes/cornell.pbrt");
        std::string bytes = read_file(png);
        for (size_t length : {20u, 40u, 60u}) {  // cut short: no comment, no crash
            write_file_atomically(png, bytes.substr(0, length));
            CHECK(read_comment(png).size() < 60);
        }
    }

    TEST_CASE("identity: a picture does not differ from itself") {
        Image a = noisy(grey(20, 20, 1), 0.1f, 1);
        Comparison c = compare(a, a);
        CHECK(c.rel_mse == 0);
        CHECK(c.worst_share == 0);
        CHECK(c.median_ratio == 1);
        CHECK(c.worst_z == 0);
        CHECK(c.blocks == 9);
    }

    TEST_CASE("truth: noise alone is within its standard error, in every block") {
        Comparison c =
            compare(noisy(grey(128, 128, 1), 0.2f, 1), noisy(grey(128, 128, 1), 0.1f, 2));
        CHECK(c.standard_error ==
              doctest::Approx(std::hypot(0.2, 0.1) / 128).epsilon(0.05).scale(0));
        CHECK(std::abs(c.mean_a - c.mean_b) < 5 * c.standard_error);
        CHECK(c.blocks == 256);
        CHECK(c.worst_z < 5);
        CHECK(c.worst_z > 1.5);  // of 256
        CHECK(c.beyond_5 == 0);
    }

    TEST_CASE("teeth: one block that is brighter by one standard deviation is named") {
        Image a = noisy(grey(64, 64, 1), 0.1f, 1);
        for (int y = 16; y < 24; y++)
            for (int x = 40; x < 48; x++) a.at(x, y) += Rgb{0.1f, 0.1f, 0.1f};
        Comparison c = compare(a, grey(64, 64, 1));
        CHECK(c.worst_z > 5);
        CHECK(c.worst_x == 40);
        CHECK(c.worst_y == 16);
        CHECK(c.beyond_5 == 1);
    }

    TEST_CASE("input: pictures that cannot be compared") {
        Image bad = grey(4, 4, 1);
        bad.at(1, 2).g = NAN;
        CHECK_THROWS_WITH_AS(check_comparable(grey(4, 4, 1), "a", grey(4, 5, 1), "b"),
                             "b: error: has 4x5 pixels, but a has 4x4", InputError);
        CHECK_THROWS_WITH_AS(check_comparable(grey(4, 4, 1), "a", bad, "b"),
                             "b: error: pixel 1,2 is not finite", InputError);
    }

    TEST_CASE("identity: the error picture is black where equal, white from the range on") {
        Image b = grey(10, 10, 0), a = b;
        a.at(0, 0) = {0.01f, 0.01f, 0.01f};  // relative to sqrt(0.01): 0.1
        a.at(1, 0) = {5, 5, 5};
        Image e = error_image(a, b, 0.1);
        CHECK(e.at(2, 0) == Rgb{0, 0, 0});
        CHECK(e.at(0, 0).b == doctest::Approx(1).epsilon(1e-3).scale(0));
        CHECK(e.at(1, 0) == Rgb{1, 1, 1});
        CHECK(error_range(a, b) == doctest::Approx(0.1).epsilon(1e-5).scale(0));  // of 100, 1 above
        for (double x = 0; x < 1; x += 0.01) {                                    // ever brighter
            CHECK(average(false_colour(x + 0.01)) > average(false_colour(x)));
        }
    }
}

TEST_SUITE("measuring") {
    TEST_CASE("input: statistics read back") {
        StatsFile stats(
            "{\n \"mean\": 1.5e-3, \"scene\": \"a \\\"b\\\": c\",\"none\": null,"
            "\"list\": [1, 2.5,3]}");
        CHECK(stats.number("mean") == 1.5e-3);
        CHECK(stats.text("scene") == "a \\\"b\\\": c");
        CHECK(!stats.number("none"));
        CHECK(!stats.number("b"));
        CHECK(stats.numbers("list") == std::vector<double>{1, 2.5, 3});
    }
}

TEST_SUITE("measuring") {
    TEST_CASE("truth: relMSE from the spread of renders") {
        // Two pixels: one of mean 2 and variance 1/2, one of mean 0.
        Image a(2, 1), b(2, 1);
        a.pixels = {{1.5f, 1.5f, 1.5f}, {0, 0, 0}};
        b.pixels = {{2.5f, 2.5f, 2.5f}, {0, 0, 0}};
        Spread spread;
        spread.add(a);
        spread.add(b);
        CHECK(spread.mean().pixels[0] == Rgb{2, 2, 2});
        CHECK(spread.rel_mse(spread.mean()) ==
              doctest::Approx(0.5 / 4.01 / 2).epsilon(1e-12).scale(0));
        // One bright and rare pixel: a better mean makes it count for what it is.
        CHECK(spread.rel_mse(grey(2, 1, 0)) == doctest::Approx(25).epsilon(1e-6).scale(0));
    }

    TEST_CASE("truth: relMSE of noise falls like 1 / spp") {
        for (float sigma : {0.2f, 0.1f}) {
            Spread spread;
            for (uint32_t run = 0; run < 16; run++) spread.add(noisy(grey(64, 64, 1), sigma, run));
            double expected = static_cast<double>(sigma * sigma) / 1.01;
            CHECK(spread.rel_mse(grey(64, 64, 1)) ==
                  doctest::Approx(expected).epsilon(0.03).scale(0));
        }
    }

    TEST_CASE("identity: the median of odd and even many numbers") {
        CHECK(median({3, 1, 2}) == 2);
        CHECK(median({4, 1, 3, 2}) == 2.5);
        CHECK(std::isnan(median({})));
    }

    TEST_CASE("truth: mean, standard error and skewness of batches") {
        Estimate e = estimate_of({1, 2, 3, 6});
        CHECK(e.mean == 3);
        CHECK(e.se == doctest::Approx(std::sqrt(14.0 / 3 / 4)).epsilon(1e-9).scale(0));
        CHECK(e.skewness == doctest::Approx(4.5 / std::pow(3.5, 1.5)).epsilon(1e-12).scale(0));
        CHECK(e.reliable());
        // One lucky batch of many.
        std::vector<double> rare(64, 0.0);
        rare[17] = 1;
        CHECK(!estimate_of(rare).reliable());
        CHECK(!estimate_of(std::vector<double>(64, 0.0)).reliable());
        // No noise at all is exact up to rounding.
        Estimate exact = estimate_of(std::vector<double>(64, 0.8));
        CHECK(exact.reliable());
        CHECK(exact.se == doctest::Approx(0.8e-6).epsilon(1e-9).scale(0));
    }

    TEST_CASE("truth: z of three estimates") {
        // The others: (1/4 * 10 + 1 * 12) / (5/4), with variance 4/5.
        std::vector<Estimate> e = {{13, 1, 0}, {10, 2, 0}, {12, 1, 0}, {99, 0.1, 5}};
        Verdict v = judge(e, 0);
        CHECK(v.known);
        CHECK(v.others_mean == doctest::Approx(11.6).epsilon(1e-12).scale(0));
        CHECK(v.z == doctest::Approx(1.4 / std::sqrt(1.8)).epsilon(1e-12).scale(0));
        CHECK(!judge(e, 3).known);                       // too few lucky samples
        CHECK(!judge({{1, 1, 0}, {1, 1, 3}}, 0).known);  // nothing to hold it against
    }

    TEST_CASE("teeth: a bias of ten standard errors is seen, and in the right method") {
        std::vector<Estimate> e;
        for (uint32_t method = 0; method < 6; method++) {
            std::vector<double> values;
            Sampler sampler(SamplerType::independent, method, 1);
            for (uint32_t batch = 0; batch < 64; batch++) {
                sampler.start(0, batch);
                values.push_back(static_cast<double>(sampler.u1()) + (method == 3 ? 0.36 : 0));
            }
            e.push_back(estimate_of(values));  // of standard error 0.036
        }
        for (size_t i = 0; i < e.size(); i++) {
            CHECK(judge(e, i).known);
            CHECK((std::abs(judge(e, i).z) > 5) == (i == 3));
        }
    }
}

TEST_SUITE("charts") {
    TEST_CASE("truth: times faster at equal error") {
        auto is = [](double x) { return doctest::Approx(x).epsilon(1e-9).scale(0); };
        ErrorLine slow{{1, 4, 16}, {8, 2, 0.5}};  // error * seconds: 8
        ErrorLine fast{{2, 8}, {0.05, 0.0125}};   // 0.1
        CHECK(seconds_at(slow, 4) == is(2));      // between two points
        CHECK(seconds_at(slow, 80) == is(0.1));   // before the first, after the last
        CHECK(seconds_at(slow, 0.05) == is(160));
        CHECK(times_faster(fast, slow) == is(80));
        CHECK(times_faster(slow, fast) == is(1 / 80.0));
        CHECK(times_faster(slow, slow) == is(1));
        // One that falls faster counts at the error that both have reached, not where it ends.
        ErrorLine steep{{1, 4, 16}, {4, 0.25, 0.015625}};
        CHECK(times_faster(steep, slow) == is(16 / std::sqrt(8.0)));
        // What rises again is there for good when it falls for the last time.
        CHECK(seconds_at({{1, 2, 3, 4}, {4, 1, 3, 1}}, 2) ==
              is(3 * std::pow(4 / 3.0, 0.369070246428)));
        CHECK(std::isnan(times_faster(fast, {})));
    }

    TEST_CASE("truth: the simplest of the best, and its ratio with two digits") {
        CHECK(simplest_of_the_best({1, 74, 103, 115, 127}) == 2);
        CHECK(simplest_of_the_best({1, 74, 101, 115, 127}) == 3);
        CHECK(simplest_of_the_best({1, 0.5, 0}) == 0);
        CHECK(two_digits(0.0744) == "0.074");
        CHECK(two_digits(1.333) == "1.3");
        CHECK(two_digits(74.4) == "74");
        CHECK(two_digits(99.7) == "100");
        CHECK(two_digits(127) == "130");
        CHECK(two_digits(18234) == "18000");
        CHECK(two_digits(NAN) == "nan");
    }

    TEST_CASE("truth: labels in their order, apart, and as near as can be to where they belong") {
        using Heights = std::vector<double>;
        CHECK(spread_out({50, 10, 90}, 20, 0, 100) == Heights{50, 10, 90});
        CHECK(spread_out({50, 50}, 20, 0, 100) == Heights{40, 60});
        CHECK(spread_out({50, 48, 52, 90}, 20, 0, 100) == Heights{50, 30, 70, 90});
        CHECK(spread_out({50, 50, 65}, 20, 0, 100) == Heights{35, 55, 75});
        CHECK(spread_out({2, 1, 3}, 20, 0, 100) == Heights{20, 0, 40});
        CHECK(spread_out({99, 98}, 20, 0, 100) == Heights{100, 80});
        CHECK(spread_out({5, 5, 5}, 20, 0, 30) == Heights{0, 20, 40});  // no room: beyond the end
        CHECK(spread_out({}, 20, 0, 100).empty());
    }
}
