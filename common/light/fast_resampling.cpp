#include "common/light/fast_resampling.h"

#include <cstring>
#include <limits>

#include "common/geometry/simd.h"

namespace {

LightBounds bounds_of(const Scene& scene, const LightTable& table, size_t i) {
    const Light& light = scene.lights[i];
    LightBounds b;
    b.power = average(light.L);
    b.centre = light.p;
    if (light.type == LightType::area) {
        const LightShape& shape = scene.light_shapes[i];
        b.centre = shape.centre, b.radius = shape.radius;
        b.power *= shape.area;
        if (shape.flat)
            b.n = shape.first.n, b.back = light.two_sided ? -1.0f : 1, b.least_cos_y = 0;
    } else if (light.type == LightType::distant) {
        b.has_place = 0;
    } else if (light.type == LightType::infinite) {  // all around
        b.centre = {0, 0, 1}, b.has_place = 0, b.radius = 1;
        b.power *= pi;
    }
    float pmf = table[i].pmf;
    b.inv_pmf = pmf > 1e-30f ? 1 / pmf : 0;  // never drawn, but for rounding
    return b;
}

/// Chapter 11's choice with int for size_t, for the sake of vector instructions.
inline int pick(const AliasColumn* table, int N, double u) {
    double at = u * N;
    int column = std::min(static_cast<int>(at), N - 1);
    auto [own, other, pmf] = table[column];
    return at - column < double{own} ? column : static_cast<int>(other);
}

/// The numbers of a light's bounds, each beside that of the other candidates, so that the compiler
/// makes vector instructions of what is worked out from them.
struct SideBySide {
    static constexpr size_t numbers = sizeof(LightBounds) / sizeof(float);
    static_assert(numbers == 12);
    static constexpr int size = 16;
    float of[numbers][size];

    /// The bounds of candidates i to i + 3: three times four numbers of each, turned by 90 degrees.
    void put(const LightBounds* bounds, const int* light, int i) {
        for (size_t k = 0; k < numbers; k += 4) {
            Float4 a, b, c, d;
            auto load = [&](int candidate, Float4& four) {
                const char* from = reinterpret_cast<const char*>(bounds + light[candidate]);
                std::memcpy(&four, from + k * sizeof(float), sizeof(four));
            };
            load(i, a), load(i + 1, b), load(i + 2, c), load(i + 3, d);
            Float4 ab0 = __builtin_shufflevector(a, b, 0, 4, 1, 5),
                   ab2 = __builtin_shufflevector(a, b, 2, 6, 3, 7),
                   cd0 = __builtin_shufflevector(c, d, 0, 4, 1, 5),
                   cd2 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
            Float4 turned[4] = {__builtin_shufflevector(ab0, cd0, 0, 1, 4, 5),
                                __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7),
                                __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5),
                                __builtin_shufflevector(ab2, cd2, 2, 3, 6, 7)};
            for (size_t j = 0; j < 4; j++) std::memcpy(&of[k + j][i], &turned[j], sizeof(Float4));
        }
    }

    LightBounds bounds(int i) const {
        return {{of[0][i], of[1][i], of[2][i]},
                of[3][i],
                {of[4][i], of[5][i], of[6][i]},
                of[7][i],
                of[8][i],
                of[9][i],
                of[10][i],
                of[11][i]};
    }
};

/// Chapter 12's target, as one formula for all lights, for the sake of vector instructions.
inline float target(const LightBounds& y, const Hit& x) {
    Vec3 to_y = y.centre - y.has_place * x.p;
    float d2 = std::max(dot(to_y, to_y), std::max(y.radius * y.radius, 1e-30f));
    float inv_d = 1 / std::sqrt(d2), least = y.radius * inv_d;
    float cos_x = dot(to_y, x.n) * inv_d, cos_y = -dot(to_y, y.n) * inv_d;
    cos_y = std::max(cos_y, y.back * cos_y);
    float least_y = y.least_cos_y;  // a copy: std::max of y's own number would be a branch
    float seen = ((cos_x < -1.00001f * least) | (cos_y < -least)) ? 0.0f : 1.0f;
    cos_x = std::max(cos_x, least), cos_y = std::max(cos_y, std::max(least, least_y));
    return seen * y.power * cos_x * cos_y / d2;
}

}  // namespace

ManyLights many_lights(const Scene& scene, LightTable table, int M) {
    M = std::min(M, static_cast<int>(table.size()));
    ManyLights lights{std::move(table), {}, M};
    for (size_t i = 0; i < lights.table.size(); i++)
        lights.bounds.push_back(bounds_of(scene, lights.table, i));
    return lights;
}

// The compiler turns each of these loops into vector instructions: no branches, no calls.

Candidates draw_candidates(const ManyLights& lights, const Hit& x, double u) {
    Candidates c;
    const int M = c.M = lights.M, N = static_cast<int>(lights.table.size());
    const double slice = 1.0 / M;
    const AliasColumn* table = lights.table.data();
    for (int i = 0; i < M; i++) {
        c.light[i] = pick(table, N, (i + u) * slice);
    }
    if (M <= 8) {  // not worth the turning
        for (int i = 0; i < M; i++) {
            const LightBounds& y = lights.bounds[static_cast<size_t>(c.light[i])];
            c.p_hat[i] = target(y, x);
            c.weight[i] = c.p_hat[i] * y.inv_pmf;
        }
        return c;
    }
    for (int i = M; i % SideBySide::size != 0; i++) c.light[i] = 0;
    for (int begin = 0; begin < M; begin += SideBySide::size) {
        SideBySide part;
        for (int i = 0; i < SideBySide::size; i += 4)
            part.put(lights.bounds.data(), c.light + begin, i);
        for (int i = 0; i < SideBySide::size; i++) {
            LightBounds y = part.bounds(i);
            c.p_hat[begin + i] = target(y, x);
            c.weight[begin + i] = c.p_hat[begin + i] * y.inv_pmf;
        }
    }
    return c;
}

Kept keep_one(const Candidates& c, float u) {
    float up_to[Candidates::most];
    float weight_sum = 0;
    for (int i = 0; i < c.M; i++) up_to[i] = weight_sum += c.weight[i];
    if (!(weight_sum >= std::numeric_limits<float>::min())) return {};
    float target = u * weight_sum;  // below weight_sum, as that is no subnormal
    int kept = 0;
    for (int i = 0; i < c.M; i++) kept += up_to[i] <= target ? 1 : 0;
    kept = std::min(kept, c.M - 1);  // where weight_sum is infinite, and so is the sample
    return {static_cast<size_t>(c.light[kept]),
            weight_sum / (static_cast<float>(c.M) * c.p_hat[kept])};
}
