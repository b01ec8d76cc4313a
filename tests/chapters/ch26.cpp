// Chapter 26: patches, form factors, solvers, and the picture.
#include <doctest/doctest.h>

#include <atomic>
#include <numeric>

#include "chapters/15_mis_ris/estimator.h"
#include "chapters/26_radiosity/run.h"
#include "common/scene/diffuse_meshes.h"
#include "tests/support/estimators.h"
#include "tests/support/run_program.h"

namespace {

using ch26::make_patches, ch26::Matrix, ch26::Patch, ch26::Patches, ch26::Place, ch26::Radiosity;
using ch26::Show, ch26::Shown, ch26::Solution, ch26::Sweep;

// Values of unit squares: opposite at distance 1, and with a common edge.
constexpr double opposite = 0.1998248956984, beside = 0.2000437760754;

int all_threads() { return static_cast<int>(std::thread::hardware_concurrency()); }

/// A mesh of triangles, three corners each, as text.
std::string mesh(const std::vector<Vec3>& corners) {
    std::ostringstream text;
    text.precision(9);
    text << "Shape \"trianglemesh\" \"integer indices\" [";
    for (size_t i = 0; i < corners.size(); i++) text << i << ' ';
    text << "] \"point3 P\" [";
    for (Vec3 p : corners) text << p.x << ' ' << p.y << ' ' << p.z << ' ';
    text << "]\n";
    return text.str();
}
std::vector<Vec3> quad(Vec3 o, Vec3 u, Vec3 v) {
    return {o, o + u, o + u + v, o, o + u + v, o + v};
}
std::string diffuse(double rho) {
    std::string r = std::to_string(rho);
    return "Material \"diffuse\" \"rgb reflectance\" [" + r + " " + r + " " + r + "]\n";
}
/// A face that emits W W m^-2, with its own reflectance.
std::string emitting(double W, double rho, const std::string& shape) {
    std::string L = std::to_string(W / pi_exact);
    return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [" + L + " " + L + " " + L + "] " +
           diffuse(rho) + shape + "AttributeEnd\n";
}

/// The faces of the unit cube, seen from inside: z = 0 and 1, then the others.
std::vector<std::vector<Vec3>> cube_faces() {
    Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    return {quad({}, x, y), quad(z, y, x),  quad({}, y, z),
            quad(x, z, y),  quad({}, z, x), quad(y, x, z)};
}
/// A closed cube of this reflectance. `shining` of its faces emit 1 W m^-2.
Scene cube_room(double rho, size_t shining_faces, const std::string& more = "") {
    std::string text;
    auto faces = cube_faces();
    for (size_t f = 0; f < 6; f++) {
        text +=
            f < shining_faces ? emitting(1, rho, mesh(faces[f])) : diffuse(rho) + mesh(faces[f]);
    }
    return world_of(text + more);
}

/// Patches alone, to compare form factors with.
Patch patch_of(Vec3 a, Vec3 b, Vec3 c) {
    Patch p;
    Vec3 sides = cross(b - a, c - a);
    p.p = {a, b, c}, p.n = normalize(sides), p.centre = (a + b + c) / 3;
    p.area = length(sides) / 2, p.eps = 1e-6f;
    return p;
}
std::vector<Patch> patches_of(const std::vector<Vec3>& corners) {
    std::vector<Patch> patches;
    for (size_t i = 0; i < corners.size(); i += 3)
        patches.push_back(patch_of(corners[i], corners[i + 1], corners[i + 2]));
    return patches;
}

/// The form factor from all of one surface to all of another, with nothing in between.
double form_factor(const std::vector<Patch>& from, const std::vector<Patch>& to) {
    Scene empty = world_of("Translate 0 0 -99 " + emitting(1, 0.5, mesh(cube_faces()[0])));
    double sum = 0, area = 0;
    for (uint32_t i = 0; i < from.size(); i++) {
        area += double{from[i].area};
        for (uint32_t j = 0; j < to.size(); j++)
            sum += ch26::exchange(empty, from[i], to[j], hash32(i, j));
    }
    return sum / area;
}

/// A regular polygon around (0, 0, z) with the area of a disk, facing up or down.
std::vector<Vec3> disk_at(double z, double r, bool up, int sides = 48) {
    double turn = 2 * pi_exact / sides, R = r * std::sqrt(turn / std::sin(turn));
    auto at = [&](int i) {
        return Vec3{static_cast<float>(R * std::cos(turn * i)),
                    static_cast<float>(R * std::sin(turn * i)), static_cast<float>(z)};
    };
    std::vector<Vec3> corners;
    for (int i = 0; i < sides; i++) {
        Vec3 centre = {0, 0, static_cast<float>(z)};
        for (Vec3 p : {centre, at(up ? i : i + 1), at(up ? i + 1 : i)}) corners.push_back(p);
    }
    return corners;
}

/// The room of TRUTHS' cube: six patches of area 1, the first of which emits 1.
struct SixPatches {
    Matrix G;
    std::vector<Patch> patch = std::vector<Patch>(6);

