// What chapter 26 prepares beside its lesson: rows, balance, corners, final gathers, meshes.
#include <doctest/doctest.h>

#include <atomic>
#include <cstring>

#include "chapters/26_radiosity/run.h"
#include "tests/support/estimators.h"
#include "tests/support/folder.h"

namespace {

using ch26::Balance, ch26::Matrix, ch26::Radiosity, ch26::Rows, ch26::Solution, ch26::to_rgb;
using ch26::make_patches, ch26::Patch, ch26::Patches, ch26::Show, ch26::Shown;

doctest::Approx about(double x, double by) { return doctest::Approx(x).epsilon(by).scale(0); }

/// Red to green to blue to red.
Rgb turned(Rgb p) { return {p.b, p.r, p.g}; }
bool is_near(Rgb a, Rgb b, float by) {
    float size = 1e-6f + max_component(a) + max_component(b);
    return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < by * size;
}

std::string rgb(Rgb c, int turns) {
    for (; turns > 0; turns--) c = turned(c);
    std::string text = "[";
    for (float x : {c.r, c.g, c.b}) text += std::to_string(x) + " ";
    return text + "]";
}
std::string diffuse(Rgb c, int turns) {
    return "Material \"diffuse\" \"rgb reflectance\" " + rgb(c, turns) + "\n";
}

/// An open room in colours: a floor, two walls, a box, and a lamp, seen from before.
Scene colours(int turns) {
    std::string text = diffuse({0.7f, 0.5f, 0.2f}, turns) + square(-1, true) +
                       diffuse({0.1f, 0.6f, 0.9f}, turns) + "AttributeBegin Rotate -90 1 0 0\n" +
                       square(-1, true) + "AttributeEnd AttributeBegin Rotate -90 0 0 1\n" +
                       square(-1, true) + "AttributeEnd\n" + diffuse({0.4f, 0, 0.5f}, turns) +
                       "AttributeBegin Translate 0.3 -0.5 0.2 Scale 0.3 1 0.3\n" + square(0, true) +
                       square(0, false) + "AttributeEnd\n" +
                       "AreaLightSource \"diffuse\" \"rgb L\" " + rgb({3, 5, 11}, turns) +
                       diffuse({0.3f, 0.2f, 0.1f}, turns) + "Translate 0 0.9 0 Scale 0.4 1 0.4\n" +
                       square(0, false);
    return world_of(text, 16);
}

/// One lamp of a closed cube, or all of it.
Scene cube(bool even) {
    std::string all;
    for (const char* turn : {"Rotate 0 1 0 0", "Rotate 90 1 0 0", "Rotate 180 1 0 0",
                             "Rotate -90 1 0 0", "Rotate 90 0 0 1", "Rotate -90 0 0 1"}) {
        bool shines = even || all.empty();
        all += "AttributeBegin\n" + diffuse({0.5f, 0.5f, 0.5f}, 0) +
               (shines ? "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n" : "") + turn + "\n" +
               square(-1, true) + "AttributeEnd\n";
    }
    return world_of(all, 16);
}

struct Solved {
    std::shared_ptr<Patches> patches;
    Solution by_sweeps, by_shots;
};
Solved solve(const Scene& scene, size_t wanted, int shots) {
    Solved s{std::make_shared<Patches>(make_patches(scene, wanted, 2)), {}, {}};
    const std::vector<Patch>& patch = s.patches->patch;
    Rows rows = ch26::form_factors(scene, *s.patches, ch26::FormFactors::contour, 0, 2);
    ch26::start(patch, s.by_shots);
    for (int i = 0; i < shots; i++) {
        size_t next = ch26::brightest(patch, s.by_shots).value();
        ch26::shoot(*s.patches, next, rows.row(next), s.by_shots);
    }
    Matrix G = rows.take_all();
    ch26::repair(G, patch, s.patches->closed);
    ch26::solve(G, patch, ch26::Sweep::gauss_seidel, 1e-9, s.by_sweeps);
    return s;
}

Patch patch_at(float x, float area, Rgb E, Rgb rho) {
    Patch p;
    p.p = {{{x, 0, 0}, {x + 1, 0, 0}, {x, 0, 1}}};
    p.area = area, p.E = E, p.rho = rho;
    return p;
}

}  // namespace

