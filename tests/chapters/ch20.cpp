// Chapter 20: patches, form factors, solvers, and the picture.
#include <doctest/doctest.h>

#include "chapters/14_mis_ris/estimator.h"
#include "chapters/20_radiosity/run.h"
#include "tests/support/estimators.h"
#include "tests/support/process.h"
#include "tests/support/program.h"

namespace {

using ch20::FormFactors, ch20::Patch, ch20::Patches, ch20::Radiosity, ch20::Solution;

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
    return {quad({}, x, y), quad(z, y, x), quad({}, y, z), quad(x, z, y), quad({}, z, x),
            quad(y, x, z)};
}
/// A closed cube of this reflectance. `shining` of its faces emit 1 W m^-2.
Scene cube_room(double rho, size_t shining_faces, const std::string& more = "") {
    std::string text;
    auto faces = cube_faces();
    for (size_t f = 0; f < 6; f++) {
        text += f < shining_faces ? emitting(1, rho, mesh(faces[f])) : diffuse(rho) + mesh(faces[f]);
    }
    return world_of(text + more);
}

/// Patches alone, to be held against form factors.
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
double form_factor(const std::vector<Patch>& from, const std::vector<Patch>& to,
                   FormFactors way = FormFactors::contour, uint32_t seed = 0) {
    Scene empty = world_of("Translate 0 0 -99 " + emitting(1, 0.5, mesh(cube_faces()[0])));
    double sum = 0, area = 0;
    for (uint32_t i = 0; i < from.size(); i++) {
        area += double{from[i].area};
        for (uint32_t j = 0; j < to.size(); j++) {
            uint32_t key = hash32(i, hash32(j, seed));
            ch20::Exchange G = ch20::exchange(empty, from[i], to[j], way, key);
            sum += (G.from_p + G.from_q) / 2;
        }
    }
    return sum / area;
}