    explicit SixPatches(double rho, int emitters = 1) {
        for (size_t i = 0; i < 6; i++) {
            constexpr float around = static_cast<float>(beside);
            G.push_back(std::vector<float>(6, around));
            G[i][i] = 0, G[i][i ^ 1] = 1 - 4 * around;  // the sum is 1 to the last bit
            float r = static_cast<float>(rho), E = static_cast<int>(i) < emitters ? 1 : 0;
            patch[i].area = 1, patch[i].rho = {r, r, r}, patch[i].E = {E, E, E};
        }
    }
};

double B_of(const Patch& p, const Solution& s, size_t i) { return ch26::radiosity_of(p, s.H[i]).g; }

/// The patch with most to shoot shoots it; false when there is none.
bool shoot_next(const Patches& patches, const Matrix& G, Solution& s) {
    std::optional<size_t> i = ch26::brightest(patches.patch, s);
    if (i) ch26::shoot(patches, *i, G[*i], s);
    return i.has_value();
}

/// Solved to the last digits by Gauss-Seidel.
Solution solved(const Matrix& G, const std::vector<Patch>& patch) {
    Solution s;
    ch26::solve(G, patch, Sweep::gauss_seidel, 1e-12, s);
    for (size_t i = 0; i < patch.size(); i++) {
        double out = double{patch[i].area} * (1 - ch26::row_sum(G[i], patch[i]));
        s.escaped += out * ch26::radiosity_of(patch[i], s.H[i]);
    }
    return s;
}

/// A room as a matrix of its patches.
struct Room {
    Patches patches;
    Matrix G;

    Room(const Scene& scene, size_t wanted, bool repaired = true)
        : patches(make_patches(scene, wanted, all_threads())), G(patches.patch.size()) {
        ch26::ExchangeOf exchange = ch26::form_factors(scene, patches, 0);
        for (size_t i = 0; i < G.size(); i++) ch26::row_of(G, i, all_threads(), exchange);
        if (repaired) ch26::repair(G, patches.patch, patches.closed);
    }
    double row_sum(size_t i) const { return ch26::row_sum(G[i], patches.patch[i]); }
    /// The mean radiosity of the patches that fit.
    template <class Fits>
    double mean_B(const Solution& s, const Fits& fits) const {
        double sum = 0, area = 0;
        for (size_t i = 0; i < patches.patch.size(); i++) {
            const Patch& p = patches.patch[i];
            if (!fits(p)) continue;
            sum += double{p.area} * B_of(p, s, i), area += double{p.area};
        }
        return sum / area;
    }
};

/// The room as the program shows it.
Method by_radiosity(const Scene& scene, size_t wanted, Show how) {
    Room room(scene, wanted);
    Solution s = solved(room.G, room.patches.patch);
    auto patches = std::make_shared<Patches>(room.patches);
    return method_of<ch26::trace>(ch26::show(scene, patches, s, how, all_threads()));
}

/// The program on a scene, small; `more` may say otherwise.
Finished run_program_with(const Words& more, const std::string& scene = "scenes/cornell.pbrt") {
    Words words = {scene, "--size", "33x17", "--spp", "2", "--patches", "300"};
    append(words, more);
    return run("26_radiosity", words);
}

/// A scene in a file, seen from inside the unit cube.
std::string file_of(const TemporaryFolder& folder, const std::string& world) {
    std::string path = folder / "room.pbrt";
    write_file_atomically(path,
                          "LookAt 0.5 0.5 0.05  0.5 0.5 1  0 1 0\nCamera \"perspective\"\n"
                          "PixelFilter \"box\"\nWorldBegin\n" +
                              world);
    return path;
}
/// A closed cube, all of which emits W W m^-2 and reflects rho.
std::string even_cube(double W, double rho) {
    std::string text;
    for (const auto& face : cube_faces()) text += emitting(W, rho, mesh(face));
    return text;
}

}  // namespace

