// Meshes with normals at their vertices, in every chapter: how they are interpolated, which of the
// two normals decides what, and the same pictures by every way of looking for light.
#include <cstdio>

#include "tests/support/chapters.h"
#include "tests/support/ggx_truth.h"
#include "tests/support/light_paths.h"
// After the chapters below it: its names must not be found by theirs.
#include "tests/traces/16.h"
#include "tests/traces/20.h"

namespace {

std::string words(std::initializer_list<float> numbers) {
    std::string text;
    for (float x : numbers) {
        char word[40];
        std::snprintf(word, sizeof word, "%.9g ", double{x});
        text += word;
    }
    return text;
}
std::string words(const std::vector<Vec3>& points) {
    std::string text;
    for (Vec3 p : points) text += words({p.x, p.y, p.z});
    return text;
}
std::string mesh(const std::string& indices, const std::vector<Vec3>& P,
                 const std::vector<Vec3>& N) {
    return "Shape \"trianglemesh\" \"integer indices\" [" + indices + "] \"point3 P\" [" +
           words(P) + "] \"normal N\" [" + words(N) + "]\n";
}

/// The direction that leans from straight up towards +x by this angle.
Vec3 leaning(double angle) {
    return {static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle)), 0};
}
/// A square around the origin whose normals lean by this angle; s: half its side.
std::string leaning_square(double angle, float s) {
    std::vector<Vec3> corners = {{-s, 0, -s}, {-s, 0, s}, {s, 0, s}, {s, 0, -s}};
    return mesh("0 1 2 0 2 3", corners, std::vector(4, leaning(angle)));
}
/// A large floor of this kind under lights.
Scene leaning_floor(double angle, const std::string& material, const std::string& light) {
    Scene scene = world_of("AttributeBegin " + material + leaning_square(angle, 500) +
                           "AttributeEnd\n" + light);
    scene.max_depth = 1;
    return scene;
}
const std::string white = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n";
/// eta 0.2, k 3.9
std::string rough_metal(const std::string& alpha) {
    return "Material \"conductor\" \"rgb eta\" [.2 .2 .2] \"rgb k\" [3.9 3.9 3.9]"
           " \"float roughness\" " +
           alpha + " \"bool remaproughness\" false\n";
}
std::string ball_at(Vec3 c) { return "Translate " + words({c.x, c.y, c.z}) + "Shape \"sphere\"\n"; }

/// A round mesh with the normals of a ball, of 10 x 6 rectangles.
std::string smooth_ball(Vec3 centre, float r) {
    std::vector<Vec3> P, N;
    std::string indices;
    for (int j = 0; j <= 6; j++)
        for (int i = 0; i <= 10; i++) {
            Vec3 n = from_cylindrical(std::sin(pi * static_cast<float>(j) / 6),
                                      static_cast<float>(i % 10) / 10,
                                      std::cos(pi * static_cast<float>(j) / 6));
            P.push_back(centre + r * n), N.push_back(n);
            if (i == 10 || j == 6) continue;
            int a = 11 * j + i;
            for (int k : {a, a + 11, a + 12, a, a + 12, a + 1}) indices += std::to_string(k) + " ";
        }
    return mesh(indices, P, N);
}

/// A black lamp of four triangles, the unit square at height h, that shines down but whose normals
/// lean in all directions.
std::string bent_lamp(float h) {
    std::vector<Vec3> P = {
        {-.5f, h, -.5f}, {.5f, h, -.5f}, {.5f, h, .5f}, {-.5f, h, .5f}, {0, h, 0}};
    std::vector<Vec3> N = {{2, -1, 0}, {0, -1, 2}, {1, -1, 1}, {-1, -1, 2}, {1.5f, -1, -1}};
    return shining + mesh("0 1 4 1 2 4 2 3 4 3 0 4", P, N);
}

/// One chapter's functions of a surface.
struct Bsdf {
    std::string name;
    Rgb (*eval)(const Hit&, Vec3, Vec3);
    float (*pdf)(const Hit&, Vec3, Vec3);
    std::function<BsdfSample(const Hit&, Vec3, float, Vec2)> sample;
};
const Bsdf every_bsdf[] = {
    {"07", ch07::eval_bsdf, ch07::pdf_bsdf,
     [](const Hit& x, Vec3 wo, float u1, Vec2 u2) {
         auto [wi, f, pdf_w, specular] = ch07::sample_bsdf(x, wo, u1, u2);
         return BsdfSample{wi, f, pdf_w, specular};
     }},
    {"08", ch08::eval_bsdf, ch08::pdf_bsdf, ch08::sample_bsdf},
    {"09", ch09::eval_bsdf, ch09::pdf_bsdf, ch09::sample_bsdf},
    {"10", ch10::eval_bsdf, ch10::pdf_bsdf, ch10::sample_bsdf},
    {"11 and 12", basic_bsdf::eval_bsdf, basic_bsdf::pdf_bsdf, basic_bsdf::sample_bsdf},
    {"13", ch13::eval_bsdf, ch13::pdf_bsdf, ch13::sample_bsdf},
    {"14 and 15", glossy_bsdf::eval_bsdf, glossy_bsdf::pdf_bsdf, glossy_bsdf::sample_bsdf}};

}  // namespace

