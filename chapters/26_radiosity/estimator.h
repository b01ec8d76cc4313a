// Chapter 26: radiosity. No rays carry the light: the surfaces are cut into patches, and the light
// that each patch sends to each other is computed once. The solution belongs to the room; the
// camera comes last.
//
//   B_i = E_i + rho_i sum over j of F_ij B_j
//
// F_ij is the form factor: the share of the light leaving patch i that arrives at patch j.
//
//   F_ij = 1 / A_i  integral over i, j of  V cos_i cos_j / (pi r^2)
//
// The code keeps  G_ij = A_i F_ij = A_j F_ji,  m^2, which is the same from both ends.
#pragma once
#include "chapters/26_radiosity/rows.h"
#include "common/recording/recorder.h"

namespace ch26 {

// Step 1 of the page: form factors.

/// The formula that is often shown: G_ij, m^2, from the value of the integrand between one point x
/// of patch p and one point y of patch q.
///
///   G = A_p A_q cos_p cos_q / (pi r^2)
///
/// With the centres as points it is wrong where patches are close for their size: by 59 % for unit
/// squares at distance 1.
/// tested by  "failure: the form factor by centres is 59 % off at distance 1, ...", to 1e-6
inline double by_centres(const Patch& p, const Patch& q, Vec3 x, Vec3 y) {
    Vec3 d = y - x;
    double r2 = double{dot(d, d)}, cos = double{dot(d, p.n)} * double{-dot(d, q.n)};
    return double{p.area} * double{q.area} * cos / (std::numbers::pi * r2 * r2);
}

/// The form factor from a point x with normal n to a polygon that nothing hides.
///
///   F = 1 / (2 pi)  sum over edges of  gamma n . (b x a) / |b x a|,   a, b: x to the edge's ends,
///   gamma: the angle between them
///
/// The part of the polygon below the horizon of x is cut off; 0 for a polygon seen from behind. In
/// double: the terms of a far polygon nearly cancel.
/// source  Lambert 1760; Hottel, Sarofim 1967
/// tested by  "truth: form factors by contour of squares", within 1e-4
inline double point_to_polygon(Vec3 x, Vec3 n, std::span<const Vec3> polygon) {
    Vec3d normal = Vec3d(n), o = Vec3d(x), above[8];
    size_t count = 0;
    for (size_t i = 0; i < polygon.size(); i++) {
        Vec3d a = Vec3d(polygon[i]) - o;
        Vec3d b = Vec3d(polygon[(i + 1) % polygon.size()]) - o;
        double da = dot(a, normal), db = dot(b, normal);
        if (da >= 0) above[count++] = a;
        if (da * db < 0) above[count++] = a + da / (da - db) * (b - a);
    }
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        Vec3d a = above[i], b = above[(i + 1) % count], c = cross(b, a);
        double size = std::sqrt(dot(c, c));
        if (size > 0) sum += std::atan2(size, dot(a, b)) * dot(normal, c) / size;
    }
    return std::max(0.0, sum / (2 * std::numbers::pi));
}

/// The mean over triangle t, with normal n, of the form factor from its points to q.
///
/// Far away for both sizes: from the centre of t. Nearer: from three points, with which the mean of
/// any quadratic polynomial is exact. Nearer still: the mean over the quarters of t, and so on.
inline double mean_to_polygon(const Corners& t, Vec3 n, const Patch& q, int depth) {
    Vec3 centre = (t[0] + t[1] + t[2]) / 3;
    float size2 = longest_edge2(t) + longest_edge2(q.p), d2 = length_squared(centre - q.centre);
    if (d2 > 36 * size2) return point_to_polygon(centre, n, q.p);
    double sum = 0;
    if (depth == 0 || d2 > 2 * size2) {
        for (Vec3 p : t) sum += point_to_polygon((centre + p) / 2, n, q.p);
        return sum / 3;
    }
    for (const auto& part : quarters(t)) sum += mean_to_polygon(part, n, q, depth - 1);
    return sum / 4;
}