TEST_SUITE("ch26 form factors") {
    TEST_CASE("truth: form factors by contour of squares and disks" * doctest::skip()) {
        Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
        auto floor = patches_of(quad({}, x, y));
        for (auto [d, F] :
             {std::pair{0.1, 0.8269945223973}, {1.0, opposite}, {10.0, 0.003162056838758}}) {
            auto above = patches_of(quad(static_cast<float>(d) * z, y, x));
            CHECK(std::abs(form_factor(floor, above) - F) < 3e-5);
        }
        auto wall = patches_of(quad({}, y, z));
        CHECK(std::abs(form_factor(floor, wall) - beside) < 1e-6);
        for (auto [r1, r2, h, F] : {std::array{1.0, 2.0, 1.0, 0.7639320225002},
                                    {2, 1, 1, 0.1909830056251},
                                    {1, 1, 0.1, 0.9048750780275}}) {
            auto low = patches_of(disk_at(0, r1, true)), high = patches_of(disk_at(h, r2, false));
            CHECK(std::abs(form_factor(low, high) - F) < 1e-4);
        }
    }

    TEST_CASE(
        "failure: the form factor by centres is 59 % off at distance 1, and exceeds 1 at 0.1") {
        Patch low, high;
        low.area = high.area = 1;
        low.n = {0, 0, 1}, high.n = {0, 0, -1};
        for (auto [distance, F] : {std::pair{0.1, 31.83098861838}, {1.0, 0.3183098861838}}) {
            double G = ch26::by_centres(low, high, {}, {0, 0, static_cast<float>(distance)});
            CHECK(G == doctest::Approx(F).epsilon(1e-6).scale(0));
        }
        high.n = {-1, 0, 0};
        double G = ch26::by_centres(low, high, {}, {0.5f, 0, 0.5f});
        CHECK(G == doctest::Approx(0.3183098861838).epsilon(1e-6).scale(0));
        // Six such faces: rows sum to 1.59, and light grows where more than 0.628 is reflected.
        CHECK(5 * G == doctest::Approx(1.59).epsilon(1e-2).scale(0));
    }

    TEST_CASE("truth: a small patch and a large one at decades of size and distance") {
        Patch large = patch_of({}, {1, 0, 0}, {0, 1, 0});
        for (float size : {0.3f, 0.01f}) {
            for (float distance : {1.0f, 0.01f}) {
                Vec3 o = {0.31f, 0.29f, distance};
                Patch small = patch_of(o, o + Vec3{0, size, 0}, o + Vec3{size, 0, 0});
                RunningStats F;  // from 4^5 points, which it hardly depends on
                std::vector<std::array<Vec3, 3>> parts = {small.p};
                for (int depth = 0; depth < 5; depth++) {
                    std::vector<std::array<Vec3, 3>> finer;
                    for (const auto& t : parts)
                        for (const auto& part : quarters(t)) finer.push_back(part);
                    parts = finer;
                }
                for (const auto& t : parts)
                    F.add(ch26::point_to_polygon((t[0] + t[1] + t[2]) / 3, small.n, large.p));
                double area = double{small.area};
                CHECK(form_factor({small}, {large}) ==
                      doctest::Approx(F.mean()).epsilon(1e-3).scale(0));
                CHECK(form_factor({large}, {small}) * double{large.area} / area ==
                      doctest::Approx(F.mean()).epsilon(1e-3).scale(0));
            }
        }
    }

    TEST_CASE("truth: what a wall hides: half of a square is seen past it") {
        // The wall stands in the plane x = 1/2 and hides all that is beyond it.
        Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
        Scene scene = world_of("Translate 0 0 0 " +
                               emitting(1, 0.5, mesh(quad({0.5f, -9, -9}, 18 * y, 18 * z))));
        auto low = patch_of({}, 0.5f * x, y), here = patch_of(z, z + y, z + 0.5f * x);
        auto beyond = patch_of(z + x, z + 0.6f * x, z + 0.8f * x + y);
        REQUIRE(dot(beyond.n, z) < 0);
        CHECK(ch26::exchange(scene, low, here, 1) > 0);
        CHECK(ch26::exchange(scene, low, beyond, 1) == 0);
    }

    TEST_CASE("identity: repaired rows sum to 1, and both ends agree" * doctest::skip()) {
        std::vector<Vec3> block = quad({0.3f, 0.3f, 0.3f}, {0.3f, 0.1f, 0}, {0, 0.1f, 0.4f});
        Scene scene = cube_room(0.5, 1, diffuse(0.3) + mesh(block));
        Room raw(scene, 150, false), room(scene, 150);
        REQUIRE(room.patches.closed);
        double worst = 0, worst_raw = 0;
        for (size_t i = 0; i < room.G.size(); i++) {
            worst = std::max(worst, std::abs(room.row_sum(i) - 1));
            worst_raw = std::max(worst_raw, std::abs(raw.row_sum(i) - 1));
            for (size_t j = 0; j < i; j++) CHECK(room.G[i][j] == room.G[j][i]);
        }
        CHECK(worst < 1e-6);
        CHECK(worst_raw > 1e-3);  // there was something to repair
        // In an open room rows sum to at most 1, and those that were right stay so.
        Room open(scene_from("scenes/cornell.pbrt", 32, 5), 300);
        CHECK_FALSE(open.patches.closed);
        for (size_t i = 0; i < open.G.size(); i++) CHECK(open.row_sum(i) < 1 + 1e-6);
    }

    TEST_CASE(
        "identity: rows are the same for any threads and order, and each pair is asked once") {
        constexpr uint32_t n = 300;  // more than one block of 256
        std::atomic<int> asked = 0;
        auto exchange = [&](uint32_t i, uint32_t j) {
            CHECK(i < j);
            asked++;
            return (i + 2.0 * j) / 100;
        };
        Matrix G(n), backwards(n);
        for (uint32_t i = 0; i < n; i++) ch26::row_of(G, i, 1, exchange);
        CHECK(asked == n * (n - 1) / 2);
        for (uint32_t i = n; i-- > 0;) ch26::row_of(backwards, i, 7, exchange);
        CHECK(G == backwards);
        CHECK(G[3][290] == static_cast<float>((3 + 2.0 * 290) / 100));
        CHECK(G[290][3] == G[3][290]);
        CHECK(G[290][290] == 0);
    }
}

