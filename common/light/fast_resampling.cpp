#include "common/light/fast_resampling.h"

#include <limits>

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

/// Chapter 10's choice with int for size_t, for the sake of vector instructions.
inline int pick(const AliasColumn* table, int N, double u) {
    double at = u * N;
    int column = std::min(static_cast<int>(at), N - 1);
    auto [own, other, pmf] = table[column];
    return at - column < double{own} ? column : static_cast<int>(other);
}

/// Chapter 11's potential, as one formula for all lights, for the sake of vector instructions.
inline float potential(const LightBounds& y, const Hit& x) {
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
    const LightBounds* bounds = lights.bounds.data();
    for (int i = 0; i < M; i++) {
        const LightBounds& y = bounds[c.light[i]];
        c.p_hat[i] = potential(y, x);
        c.weight[i] = c.p_hat[i] * y.inv_pmf;
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