TEST_SUITE("ch26 parts") {
    TEST_CASE("identity: each channel is solved and shown as if it were alone") {
        Scene scene = colours(0), other = colours(1);
        Solved a = solve(scene, 150, 60), b = solve(other, 150, 60);
        const std::vector<Patch>&p = a.patches->patch, &q = b.patches->patch;
        REQUIRE(p.size() == q.size());
        float least = infinity;
        for (size_t i = 0; i < p.size(); i++) {
            CHECK(turned(p[i].E) == q[i].E);
            CHECK(turned(p[i].rho) == q[i].rho);
            CHECK(is_near(turned(to_rgb(a.by_sweeps.H[i])), to_rgb(b.by_sweeps.H[i]), 1e-5f));
            CHECK(is_near(turned(to_rgb(a.by_shots.H[i])), to_rgb(b.by_shots.H[i]), 1e-5f));
            CHECK(
                is_near(turned(to_rgb(a.by_shots.unshot[i])), to_rgb(b.by_shots.unshot[i]), 1e-5f));
            least = std::min(least, static_cast<float>(a.by_sweeps.H[i].g));
        }
        CHECK(least > 0);
        CHECK(is_near(turned(to_rgb(a.by_shots.escaped)), to_rgb(b.by_shots.escaped), 1e-5f));
        Rgb more = to_rgb(ch26::ambient(p, a.by_shots));
        CHECK(is_near(turned(more), to_rgb(ch26::ambient(q, b.by_shots)), 1e-5f));
        CHECK(more.r > 0);
        Balance c = ch26::balance_of(p, a.by_shots), d = ch26::balance_of(q, b.by_shots);
        CHECK(c.absorbed == about(d.absorbed, 1e-6));
        CHECK(c.unshot == about(d.unshot, 1e-6));
        for (Show how : {Show::constant, Show::smooth, Show::gather}) {
            CAPTURE(static_cast<int>(how));
            Shown x = ch26::show(scene, a.patches, a.by_shots, how, 2);
            Shown y = ch26::show(other, b.patches, b.by_shots, how, 2);
            Image m = film_of(scene, trace_with<ch26::trace>(x), 4).film.image();
            Image n = film_of(other, trace_with<ch26::trace>(y), 4).film.image();
            int lit = 0;
            for (size_t i = 0; i < m.pixels.size(); i++) {
                CHECK(is_near(turned(m.pixels[i]), n.pixels[i], 1e-4f));
                lit += m.pixels[i].g > 0;
            }
            CHECK(lit > 50);
        }
    }

    TEST_CASE("truth: where the power of lamps went, by hand") {
        std::vector<Patch> patch = {patch_at(0, 2, {1, 2, 3}, {0.5f, 0.25f, 0}),
                                    patch_at(0, 4, {0, 0, 1}, {0, 0.5f, 1})};
        Solution s;
        s.H = {{1, 2, 4}, {8, 16, 32}};
        s.escaped = {1, 2, 4};
        Balance b = ch26::balance_of(patch, s);
        CHECK(b.emitted == 2 * 6 + 4 * 1);
        CHECK(b.absorbed == 2 * (0.5 + 1.5 + 4) + 4 * (8 + 8 + 0));
        CHECK(b.escaped == 7);
        CHECK(b.unshot == 0);
        s.unshot = {{1, 0, 2}, {0, 4, 0}};
        b = ch26::balance_of(patch, s);
        CHECK(b.unshot == 2 * 3 + 4 * 4);
        CHECK(b.error() == about((76 + 7 + 22) / 16.0 - 1, 1e-12));
        // Quotients of nothing are 0, channel by channel; the largest counts without its sign.
        Radiosity q = ch26::ratio({6, 5, 4}, {2, 0, 1});
        CHECK(q.r == 3);
        CHECK(q.g == 0);
        CHECK(q.b == 4);
        for (Radiosity x : {Radiosity{-7, 1, 2}, {1, -7, 2}, {1, 2, -7}})
            CHECK(ch26::largest_of(x) == 7);
    }

    TEST_CASE("identity: rows ask for each pair once, and know the least and the largest sum") {
        // More than one block of 256.
        std::vector<Patch> patch;
        for (uint32_t i = 0; i < 300; i++)
            patch.push_back(patch_at(0, 1 + static_cast<float>(i % 5), {}, {}));
        std::atomic<int> asked = 0;
        Rows rows(patch, 2, [&](uint32_t i, uint32_t j) {
            CHECK(i < j);
            asked++;
            return (i + 2.0 * j) / 100;
        });
        CHECK(rows.bytes() == 300 * 300 * 4);
        CHECK(rows.keeps());
        double lowest = 1e300, highest = 0;
        auto exchange = [](uint32_t i, uint32_t j) {
            return i == j ? 0.0f
                          : static_cast<float>((std::min(i, j) + 2.0 * std::max(i, j)) / 100);
        };
        for (uint32_t i : {7u, 299u, 7u, 0u}) {
            std::span<const float> row = rows.row(i);
            double sum = 0;
            for (uint32_t j = 0; j < 300; j++) {
                CHECK(row[j] == exchange(i, j));
                sum += double{row[j]} / double{patch[i].area};
            }
            lowest = std::min(lowest, sum), highest = std::max(highest, sum);
            CHECK(rows.sums().lowest == about(lowest, 1e-12));
            CHECK(rows.sums().highest == about(highest, 1e-12));
        }
        CHECK(asked == 299 + 298 + 297);
        Matrix all = rows.take_all();
        CHECK(asked == 300 * 299 / 2);
        REQUIRE(all.size() == 300);
        for (uint32_t i = 0; i < 300; i++)
            for (uint32_t j = 0; j < 300; j++) CHECK(all[i][j] == exchange(i, j));
        // Too many to keep: nothing is taken, and rows are worked out again.
        std::vector<Patch> many(16385, patch[0]);
        asked = 0;
        Rows large(many, 2, [&](uint32_t, uint32_t) { return ++asked, 1.0; });
        CHECK_FALSE(large.keeps());
        for (int again : {1, 2}) {
            CHECK(large.row(5)[16384] == 1);
            CHECK(large.row(5)[5] == 0);
            CHECK(asked == 2 * again * 16384);
        }
        CHECK(large.take_all().empty());
        CHECK(Rows(std::vector<Patch>(16384), 1, {}).keeps());  // 2^30 bytes
    }

    TEST_CASE("truth: corners follow radiosity that rises evenly, and stop at an edge") {
        // A floor lit by a lamp above; to its right one of another colour.
        Scene scene =
            world_of(diffuse({0.5f, 0.5f, 0.5f}, 0) + square(0, true) + "Translate 2 0 0\n" +
                     diffuse({0.25f, 0.25f, 0.25f}, 0) + square(0, true) +
                     "AreaLightSource \"diffuse\" Translate -1 5 0 " + square(0, false));
        auto patches = std::make_shared<Patches>(make_patches(scene, 400, 2));
        const std::vector<Patch>& patch = patches->patch;
        std::vector<Rgb> B;
        auto value = [](Vec3 p) { return p.x < 1 ? 3 + p.x + 0.5f * p.z : 1.0f; };
        for (const Patch& p : patch) {
            float b = value(p.centre);
            B.push_back(p.centre.y > 1 ? Rgb{9, 9, 9} : Rgb{b, b, b});
        }
        Shown shown = ch26::make_shown(scene, patches, B, Show::smooth, 2);
        int inner = 0, right = 0;
        for (size_t i = 0; i < patch.size(); i++) {
            Rgb sum;
            for (size_t c = 0; c < 3; c++) {
                Vec3 p = patch[i].p[c];
                Rgb b = shown.B[i][c];
                sum += b / 3;
                if (p.y > 1) CHECK(b.g == about(9, 1e-5));
                right += patch[i].centre.x > 1 && p.y < 1;
                if (patch[i].centre.x > 1 && p.y < 1) CHECK(b.g == about(1, 1e-5));
                bool is_inner = std::max(std::abs(p.x), std::abs(p.z)) < 0.7f;
                if (patch[i].centre.x > 1 || p.y > 1 || !is_inner) continue;
                CHECK(std::abs(b.g - value(p)) < 0.03f);
                inner++;
            }
            CHECK(std::abs(sum.g / B[i].g - 1) < 0.03f);  // the light of each patch
        }
        CHECK(inner > 100);
        CHECK(right > 100);
        // Between the corners it is linear, and constant patches have one value.
        Shown constant = ch26::make_shown(scene, patches, B, Show::constant, 2);
        for (size_t i = 0; i < patch.size(); i += 5) {
            Vec3 weights = {0.2f, 0.3f, 0.5f}, p;
            Rgb expected;
            for (int c = 0; c < 3; c++) {
                p = p + weights[c] * patch[i].p[static_cast<size_t>(c)];
                expected += weights[c] * shown.B[i][static_cast<size_t>(c)];
            }
            auto x = intersect(scene, {p + 0.1f * patch[i].n, -patch[i].n});
            REQUIRE(x);
            CHECK(is_near(ch26::radiosity_at(shown, *x), expected, 1e-3f));
            CHECK(is_near(ch26::radiosity_at(constant, *x), B[i], 1e-5f));
        }
        // A side without light has no patches, and is black.
        auto below = intersect(scene, {{0.1f, -1, 0.1f}, {0, 1, 0}});
        REQUIRE(below);
        CHECK(is_black(ch26::radiosity_at(shown, *below)));
    }

    TEST_CASE("agreement: a final gather of two and three bounces has the mean of one") {
        Scene even = cube(true), uneven = cube(false);
        for (const Scene* scene : {&even, &uneven}) {
            Solved s = solve(*scene, 600, 0);
            Shown shown = ch26::show(*scene, s.patches, s.by_sweeps, Show::gather, 2);
            Hit x = *intersect(*scene, {{0.1f, 0.2f, 0.3f}, normalize(Vec3{1, 0.3f, 0.2f})});
            Measured measured[3];
            for (int bounces : {1, 2, 3}) {
                RunningStats L;
                Sampler sampler(SamplerType::independent, 4, 1);
                for (uint32_t i = 0; i < 40000; i++) {
                    sampler.start(0, i);
                    L.add(double{ch26::final_gather(*scene, shown, x, x.n, sampler, bounces).g});
                }
                measured[bounces - 1] = {L.mean(), L.standard_error()};
            }
            CHECK(z_between(measured[0], measured[1]) < 5);
            CHECK(z_between(measured[0], measured[2]) < 5);
            CHECK(measured[2].se < 0.01 * measured[2].mean);
            // All of it emits pi W m^-2 and reflects half: 2 pi leave, of which half is reflected.
            if (scene == &even) CHECK(std::abs(measured[2].mean - 1) < 5 * measured[2].se);
        }
    }

    TEST_CASE("identity: spheres made meshes are closed, round, and have their side") {
        Scene scene = world_of(
            "AreaLightSource \"diffuse\"\nTranslate 1 2 3 Shape \"sphere\" \"float radius\" 2\n"
            "ReverseOrientation Translate 5 0 0 Shape \"sphere\" \"float radius\" 0.5\n"
            "Rotate 30 0 1 1 Shape \"disk\" \"float radius\" 3\n");
        Vec3 disk_c = scene.geometry.disks[0].c, disk_n = scene.geometry.disks[0].n;
        CHECK(ch26::tessellate(scene, 1) == 2 * 512 + 32);
        const Geometry& g = scene.geometry;
        auto sides_of = [&](uint32_t prim) {
            auto t = ch26::corners(scene, prim);
            return 0.5f * cross(t[1] - t[0], t[2] - t[0]);
        };
        for (auto [first, c, r, sign] :
             {std::tuple{0u, Vec3{1, 2, 3}, 2.0f, 1.0f}, {512u, Vec3{6, 2, 3}, 0.5f, -1.0f}}) {
            Vec3 sum;
            std::map<int, int> octants;
            float least = infinity, most = 0;
            for (uint32_t i = first; i < first + 512; i++) {
                auto t = ch26::corners(scene, i);
                Vec3 away = (t[0] + t[1] + t[2]) / 3 - c;
                sum += sides_of(i);
                CHECK(sign * dot(g.facet_normals[i], away) > 0.9f * length(away));
                octants[(away.x > 0) + 2 * (away.y > 0) + 4 * (away.z > 0)]++;
                for (Vec3 p : t) {
                    least = std::min(least, length(p - c)), most = std::max(most, length(p - c));
                }
                float size = std::sqrt(length(sides_of(i))) / r;
                CHECK(size > 0.08f);
                CHECK(size < 0.25f);
            }
            CHECK(length(sum) < 1e-4f * r * r);
            CHECK(octants.size() == 8);
            for (auto [octant, n] : octants) CHECK(n == 64);
            CHECK(most / least < 1.0001f);
            CHECK(least > r);
        }
        double area = 0;
        for (uint32_t i = 1024; i < 1024 + 32; i++) {
            area += double{length(sides_of(i))};
            CHECK(dot(g.facet_normals[i], disk_n) > 0.9999f);
            CHECK(length(ch26::corners(scene, i)[0] - disk_c) < 1e-5f);
        }
        CHECK(area == about(9 * pi_exact, 1e-5));
        CHECK(ch26::tessellate(scene, 1) == 0);
    }

    TEST_CASE("input: a closed room has to absorb in each channel") {
        Patches patches;
        patches.closed = true;
        for (Rgb rho : {Rgb{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.9f, 0.9f, 0.9f}}) {
            patches.patch = {patch_at(0, 1, {}, {1, 1, 1}), patch_at(0, 1, {}, rho)};
            std::string error = error_of([&] { ch26::refuse_no_loss(cube(true), patches); });
            CHECK(error.empty() == (rho.r == 0.9f));
            if (!error.empty()) CHECK(error.starts_with("test.pbrt: error: a closed room whose "));
        }
    }
}