TEST_SUITE("ch26 patches") {
    TEST_CASE("identity: patches cover what has light, and each point finds its patch") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 5);
        Patches patches = make_patches(scene, 2000, all_threads());
        CHECK(patches.patch.size() >= 2000);
        CHECK(patches.patch.size() < 2200);
        double area = 0, whole = 0;
        for (const Patch& p : patches.patch) {
            area += double{p.area};
            for (std::array<float, 3> b : {std::array{0.4f, 0.3f, 0.3f}, {0.1f, 0.8f, 0.1f}}) {
                Vec3 at = b[0] * p.p[0] + b[1] * p.p[1] + b[2] * p.p[2];
                auto x = intersect(scene, {at + 1e-2f * p.n, -p.n});
                REQUIRE(x);
                Place place = place_of(patches, *x);
                REQUIRE(place.patch != no_side);
                CHECK(&patches.patch[place.patch] == &p);
                for (size_t c = 0; c < 3; c++) CHECK(std::abs(place.b[c] - b[c]) < 2e-3);
            }
        }
        for (uint32_t prim = 0; prim < scene.geometry.triangles.size(); prim++) {
            auto t = corners(scene, prim);
            whole += double{length(cross(t[1] - t[0], t[2] - t[0])) / 2};
        }
        // The lamp has two sides, one of which sees the ceiling; and so have the blocks, since
        // patches of the floor lie below their sides.
        double lamp = 130.0 * 105, blocks = 165.0 * (6 * 165 + 4 * 330);
        CHECK(area == doctest::Approx(whole + lamp + blocks).epsilon(2e-3).scale(0));
    }

    TEST_CASE("input: what has no radiosity is refused, with its place in the file") {
        std::string lamp = emitting(1, 0.5, mesh(cube_faces()[0]));
        auto refusal = [&](const std::string& more) {
            return error_of([&] { refuse(world_of(lamp + '\n' + more)); });
        };
        CHECK(refusal(mesh(cube_faces()[1])) == "");
        auto reflecting = [](double rho) { return error_of([&] { refuse(cube_room(rho, 1)); }); };
        CHECK(
            reflecting(1).starts_with("test.pbrt: error: radiosity needs a surface that absorbs"));
        CHECK(reflecting(0.999) == "");
        for (const char* directive :
             {"Material \"dielectric\"", "Material \"conductor\" \"float roughness\" 0.3",
              "LightSource \"point\"", "LightSource \"infinite\""}) {
            std::string text = refusal(std::string(directive) + "\n" + mesh(cube_faces()[1]));
            CHECK(text.starts_with("test.pbrt:9:1: error: radiosity knows "));
        }
    }

    TEST_CASE("input: a sphere or disk too small to be cut into triangles is refused") {
        const std::string lamp = "Translate 3 2 1\nShape \"";
        for (const char* kind : {"sphere", "disk"}) {
            for (auto [radius, refused] : {std::pair{"1e-9", true}, {"1e-4", false}}) {
                Scene scene = world_of(
                    emitting(1, 0.5, lamp + kind + "\" \"float radius\" " + radius + "\n"));
                CHECK(error_of([&] { tessellate(scene, 2); }).empty() == !refused);
            }
        }
    }
}