/// Four pairs of points: one point of each quarter of p, and one of some quarter of q.
inline std::array<std::array<Vec3, 2>, 4> pairs_of_points(const Patch& p, const Patch& q,
                                                          uint32_t key) {
    auto x = points_on(p, key), y = points_on(q, hash32(key) + 4);
    size_t shift = hash32(key + 9) % 4;  // pairs each quarter of p with any of q
    std::array<std::array<Vec3, 2>, 4> pairs;
    for (size_t i = 0; i < 4; i++) pairs[i] = {x[i], y[(i + shift) % 4]};
    return pairs;
}

/// What two patches exchange: G, m^2. It is the fraction of four rays between them that nothing
/// stops, times G without walls. The latter is computed from points of the smaller patch: the few
/// points of the larger one may all be far from the smaller. key: of the random numbers.
/// tested by  "truth: form factors by contour of squares", within 1e-4
/// tested by  "truth: a small patch and a large one at decades of size and distance", to 1e-3
inline double exchange(const Scene& scene, const Patch& p, const Patch& q, uint32_t key) {
    if (!faces(p, q) || !faces(q, p)) return 0;
    double visible = 0;
    for (auto [x, y] : pairs_of_points(p, q, key)) {
        if (!sees(scene, x, y)) continue;
        visible += 0.25;
    }
    if (visible == 0) return 0;
    constexpr int deepest = 4;
    const Patch &small = p.area <= q.area ? p : q, &large = p.area <= q.area ? q : p;
    return visible * double{small.area} * mean_to_polygon(small.p, small.n, large, deepest);
}

/// exchange() of any two of the patches.
inline ExchangeOf form_factors(const Scene& scene, const Patches& patches, uint32_t seed) {
    return [&, seed](uint32_t i, uint32_t j) {
        return exchange(scene, patches.patch[i], patches.patch[j], hash32(i, hash32(j, seed)));
    };
}

// Step 2: gathering. Each patch takes light from all others.

/// The equation.      B_i = E_i + rho_i H_i,      H_i = sum over j of F_ij B_j,  both W m^-2
inline Radiosity radiosity_of(const Patch& p, Radiosity H) { return p.E + p.rho * H; }

/// Gathers H_i from what all others send. F_ij, not F_ji: what i receives is counted from i.
inline Radiosity gather(const Matrix& G, const std::vector<Patch>& patch,
                        const std::vector<Radiosity>& H, size_t i) {
    Radiosity sum;
    for (size_t j = 0; j < G.size(); j++) sum += double{G[i][j]} * radiosity_of(patch[j], H[j]);
    return 1 / double{patch[i].area} * sum;  // F_ij = G_ij / A_i
}

/// One sweep: each patch gathers. Jacobi: what the others had before the sweep, which is one bounce
/// of light. Gauss-Seidel: what they have by now. Returns the largest change.
enum class Sweep : uint8_t { jacobi, gauss_seidel };
inline double sweep(const Matrix& G, const std::vector<Patch>& patch, Sweep kind, Solution& s) {
    std::vector<Radiosity> before = s.H;
    double change = 0;
    for (size_t i = 0; i < G.size(); i++) {
        s.H[i] = gather(G, patch, kind == Sweep::jacobi ? before : s.H, i);
        change = std::max(change, largest_of(s.H[i] - before[i]));
    }
    s.steps++;
    return change;
}

/// Sweeps until what is probably still to come is below `wanted`, a share of the largest H.
///
///   still to come ~ q / (1 - q) change,    q = this change / the one before
///
/// An estimate, since q may still grow. The change alone is too small: where each bounce keeps
/// 99 %, a hundred more like it follow.
inline void solve(const Matrix& G, const std::vector<Patch>& patch, Sweep kind, double wanted,
                  Solution& s, const Stopped& stopped = {}) {
    s.H.resize(G.size());
    double before = 0;
    for (int i = 0; i < 100000; i++) {
        double change = sweep(G, patch, kind, s), q = before > 0 ? change / before : 1, largest = 0;
        before = change;
        for (Radiosity H : s.H) largest = std::max(largest, largest_of(H));
        double to_come = q < 1 ? q / (1 - q) * change : infinity;
        if (change == 0 || to_come <= wanted * largest || (stopped && stopped())) return;
    }
}

