// Chapter 12: resampled importance sampling: the four-light example in full, the target, and walls.
#include <doctest/doctest.h>

#include <array>

#include "chapters/11_light_importance/estimator.h"
#include "chapters/12_ris/estimator.h"
#include "tests/support/known_lights.h"

namespace {

/// Four lights: probabilities, targets, and what they really give (the second is in shadow).
using Four = std::array<double, 4>;
constexpr Four p = {0.4, 0.3, 0.2, 0.1}, p_hat = {1, 2, 4, 8}, f = {1, 0, 4, 8};

/// What the chapter's Reservoir makes of all ways to draw M candidates and to decide on each: mean
/// and variance of f W.
struct Resampling {
    size_t M;
    Four pmf = p, target = p_hat;
    bool twice = true;  // whether a light may be a candidate twice
    double mean = 0, square = 0;

    Resampling all() && {
        follow({}, 0, 1, pmf);
        return *this;
    }
    double variance() const { return square - mean * mean; }

    /// From candidate number k on; left: the probabilities of candidates, over their sum.
    void follow(const ch12::Reservoir& kept, size_t k, double probability, const Four& left) {
        if (k == M) {
            double X = f[kept.light] * static_cast<double>(kept.W(static_cast<int>(M)));
            mean += probability * X;
            square += probability * X * X;
            return;
        }
        for (size_t light = 0; light < 4; light++) {
            double drawn = left[light] / (left[0] + left[1] + left[2] + left[3]);
            if (drawn == 0) continue;
            Four others = left;
            if (!twice) others[light] = 0;
            double weight = target[light] / pmf[light];
            double share = weight > 0 ? weight / (double{kept.weight_sum} + weight) : 0;
            auto offered = [&](size_t number, float& u) {
                ch12::Reservoir next = kept;
                next.offer(number, static_cast<float>(target[light]), static_cast<float>(weight),
                           u);
                return next;
            };
            // It may be taken by the lowest u, or by the highest.
            float lowest = 0;
            constexpr size_t other = 4;  // than any that is kept
            bool by_lowest = offered(other, lowest).light == other;
            for (bool taken : {true, false}) {
                double chance = taken ? share : 1 - share;
                if (chance == 0) continue;
                // u decides, and is uniform again afterwards: 0.3 of the way through either part.
                double before = taken == by_lowest ? 0 : 1 - chance;
                float u = static_cast<float>(before + 0.3 * chance);
                ch12::Reservoir next = offered(light, u);
                CHECK(u == nearly(0.3, 1e-5));
                CHECK(next.light == (taken ? light : kept.light));
                follow(next, k + 1, probability * drawn * chance, others);
            }
        }
    }
};

/// The mean of weight(light, its share, sum of target / p) f over all four candidates, of which one
/// is kept by its share of the sum of choice(light).
template <class Choice, class Weight>
double mean_of(const Choice& choice, const Weight& weight) {
    double mean = 0;
    for (size_t code = 0; code < 256; code++) {
        const size_t lights[] = {code & 3, code >> 2 & 3, code >> 4 & 3, code >> 6};
        double probability = 1, chances = 0, sum = 0;
        for (size_t i : lights) {
            probability *= p[i], chances += choice(i), sum += p_hat[i] / p[i];
        }
        for (size_t i : lights) {
            double share = choice(i) / chances;
            mean += probability * share * f[i] * weight(i, share, sum);
        }
    }
    return mean;
}

auto is(double x) { return nearly(x, 1e-5); }

/// Chapters 11 and 12 in this scene; M as in the program without options.
Method trace_11(const Scene& scene) { return method_of<ch11::trace>(ch11::prepare(scene)); }
Method trace_12(const Scene& scene) { return method_of<ch12::trace>(ch12::prepare(scene, 16)); }

}  // namespace