TEST_SUITE("ch26 solvers") {
    TEST_CASE("truth: parallel plates, concentric spheres and the cube as matrices") {
        auto gray = [](float area, float rho, float E) {
            Patch p;
            p.area = area, p.rho = {rho, rho, rho}, p.E = {E, E, E};
            return p;
        };
        std::vector<Patch> plates = {gray(1, 0.5f, 1), gray(1, 0.8f, 0)};
        Solution s = solved({{0, 1}, {1, 0}}, plates);
        CHECK(B_of(plates[0], s, 0) == doctest::Approx(5.0 / 3).epsilon(1e-7).scale(0));
        CHECK(B_of(plates[1], s, 1) == doctest::Approx(4.0 / 3).epsilon(1e-7).scale(0));
        // Areas 1 and 4: the inner sees the outer alone, the outer also itself.
        std::vector<Patch> spheres = {gray(1, 0.5f, 1), gray(4, 0.5f, 0)};
        s = solved({{0, 1}, {1, 3}}, spheres);
        CHECK(B_of(spheres[0], s, 0) == doctest::Approx(10.0 / 9).epsilon(1e-9).scale(0));
        CHECK(B_of(spheres[1], s, 1) == doctest::Approx(2.0 / 9).epsilon(1e-9).scale(0));
        SixPatches cube(0.8);
        s = solved(cube.G, cube.patch);
        CHECK(B_of(cube.patch[0], s, 0) == doctest::Approx(1.551724153645).epsilon(5e-7).scale(0));
        CHECK(B_of(cube.patch[1], s, 1) == doctest::Approx(0.6895510707376).epsilon(2e-6).scale(0));
        CHECK(B_of(cube.patch[2], s, 2) == doctest::Approx(0.6896811939044).epsilon(2e-6).scale(0));
    }

    TEST_CASE("truth: sweeps end by what is still to come, not by the change") {
        // At 0.99 a change of 1e-3 hides up to 0.099.
        SixPatches cube(0.99, 6);
        double rho = double{cube.patch[0].rho.g}, truth = 1 / (1 - rho);
        for (double wanted : {1e-2, 1e-4, 1e-8}) {
            for (Sweep kind : {Sweep::jacobi, Sweep::gauss_seidel}) {
                Solution s;
                ch26::solve(cube.G, cube.patch, kind, wanted, s);
                double off = std::abs(B_of(cube.patch[0], s, 0) / truth - 1);
                CHECK(off < 1.05 * wanted);
                CHECK(off > wanted / 100);
            }
        }
    }

    TEST_CASE("identity: all that lamps emit is absorbed, escapes, or is unshot") {
        for (bool closed : {true, false}) {
            CAPTURE(closed);
            Scene scene = closed ? cube_room(0.5, 1) : scene_from("scenes/cornell.pbrt", 32, 5);
            Room room(scene, 200);
            REQUIRE(room.patches.closed == closed);
            const std::vector<Patch>& patch = room.patches.patch;
            Solution shots;
            ch26::start(patch, shots);
            for (int i = 0; i < 777; i++) shoot_next(room.patches, room.G, shots);
            for (const Solution& s : {solved(room.G, patch), shots}) {
                ch26::Balance b = balance_of(patch, s);
                CHECK(std::abs(b.error()) < 1e-9);
                CHECK(b.absorbed > 0.3 * b.emitted);
                if (closed) CHECK(std::abs(b.escaped) < 1e-6 * b.emitted);
                if (!closed) CHECK(b.escaped > 0.2 * b.emitted);
            }
        }
    }

    TEST_CASE("agreement: Jacobi, Gauss-Seidel and shots find the same") {
        Room room(scene_from("scenes/cornell.pbrt", 32, 5), 150);
        const std::vector<Patch>& patch = room.patches.patch;
        Solution a, b = solved(room.G, patch), c;
        ch26::solve(room.G, patch, Sweep::jacobi, 1e-12, a);
        ch26::start(patch, c);
        while (ch26::share_to_come(patch, c) > 1e-9 && shoot_next(room.patches, room.G, c)) {
        }
        CHECK(a.steps > b.steps);
        for (size_t i = 0; i < patch.size(); i++) {
            CHECK(a.H[i].r == doctest::Approx(b.H[i].r).epsilon(1e-9).scale(0));
            CHECK(c.H[i].r == doctest::Approx(b.H[i].r).epsilon(1e-6).scale(0));
        }
    }

    TEST_CASE("identity: spheres and disks made meshes keep area, power and the side that shines") {
        // The lamps are not the first shapes, nor the last.
        std::string shapes =
            diffuse(0.5) + "Shape \"sphere\" \"float radius\" 0.5\n" + mesh(cube_faces()[0]) +
            emitting(1, 0.5, "Translate 5 0 0 Shape \"disk\"\n") +
            emitting(2, 0.5, "Translate 9 0 0 ReverseOrientation Shape \"sphere\"\n") +
            emitting(3, 0.5, mesh(cube_faces()[1])) + "Shape \"disk\"\n";
        Scene before = world_of(shapes), after = world_of(shapes);
        tessellate(after, 2);
        CHECK(after.geometry.spheres.empty());
        CHECK(after.geometry.disks.empty());
        CHECK(after.geometry.triangles.size() == 4 + 2 * 512 + 2 * 32);
        for (size_t i = 0; i < 3; i++) {
            CAPTURE(i);
            double power = double{light_power(before, i)};
            CHECK(double{light_power(after, i)} == doctest::Approx(power).epsilon(1e-4).scale(0));
            // All its triangles say so, and shine where the shape did.
            const Light& light = after.lights[i];
            for (uint32_t k = 0; k < light.prims; k++) {
                uint32_t prim = light.first_prim + k;
                CHECK(after.shapes[after.geometry.triangles[prim].shape].light ==
                      static_cast<int>(i));
                auto t = corners(after, prim);
                Vec3 at = (t[0] + t[1] + t[2]) / 3, n = after.geometry.facet_normals[prim];
                for (float side : {1.0f, -1.0f}) {
                    Ray ray = {at + side * 0.1f * n, -side * n};
                    auto x = intersect(after, ray), y = intersect(before, ray);
                    REQUIRE(x);
                    REQUIRE(y);
                    CHECK(emission(after, *x) == emission(before, *y));
                    CHECK(is_black(emission(after, *x)) == (side < 0));
                }
            }
        }
    }

    TEST_CASE("truth: the ambient estimate is exact where light is even") {
        // Nothing is shot yet: what is to come is E rho / (1 - rho) everywhere.
        Room even(cube_room(0.5, 6), 12);
        Solution s;
        ch26::start(even.patches.patch, s);
        Radiosity H = ch26::ambient(even.patches.patch, s);
        CHECK(H.g == doctest::Approx(2).epsilon(1e-5).scale(0));
        CHECK(ch26::share_to_come(even.patches.patch, s) == 1);
    }
}