// Step 3: shooting. The brightest patch sends its light to all others.

/// Begins progressive refinement (Southwell): all that lamps emit is unshot.
inline void start(const std::vector<Patch>& patch, Solution& s) {
    s.H.assign(patch.size(), {});
    s.unshot.clear();
    for (const Patch& p : patch) s.unshot.push_back(p.E);
}

/// Finds who shoots: the patch with most unshot power; nothing when all is shot.
inline std::optional<size_t> brightest(const std::vector<Patch>& patch, const Solution& s) {
    std::optional<size_t> found;
    double most = 0;
    for (size_t i = 0; i < patch.size(); i++) {
        double power = double{patch[i].area} * sum_of(s.unshot[i]);
        if (power > most) most = power, found = i;
    }
    return found;
}

/// Shoots what is unshot of patch i at all others.
///
///   H_j += F_ji dB_i = G_ij dB_i / A_j;      dB_j += rho_j H_j's change;      dB_i = 0
///
/// Needs one row of G, which alone is repaired: what does not leave the room arrives.
/// source  Cohen, Chen, Wallace, Greenberg 1988
/// tested by  "identity: all that lamps emit is absorbed, escapes, or is unshot", to 1e-6
inline void shoot(const Patches& patches, size_t i, std::span<const float> G_i, Solution& s) {
    const std::vector<Patch>& patch = patches.patch;
    double sum = 0, area = double{patch[i].area};
    for (float G_ij : G_i) sum += double{G_ij};
    double scale = sum > area || (patches.closed && sum > 0) ? area / sum : 1;
    Radiosity dB = s.unshot[i];
    s.unshot[i] = {};
    s.escaped += (area - scale * sum) * dB;
    for (size_t j = 0; j < patch.size(); j++) {
        if (G_i[j] == 0) continue;
        Radiosity dH = scale * double{G_i[j]} / double{patch[j].area} * dB;
        s.H[j] += dH;
        s.unshot[j] += patch[j].rho * dH;
    }
    s.steps++;
}

/// Estimates the irradiance that unshot light will bring, about the same everywhere; for display.
///
///   H = keep dB / (1 - keep rho),    dB, rho: means over all areas; keep: what stays in the room
///
/// most: a bounce keeps no more of the light, so that the sum of all bounces is finite
inline Radiosity ambient(const std::vector<Patch>& patch, const Solution& s,
                         double most = 1 - 1e-6) {
    Radiosity unshot, rho, shot, all;
    for (size_t i = 0; i < s.unshot.size(); i++) {
        double A = double{patch[i].area};
        all += Radiosity{A, A, A};
        unshot += A * s.unshot[i];
        rho += A * Radiosity(patch[i].rho);
        shot += A * (radiosity_of(patch[i], s.H[i]) - s.unshot[i]);
    }
    Radiosity keep = Radiosity{1, 1, 1} - ratio(s.escaped, shot);
    return ratio(keep * unshot, all - min(keep * rho, most * all));
}

// Step 4: the picture.

/// The radiance that arrives along the ray: that of the patch it meets.      L = B / pi
///
/// Biased: as if each patch had one radiosity, or those between its corners were in between.
/// source  Goral, Torrance, Greenberg, Battaile 1984
/// tested by  "ch26 radiosity", furnace to 1e-5, chapter 15 to 3 %
inline Rgb trace(const Scene& scene, const Shown& shown, Ray ray, Sampler&, Recorder&) {
    std::optional<Hit> x = intersect(scene, ray);
    return x ? radiosity_at(shown, *x) / pi : Rgb{};
}

}  // namespace ch26
