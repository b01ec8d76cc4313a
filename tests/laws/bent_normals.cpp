// Law: what meshes with normals at their vertices look like: how normals are interpolated, and
// which of the two normals decides what.
#include <cstdio>

#include "tests/laws/laws.h"
#include "tests/support/ggx_truth.h"

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
    return seen_along(scene, onto_origin);
}
const std::string white = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n";
/// eta 0.2, k 3.9
std::string rough_metal(const std::string& alpha) {
    return "Material \"conductor\" \"rgb eta\" [.2 .2 .2] \"rgb k\" [3.9 3.9 3.9]"
           " \"float roughness\" " +
           alpha + " \"bool remaproughness\" false\n";
}
std::string ball_at(Vec3 c) { return "Translate " + words({c.x, c.y, c.z}) + "Shape \"sphere\"\n"; }

/// A black lamp of four triangles, the unit square at height h, that shines down but whose normals
/// lean in all directions.
std::string bent_lamp(float h) {
    std::vector<Vec3> P = {
        {-.5f, h, -.5f}, {.5f, h, -.5f}, {.5f, h, .5f}, {-.5f, h, .5f}, {0, h, 0}};
    std::vector<Vec3> N = {{2, -1, 0}, {0, -1, 2}, {1, -1, 1}, {-1, -1, 2}, {1.5f, -1, -1}};
    return shining + mesh("0 1 4 1 2 4 2 3 4 3 0 4", P, N);
}

}  // namespace

TEST_SUITE("law: bent normals") {
    TEST_CASE("truth: where normals lean, a white floor is (1 + cos) / 2 as bright under a sky") {
        // Of what the leaning normal would face, the floor itself hides a part.
        for (double angle : {0.3, 0.9})
            check_light(leaning_floor(angle, white, "LightSource \"infinite\""),
                        {(1 + std::cos(angle)) / 2, 0.01});
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
        for (size_t first = 0; first < 3; first++) {
            CAPTURE(first);
            std::vector<Vec3> corners, normals;
            for (size_t i = 0; i < 3; i++) {
                corners.push_back(P[(first + i) % 3]), normals.push_back(N[(first + i) % 3]);
            }
            Scene scene = world_of("AttributeBegin " + white + mesh("0 1 2", corners, normals) +
                                   "AttributeEnd\n" + shining + ball_at(3 * to_ball));
            scene.max_depth = 1;
            check_light(seen_along(scene, onto_origin),
                        {static_cast<double>(dot(normalize(n), to_ball)) / 9});
        }
    }

    TEST_CASE("truth: a lamp that only a mirror shows counts by the cosine of the leaning normal" *
              doctest::skip()) {
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
        check_light(scene, {0.25 / static_cast<double>(dot(image, image)) * std::abs(cos), 0.12});
    }

    TEST_CASE("identity: no light from below the surface, even where the bent normal faces it") {
        // The normal leans towards +x. One ball is in its sight, but below the floor; one is above
        // the floor, but behind the normal.
        for (Vec3 ball : {Vec3{4, -1.5f, 0}, {-4, 1.5f, 0}})
            for (const std::string& material : {white, rough_metal("0.5")})
                check_light(leaning_floor(0.9, material, shining + ball_at(ball)), {0});
    }

    TEST_CASE("truth: rough metal under a sky, from straight above a floor whose normals lean") {
        for (double alpha : {0.2, 1.0})
            for (double angle : {0.3, 0.9}) {
                CAPTURE(alpha);
                CAPTURE(angle);
                check_light(leaning_floor(angle, rough_metal(std::to_string(alpha)),
                                          "LightSource \"infinite\""),
                            {RoughMetal{alpha, 0.2, 3.9}.albedo(angle, angle), 0.01, 6e-5});
            }
    }

    TEST_CASE("truth: a lamp whose normals lean lights as a flat one does, near and far") {
        for (auto [h, E] : {std::pair{1.0f, 0.7522746884541}, {1.5f, 0.3874136329362}})
            check_light(lit_floor(bent_lamp(h)), {E / pi_exact});
    }

    TEST_CASE("identity: the side that shines is that of the surface, not of the bent normal") {
        Scene scene = floor_under(bent_lamp(1));
        scene.max_depth = 0;
        int leans_away = 0;
        Sampler random = random_numbers(1);
        for (int i = 0; i < 100; i++) {
            Vec2 u = random.u2();
            Vec3 d = uniform_direction(random.u2()),
                 at = {0.9f * u.x - 0.45f, 1, 0.9f * u.y - 0.45f};
            if (std::abs(d.y) < 0.1f) continue;
            Ray ray = {at - 0.5f * d, d};
            leans_away += intersect(scene, ray)->n == intersect(scene, ray)->ng;
            for (const NamedMethod& row : methods_for(seen_along(scene, ray))) {
                if (row.search == LightSearch::from_lights || row.blurs()) continue;
                CAPTURE(row.name);
                Measured m = brightness(seen_along(scene, ray), row, 64);
                CHECK(m.mean == (d.y > 0 ? 1 : 0));
            }
        }
        CHECK(leans_away > 10);
    }
}