TEST_SUITE("ch26 radiosity") {
    TEST_CASE("furnace: a closed cube that emits 1 shows 1 / (pi (1 - rho)) in every way") {
        for (Show how : {Show::constant, Show::smooth}) {
            Scene scene = cube_room(0.5, 6);
            scene.camera.o = {0.5f, 0.4f, 0.3f};
            scene.width = scene.height = 16;
            Film film = film_of(scene, by_radiosity(scene, 48, how), 4).film;
            double truth = 2 / pi_exact;
            CHECK(film.mean() == doctest::Approx(truth).epsilon(1e-5).scale(0));
            for (Rgb L : film.image().pixels)
                CHECK(double{L.g} == doctest::Approx(truth).epsilon(1e-4).scale(0));
        }
    }

    TEST_CASE("identity: a smooth picture has no more light than its patches, and none below 0") {
        Scene scene = cube_room(0.5, 6);
        auto patches = std::make_shared<Patches>(make_patches(scene, 300, 2));
        const std::vector<Patch>& patch = patches->patch;
        for (size_t bright = 0; bright < patch.size(); bright += 7) {
            std::vector<Rgb> B(patch.size(), {0, 0.5f, 0.25f});
            B[bright] = {1, 1, 0};
            Shown shown = ch26::make_shown(scene, patches, B, Show::smooth, 2);
            Rgb all, smooth;
            for (size_t i = 0; i < patch.size(); i++) {
                all += patch[i].area * B[i];
                for (Rgb b : shown.B[i]) {
                    smooth += patch[i].area / 3 * b;
                    CHECK(std::min({b.r, b.g, b.b}) >= 0);
                }
            }
            CAPTURE(bright);
            CHECK(smooth.r < 1.05f * all.r);
            CHECK(smooth.r > 0.3f * all.r);
            CHECK(std::abs(smooth.g / all.g - 1) < 0.01f);
            CHECK(std::abs(smooth.b / all.b - 1) < 0.01f);
        }
    }

    TEST_CASE("agreement: a gray Cornell box with chapter 15, closer with more patches" *
              doctest::skip()) {
        // The same seed takes the same points of each pixel: edges cancel.
        Scene scene = scene_from("tests/pictures/references/cornell-grey.pbrt", 64, 60);
        constexpr int spp = 64;
        Film paths = film_of(scene, method_of<ch15::trace>(ch15::prepare(scene)), spp).film;
        double before = 1;
        for (size_t wanted : {size_t{80}, size_t{320}, size_t{1280}}) {
            CAPTURE(wanted);
            Film film = film_of(scene, by_radiosity(scene, wanted, Show::smooth), spp).film;
            double squares = 0;
            for (int y = 0; y < 64; y += 4)
                for (int x = 0; x < 64; x += 4) {
                    double a = block_of(film, x, y, 4).mean, b = block_of(paths, x, y, 4).mean;
                    squares += (a - b) * (a - b) / (b * b + 0.01) / 256;
                }
            CHECK(squares < 0.7 * before);
            before = squares;
            CHECK(std::abs(film.mean() / paths.mean() - 1) < (wanted > 1000 ? 0.015 : 0.04));
        }
        CHECK(before < 0.01);
    }

    TEST_CASE("truth: corners follow radiosity that rises evenly, and stop at an edge") {
        // A floor lit by a lamp above; to its right one of another colour.
        Scene scene = world_of(diffuse(0.5) + square(0, true) + "Translate 2 0 0\n" +
                               diffuse(0.25) + square(0, true) +
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
                if (p.y > 1) CHECK(b.g == doctest::Approx(9).epsilon(1e-5).scale(0));
                right += patch[i].centre.x > 1 && p.y < 1;
                if (patch[i].centre.x > 1 && p.y < 1)
                    CHECK(b.g == doctest::Approx(1).epsilon(1e-5).scale(0));
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
            CHECK(double{ch26::radiosity_at(shown, *x).g} ==
                  doctest::Approx(double{expected.g}).epsilon(1e-3).scale(0));
            CHECK(double{ch26::radiosity_at(constant, *x).g} ==
                  doctest::Approx(double{B[i].g}).epsilon(1e-5).scale(0));
        }
    }
}