/// A regular polygon around (0, 0, z) with the area of a disk, facing up or down.
std::vector<Vec3> disk_at(double z, double r, bool up, int sides = 96) {
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

/// A sphere of 8 * 4^depth triangles, seen from outside or from inside.
std::vector<Vec3> sphere(float r, int depth, bool outside) {
    std::vector<Vec3> corners;
    auto add = [&](auto self, Vec3 a, Vec3 b, Vec3 c, int left) -> void {
        if (left == 0) {
            for (Vec3 p : outside ? std::array{a, b, c} : std::array{a, c, b})
                corners.push_back(r * p);
            return;
        }
        Vec3 d = normalize(b + c), e = normalize(c + a), f = normalize(a + b);
        self(self, a, f, e, left - 1), self(self, f, b, d, left - 1);
        self(self, e, d, c, left - 1), self(self, d, e, f, left - 1);
    };
    for (float x : {1.0f, -1.0f})
        for (float y : {1.0f, -1.0f})
            for (float z : {1.0f, -1.0f}) {
                Vec3 a = {x, 0, 0}, b = {0, y, 0}, c = {0, 0, z};
                if (x * y * z < 0) std::swap(b, c);
                add(add, a, b, c, depth);
            }
    return corners;
}

/// The room of TRUTHS' cube: six patches of area 1, the first of which emits 1.
struct SixPatches {
    ch20::Matrix G;
    std::vector<Patch> patch = std::vector<Patch>(6);

    explicit SixPatches(double rho, int emitters = 1) {
        for (size_t i = 0; i < 6; i++) {
            G.push_back(std::vector<float>(6, static_cast<float>(beside)));
            G[i][i] = 0, G[i][i ^ 1] = static_cast<float>(opposite);
            float r = static_cast<float>(rho), E = static_cast<int>(i) < emitters ? 1 : 0;
            patch[i].area = 1, patch[i].rho = {r, r, r}, patch[i].E = {E, E, E};
        }
    }
};

double B_of(const Patch& p, const Solution& s, size_t i) {
    return ch20::radiosity_of(p, s.H[i]).g;
}
const auto never = [](double) { return false; };

/// Solved to the last digits by Gauss-Seidel.
Solution solved(const ch20::Matrix& G, const std::vector<Patch>& patch) {
    Solution s;
    ch20::solve(G, patch, 1e-12, s, ch20::sweep_gauss_seidel, never);
    s.escaped = ch20::escaped_by(G, patch, s);
    return s;
}

/// A room as a matrix of its patches.
struct Room {
    Patches patches;
    ch20::Matrix G;
    ch20::Faults faults;

    Room(const Scene& scene, size_t wanted, FormFactors way = FormFactors::contour,
         bool repaired = true)
        : patches(ch20::make_patches(scene, wanted, all_threads())) {
        ch20::Rows rows(scene, patches, way, 0, all_threads());
        G = ch20::make_matrix(rows, patches.patch.size());
        faults = rows.faults();
        if (repaired) ch20::repair(G, patches.patch, patches.closed);
    }
    double row_sum(size_t i) const {
        double sum = 0;
        for (float g : G[i]) sum += double{g};
        return sum / double{patches.patch[i].area};
    }
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
Trace by_radiosity(const Scene& scene, size_t wanted, ch20::Show how) {
    Room room(scene, wanted);
    Solution s = solved(room.G, room.patches.patch);
    auto patches = std::make_shared<Patches>(room.patches);
    return trace_with<ch20::trace>(ch20::show(scene, patches, s, how, all_threads()));
}

}  // namespace

TEST_SUITE("ch20 form factors") {
    TEST_CASE("truth: form factors by contour of squares and disks") {
        Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
        auto floor = patches_of(quad({}, x, y));
        for (auto [d, F] : {std::pair{0.1, 0.8269945223973}, {0.5, 0.4152532835771},
                            {1.0, opposite}, {2.0, 0.06858958881855}, {5.0, 0.01240397731325},
                            {10.0, 0.003162056838758}}) {
            CAPTURE(d);
            auto above = patches_of(quad(static_cast<float>(d) * z, y, x));
            MESSAGE((form_factor(floor, above) - F));
            CHECK(std::abs(form_factor(floor, above) - F) < 1e-4);
        }
        auto wall = patches_of(quad({}, y, z));
        MESSAGE((form_factor(floor, wall) - beside));
        CHECK(std::abs(form_factor(floor, wall) - beside) < 1e-4);
        auto wide = patches_of(quad({}, x, 2 * y)), tall = patches_of(quad({}, 2 * y, z));
        MESSAGE((form_factor(wide, tall) - 0.240636006177));
        for (auto [r1, r2, h, F] : {std::array{1.0, 1.0, 1.0, 0.3819660112501},
                                    {1, 1, 2, 0.1715728752538},
                                    {1, 2, 1, 0.7639320225002},
                                    {2, 1, 1, 0.1909830056251},
                                    {1, 1, 0.1, 0.9048750780275}}) {
            CAPTURE(r1);
            CAPTURE(h);
            auto low = patches_of(disk_at(0, r1, true)), high = patches_of(disk_at(h, r2, false));
            MESSAGE((form_factor(low, high) - F));
            CHECK(std::abs(form_factor(low, high) - F) < 1e-4);
        }
    }

    TEST_CASE("truth: a square beside a square by 6 x 6 Gauss points, and boxes close") {
        constexpr double at[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
        constexpr double weight[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
        std::array<Vec3, 4> wall = {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}};
        double F = 0;
        for (int i = -3; i < 3; i++)
            for (int j = -3; j < 3; j++) {
                size_t a = static_cast<size_t>(i < 0 ? -i - 1 : i);
                size_t b = static_cast<size_t>(j < 0 ? -j - 1 : j);
                Vec3 p = {static_cast<float>((1 + (i < 0 ? -at[a] : at[a])) / 2),
                          static_cast<float>((1 + (j < 0 ? -at[b] : at[b])) / 2), 0};
                F += weight[a] * weight[b] / 4 * ch20::point_to_polygon(p, {0, 0, 1}, wall);
            }
        MESSAGE((F - beside));
        CHECK(opposite + 4 * beside == doctest::Approx(1).epsilon(1e-12).scale(0));
    }
}