TEST_SUITE("ch12 reservoir") {
    TEST_CASE("truth: RIS on four lights, all tuples") {
        for (auto [M, variance] : {std::pair{size_t{1}, 553.5},
                                   {2, 289.75},
                                   {3, 201.8333333333},
                                   {4, 157.875},
                                   {5, 131.5}}) {
            Resampling result = Resampling{M}.all();
            CHECK(result.mean == is(13));
            CHECK(result.variance() == is(variance));
        }
        Resampling perfect = Resampling{4, p, f}.all();
        CHECK(perfect.mean == is(13));
        CHECK(perfect.variance() == is(138.375));
        Resampling even = Resampling{4, {0.25, 0.25, 0.25, 0.25}}.all();
        CHECK(even.mean == is(13));
        CHECK(even.variance() == is(58.25));
    }

    TEST_CASE(
        "truth: without the weight W, or with a wrong one, the four lights give 3.66, 8, 52") {
        auto by_target = [](size_t i) { return p_hat[i]; };
        auto by_ratio = [](size_t i) { return p_hat[i] / p[i]; };
        // Candidates by p, one kept in proportion to p_hat / p, or to p_hat as the slide has it;
        // truth 13.
        CHECK(mean_of(by_ratio, [](size_t, double, double) { return 1.0; }) == is(3.663573988));
        CHECK(mean_of(by_target, [](size_t, double P, double) { return 1 / P; }) == is(8));
        CHECK(mean_of(by_target, [](size_t i, double P, double) { return 1 / (p[i] * P); }) ==
              is(52));
        CHECK(mean_of(by_ratio, [](size_t i, double, double) { return 15 / p_hat[i]; }) ==
              is(11.2905333));
        auto W = [](size_t i, double, double sum) { return sum / (4 * p_hat[i]); };
        CHECK(mean_of(by_target, W) == is(12.20114435));
        CHECK(mean_of(by_ratio, W) == is(13));
    }

    TEST_CASE("failure: candidates none of which comes twice make 13 into 14.69 and 25.6") {
        for (auto [M, mean] : {std::pair{size_t{1}, 13.0}, {2, 7403.0 / 504}, {4, 205.0 / 8}})
            CHECK(Resampling{M, p, p_hat, false}.all().mean == is(mean));
    }

    TEST_CASE("failure: a source or a target of 0 where there is light: missing, for every M") {
        for (size_t M : {1u, 4u}) {
            // p = 0 for the last two lights: only the first is found; p_hat = 0 for the last.
            CHECK(Resampling{M, {0.5, 0.5, 1e-30, 1e-30}, {1, 2, 0, 0}}.all().mean == is(1));
            CHECK(Resampling{M, p, {1, 2, 4, 0}}.all().mean == is(5));
        }
    }
}

TEST_SUITE("ch12 target") {
    TEST_CASE("identity: targets without a branch are those of the four formulas") {
        for (const Scene& scene : {all_kinds(), scene_from("scenes/thousand-lights.pbrt", 16, 1)}) {
            Sampler random = random_numbers(1);
            int gave = 0, off = 0;
            for (size_t k = 0; k < 20000; k++) {
                Hit x = somewhere(scene, random);
                size_t i = k % scene.lights.size();
                ch12::LightBounds y = ch12::light_bounds(scene, i);
                double expected = p_hat_by_type(scene, i, x), found = double{ch12::target(y, x)};
                float d = std::max(length(y.centre - y.has_place * x.p), y.radius);
                double facing = double{y.power / (d * d)};
                // Where a light is about to be hidden, the last bits of a cosine decide.
                off += std::abs(found - expected) > 1e-4 * expected + 1e-6 * facing;
                gave += expected > 0;
            }
            CHECK(off < 3);
            CHECK(gave > 5000);
        }
    }

    TEST_CASE("identity: wherever any point of a light gives something, the target is not 0") {
        for (const std::string& shape :
             {square(0, false), std::string("Shape \"disk\""), std::string("Shape \"sphere\""),
              std::string("Shape \"trianglemesh\" \"point3 P\" [-1 0 -1  1 0.2 -0.5  0 0 1]"),
              std::string("Shape \"trianglemesh\" \"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4]"
                          " \"point3 P\" [-1 1 -1  1 1 -1  1 1 1  -1 1 1  0.1 1.5 0.1]")})
            for (bool two_sided : {false, true}) {
                Scene scene = world_of(
                    "AreaLightSource \"diffuse\" Rotate 35 1 2 3 Scale 0.3 0.3 0.3 " + shape);
                scene.lights[0].two_sided = two_sided;
                ch12::LightBounds bounds = ch12::light_bounds(scene, 0);
                Sampler random = random_numbers(1);
                int gave = 0, not_by_centre = 0;
                for (int i = 0; i < 40000; i++) {
                    Hit x{};
                    float distance = 0.1f * std::pow(1000.0f, random.u1());
                    x.p = distance * uniform_direction(random.u2());
                    x.n = x.ng = uniform_direction(random.u2());
                    LightPoint y = sample_area(scene, 0, random.u2());
                    Vec3 to_y = y.p - x.p;
                    float cos_y = -dot(to_y, y.n);
                    if (dot(to_y, x.n) <= 0 || (two_sided ? cos_y == 0 : cos_y <= 0)) continue;
                    gave++;
                    CHECK(ch12::target(bounds, x) > 0);
                    not_by_centre += dot(bounds.centre - x.p, x.n) <= 0;
                }
                CHECK(gave > 1000);
                CHECK(not_by_centre > 100);  // where a plain cosine at the centre would be 0
            }
    }
}

TEST_SUITE("ch12 ris") {
    TEST_CASE("variance: a thousand lights: a quarter of the relMSE of chapter 11") {
        Scene scene = scene_from("scenes/thousand-lights.pbrt", 32, 8);
        CHECK(rel_mse(scene, trace_12(scene), 128) < rel_mse(scene, trace_11(scene), 256) / 4);
    }

    TEST_CASE("failure: a bright light behind a wall: resampling is worse than chapter 11") {
        Scene scene = scene_from("scenes/hidden-light.pbrt", 32, 8);
        CHECK(rel_mse(scene, trace_12(scene), 128) > 2 * rel_mse(scene, trace_11(scene), 128));
    }
}