TEST_SUITE("ch26 program") {
    TEST_CASE("identity: radiosity has the same bytes for 1, 2 and 7 threads" * doctest::skip()) {
        TemporaryFolder folder;
        std::string first;
        for (const char* threads : {"1", "2", "7"}) {
            Finished end = run_program_with(
                {"--quiet", "--patches", "150", "--threads", threads, "--out", folder / "a.pfm"});
            CHECK(end.code == 0);
            std::string bytes = read_file(folder / "a.pfm");
            if (first.empty()) first = bytes;
            CHECK(bytes == first);
        }
    }

    TEST_CASE("failure: patches wider than their distance to a light: too bright, and a warning" *
              doctest::skip()) {
        TemporaryFolder folder;
        for (auto [path, is_wrong] : {std::pair{"scenes/near-light.pbrt", true},
                                      {"scenes/cornell.pbrt", false},
                                      {"scenes/color-bleeding.pbrt", false}}) {
            const char* scene = path;
            CAPTURE(scene);
            Finished end = run_program_with({"--patches", "600", "--out", folder / "a.pfm"}, scene);
            CHECK(end.code == 0);
            const std::string reflect = "\nsurfaces reflect ";
            size_t at = end.out.find(reflect);
            REQUIRE(at != end.out.npos);
            at = end.out.find("\nwarning: the light that surfaces reflect is wrong: ");
            CHECK((at != end.out.npos) == is_wrong);
        }
    }

    TEST_CASE(
        "truth: a room that is 10,000 times dimmer than the one beside it has its own light") {
        TemporaryFolder folder;
        std::string dim = even_cube(1, 0.5), bright = "Translate 2 0 0\n" + even_cube(1e4, 0.5);
        Words words = {"--quiet", "--patches", "24", "--out", folder / "a.pfm"};
        CHECK(run_program_with(words, file_of(folder, dim + bright)).code == 0);
        for (Rgb L : read_image(folder / "a.pfm").pixels)
            CHECK(double{L.g} == doctest::Approx(2 / pi_exact).epsilon(2e-3).scale(0));
    }

    TEST_CASE("files: --time soon ends solution and picture, which are written") {
        TemporaryFolder folder;
        Finished end = run_program_with({"--patches", "9000", "--solver", "jacobi", "--out",
                                         folder / "a.pfm", "--time", "0.3"});
        CHECK(end.code == 0);
        CHECK(end.seconds < 4);  // of a minute and more
        CHECK(read_image(folder / "a.pfm").width == 33);
        CHECK(end.out.find("warning: sweeps ended before 100 % of the light had arrived") !=
              end.out.npos);
    }

    TEST_CASE("input: options that mean nothing to radiosity are refused") {
        for (const Words& words : {Words{"--max-depth", "3"},
                                   {"--explain", "1,1"},
                                   {"--film", "a.film"},
                                   {"--patches", "0"},
                                   {"--patches", "1000000"},
                                   {"--show", "nothing"},
                                   {"--solver", "jacobi", "--shots", "5"}}) {
            Finished end = run_program_with(words);
            CAPTURE(words[0]);
            CHECK(end.code == 2);
            CHECK(std::count(end.err.begin(), end.err.end(), '\n') == 1);
        }
    }
}