TEST_SUITE("bent normals") {
    TEST_CASE("truth: where normals lean, a white floor is (1 + cos) / 2 as bright under a sky") {
        // Of what the leaning normal would face, the floor itself hides a part.
        for (double angle : {0.3, 0.9}) {
            Scene scene = leaning_floor(angle, white, "LightSource \"infinite\"");
            for (const Chapter& chapter : every_chapter(scene)) {
                CAPTURE(chapter.name);
                RunningStats s = irradiance(scene, chapter.trace, 20000);
                check_bounded(s, pi_exact * (1 + std::cos(angle)) / 2, 0.01);
            }
        }
    }

    TEST_CASE("truth: inside a triangle the normal is that of its corners, each by its weight") {
        // The origin is 0.2, 0.5, 0.3 of the corners. A ball of light, all of it in sight, gives
        // pi (R / D)^2 times the cosine.
        const Vec3 P[] = {{-500, 0, -500}, {500, 0, -100}, {-500, 0, 500}};
        const Vec3 N[] = {normalize({0, 1, -0.5f}), normalize({0.9f, 1, 0}),
                          normalize({-0.6f, 1, 0.4f})};
        const float weight[] = {0.2f, 0.5f, 0.3f};
        Vec3 to_ball = normalize({1, 1, 0.5f}), n = {};
        for (int i = 0; i < 3; i++) n = n + weight[i] * N[i];
        double E = pi_exact / 9 * static_cast<double>(dot(normalize(n), to_ball));
        for (size_t first = 0; first < 3; first++) {
            CAPTURE(first);
            std::vector<Vec3> corners, normals;
            for (size_t i = 0; i < 3; i++) {
                corners.push_back(P[(first + i) % 3]), normals.push_back(N[(first + i) % 3]);
            }
            Scene scene = world_of("AttributeBegin " + white + mesh("0 1 2", corners, normals) +
                                   "AttributeEnd\n" + shining + ball_at(3 * to_ball));
            scene.max_depth = 1;
            for (const Chapter& chapter : every_chapter(scene)) {
                CAPTURE(chapter.name);
                check_bounded(irradiance(scene, chapter.trace, chapter.by_chance ? 20000 : 2000), E,
                              0.05);
            }
        }
    }

    TEST_CASE("truth: a lamp that only a mirror shows counts by the cosine of the leaning normal") {
        // The normal leans away from the lamp, and looks at its image in the ceiling: a ball of
        // radius 0.5, which gives pi (R / D)^2 times the cosine. Only the next bounce finds it.
        const Vec3 image = {-2, 6.5f, 0};
        Scene scene = leaning_floor(0.9, white,
                                    "AttributeBegin Material \"conductor\" \"rgb eta\" [1 1 1]"
                                    " \"rgb k\" [1e4 1e4 1e4] Scale 500 1 500 " +
                                        square(4, false) + "AttributeEnd\n" + shining +
                                        "Translate -2 1.5 0 Shape \"sphere\" \"float radius\" 0.5");
        scene.max_depth = 2;
        double cos = static_cast<double>(dot(leaning(0.9), normalize(image)));
        double E = pi_exact * 0.25 / static_cast<double>(dot(image, image)) * std::abs(cos);
        for (const Chapter& chapter : every_chapter(scene)) {
            CAPTURE(chapter.name);
            check_bounded(irradiance(scene, chapter.trace, 60000), E, 0.12);
        }
    }

    TEST_CASE("identity: no light from below the surface, even where the bent normal faces it") {
        // The normal leans towards +x. One ball is in its sight, but below the floor; one is above
        // the floor, but behind the normal.
        for (Vec3 ball : {Vec3{4, -1.5f, 0}, {-4, 1.5f, 0}})
            for (const std::string& material : {white, rough_metal("0.5")}) {
                Scene scene = leaning_floor(0.9, material, shining + ball_at(ball));
                bool matt = material == white;
                for (const Chapter& chapter :
                     matt ? every_chapter(scene) : glossy_chapters(scene)) {
                    CAPTURE(chapter.name);
                    RunningStats s = irradiance(scene, chapter.trace, 5000);
                    CHECK(s.mean() == 0);
                    CHECK(s.variance() == 0);
                }
            }
    }

    TEST_CASE("consistency: f and density are 0 below the surface and behind the normal") {
        Material matt, metal;
        metal.type = MaterialType::conductor;
        metal.eta = {0.2f, 0.2f, 0.2f}, metal.k = {3.9f, 3.9f, 3.9f}, metal.alpha = 0.5f;
        Sampler random = random_numbers(1);
        for (const Bsdf& bsdf : every_bsdf)
            for (const Material* material : {&matt, &metal}) {
                if (material == &metal && bsdf.name < "13") continue;
                CAPTURE(bsdf.name);
                int below = 0, behind = 0, gone = 0;
                for (int i = 0; i < 3000; i++) {
                    Hit x{};
                    x.material = material;
                    x.ng = uniform_direction(random.u2());
                    x.n = normalize(x.ng + 0.9f * uniform_direction(random.u2()));
                    Vec3 wo = uniform_direction(random.u2()), wi = uniform_direction(random.u2());
                    if (dot(wo, x.n) < 0.01f || dot(wo, x.ng) < 0.01f) continue;
                    bool above = dot(wi, x.ng) > 0, facing = dot(wi, x.n) > 0;
                    below += !above && facing, behind += above && !facing;
                    CHECK(is_black(bsdf.eval(x, wo, wi)) == !(above && facing));
                    CHECK((bsdf.pdf(x, wo, wi) == 0) == !(above && facing));
                    float u1 = random.u1();
                    BsdfSample s = bsdf.sample(x, wo, u1, random.u2());
                    gone += s.pdf_w == 0;
                    if (s.pdf_w > 0) CHECK((dot(s.wi, x.n) > 0 && dot(s.wi, x.ng) > 0));
                }
                CHECK(below > 50);
                CHECK(behind > 50);
                CHECK(gone > 50);
            }
    }

    TEST_CASE("truth: rough metal under a sky, from straight above a floor whose normals lean") {
        for (double alpha : {0.2, 1.0})
            for (double angle : {0.3, 0.9}) {
                CAPTURE(alpha);
                CAPTURE(angle);
                Scene scene = leaning_floor(angle, rough_metal(std::to_string(alpha)),
                                            "LightSource \"infinite\"");
                double truth = RoughMetal{alpha, 0.2, 3.9}.albedo(angle, angle);
                for (const Chapter& chapter : glossy_chapters(scene)) {
                    CAPTURE(chapter.name);
                    RunningStats s = repeat(scene, onto_origin, chapter.trace, 40000);
                    CHECK(std::abs(s.mean() - truth) < 5 * s.standard_error() + 3e-4);
                    CHECK(s.standard_error() < 0.01);
                }
            }
    }

    TEST_CASE("truth: a lamp whose normals lean lights as a flat one does, near and far") {
        for (auto [h, E] : {std::pair{1.0f, 0.7522746884541}, {1.5f, 0.3874136329362}}) {
            Scene scene = floor_under(bent_lamp(h));
            for (const Chapter& chapter : every_chapter(scene)) {
                CAPTURE(chapter.name);
                check_bounded(irradiance(scene, chapter.trace, chapter.by_chance ? 100000 : 10000),
                              E, 0.05);
            }
        }
    }

    TEST_CASE("identity: the side that shines is that of the surface, not of the bent normal") {
        Scene scene = floor_under(bent_lamp(1));
        scene.max_depth = 0;
        for (const Chapter& chapter : every_chapter(scene)) {
            CAPTURE(chapter.name);
            int leans_away = 0;
            Sampler random = random_numbers(1);
            for (int i = 0; i < 500; i++) {
                Vec2 u = random.u2();
                Vec3 d = uniform_direction(random.u2()),
                     at = {0.9f * u.x - 0.45f, 1, 0.9f * u.y - 0.45f};
                if (std::abs(d.y) < 0.1f) continue;
                Ray ray = {at - 0.5f * d, d};
                leans_away += intersect(scene, ray)->n == intersect(scene, ray)->ng;
                CHECK(repeat(scene, ray, chapter.trace, 1).mean() == (d.y > 0 ? 1 : 0));
            }
            CHECK(leans_away > 50);
        }
    }

    TEST_CASE("agreement: smoothed normals" * doctest::skip()) {
        // Paths from lights against paths from the eye, over paint: few and large triangles, so
        // that normals lean far. At rest, and while the ball turns and is stretched.
        std::string ball = "Material \"diffuse\" \"rgb reflectance\" [.7 .7 .7]\n" +
                           smooth_ball({0.4f, 0, 0}, 0.9f);
        for (std::string light :
             {"LightSource \"distant\" \"point3 from\" [3 2 -1] \"point3 to\" [0 0 0]\n",
              "LightSource \"point\" \"point3 from\" [2 1 -3]\n", "LightSource \"infinite\"\n",
              "LightSource \"distant\" \"point3 from\" [3 2 -1] \"point3 to\" [0 0 0]\n"
              "ActiveTransform EndTime Rotate 100 1 0 1 Scale 1.2 0.6 1 ActiveTransform All\n"}) {
            CAPTURE(light);
            Scene scene = world_of("AttributeBegin Translate 0 -1 0 " + leaning_square(0.6, 9) +
                                   "AttributeEnd " + light + ball);
            scene.max_depth = 3;
            Method eye = method_of<ch16::trace>(ch16::prepare(scene));
            Method walk = method_of<ch20::trace_light>(ch20::endpoints_of(scene));
            CHECK(check_classes(scene, eye, scene, walk, 400000) >= 4);
            BlockMeans a = blocks_of(scene, eye, 16, 32, 8), b = blocks_of(scene, walk, 64, 32, 8);
            check_agreement(hold_against(a, b), 0.02);
        }
    }
}