TEST_SUITE("ch26 slow") {
    TEST_CASE("agreement: paths that end at patches, with chapter 15") {
        Scene scene = scene_from("scenes/cornell.pbrt", 32, 60);
        Room room(scene, 2000);
        Shown shown = ch26::show(scene, std::make_shared<Patches>(room.patches),
                                 solved(room.G, room.patches.patch), Show::smooth, all_threads());
        LightTable lights = build_light_table(light_pmf(scene, 0.25));
        Method by_path = [&](const Scene&, Ray ray, Sampler& sampler, Recorder&) {
            std::optional<Hit> x = intersect(scene, ray);
            if (!x) return Rgb{};
            return emission(scene, *x) + ch26::by_path(scene, shown, lights, *x, -ray.d, sampler);
        };
        Film film = film_of(scene, by_path, 512, 1).film;
        Film paths = film_of(scene, method_of<ch15::trace>(ch15::prepare(scene)), 512, 1).film;
        for (int y = 0; y < 32; y += 8)
            for (int x = 0; x < 32; x += 8) {
                Measured a = block_of(film, x, y, 8), b = block_of(paths, x, y, 8);
                CHECK(z_between(a, b) < 5);
                CHECK(std::hypot(a.se, b.se) < 0.04 * b.mean);
            }
    }
}
