#include "common/scene/mover.h"

#include <algorithm>

namespace {

/// The 3 x 3 part of a + s b.
Transform add(const Transform& a, double s, const Transform& b) {
    return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

/// The inverse of the transpose, without the origin: normals go by it.
Transform inverse_transpose(const Transform& t) {
    double det = determinant(t);
    return {1 / det * cross(t.y, t.z), 1 / det * cross(t.z, t.x), 1 / det * cross(t.x, t.y)};
}

/// The rotation in M = R S, R S symmetric: the mean of M and its inverse transpose, until it stays.
Transform rotation_of(Transform m) {
    m.o = {0, 0, 0};
    if (determinant(m) < 0) m = {-1 * m.x, -1 * m.y, -1 * m.z};  // the mirroring is left to S
    for (int i = 0; i < 100; i++) {
        Transform next = add(m, 1, inverse_transpose(m));
        next = {0.5 * next.x, 0.5 * next.y, 0.5 * next.z};
        Transform step = add(next, -1, m);
        m = next;
        if (length(step.x) + length(step.y) + length(step.z) < 1e-14) break;
    }
    return m;
}

/// An axis of a rotation, of any length, seen against which it turns counter-clockwise.
///
///   R = cos I + (1 - cos) a a^T + sin [a],    [a] v = a x v
///
/// Where it turns by more than a quarter, the sine may be next to 0: then from R + R^T.
Vec3d axis_of(const Transform& r, double cos) {
    Vec3d sine = {r.y[2] - r.z[1], r.z[0] - r.x[2], r.x[1] - r.y[0]};
    if (cos > 0) return sine;
    Transform both = add(r, 1, inverse(r));
    Vec3d columns[] = {both.x - Vec3d{2 * cos, 0, 0}, both.y - Vec3d{0, 2 * cos, 0},
                       both.z - Vec3d{0, 0, 2 * cos}};
    Vec3d a = *std::max_element(columns, columns + 3,
                                [](Vec3d u, Vec3d v) { return length(u) < length(v); });
    return dot(a, sine) < 0 ? -1 * a : a;
}

}  // namespace

Motion::Motion(const Transform& start, const Transform& end) {
    Transform turned[2];
    for (int i = 0; i < 2; i++) {
        const Transform& m = i == 0 ? start : end;
        turned[i] = rotation_of(m);
        moved_[i] = m.o;
        stretched_[i] = inverse(turned[i]) * m;
        stretched_[i].o = {0, 0, 0};
    }
    turned_ = turned[0];
    Transform turn = turned[1] * inverse(turned_);
    double cos = std::clamp((turn.x[0] + turn.y[1] + turn.z[2] - 1) / 2, -1.0, 1.0);
    if (cos > 1 - 4e-12) return;  // by rounding
    axis_ = axis_of(turn, cos);
    degrees_ = 180 / std::numbers::pi * std::acos(cos);
}

Transform Motion::at(double time) const {
    double t = std::clamp(time, 0.0, 1.0);
    auto mix = [&](Vec3d a, Vec3d b) { return (1 - t) * a + t * b; };
    Transform stretch = {mix(stretched_[0].x, stretched_[1].x),
                         mix(stretched_[0].y, stretched_[1].y),
                         mix(stretched_[0].z, stretched_[1].z)};
    Transform m = rotation(t * degrees_, axis_) * turned_ * stretch;
    m.o = mix(moved_[0], moved_[1]);
    return m;
}

Box box_over_time(const Mover& mover) {
    // Where the corners of its box come to: along straight lines, or somewhere on a sphere, since
    // turning keeps a point at its distance from the object's origin, which goes straight.
    Box box = bounds_of(mover.geometry), over_time;
    Vec3d origins[] = {mover.motion.at(0).o, mover.motion.at(1).o};
    for (int corner = 0; corner < 8; corner++) {
        Vec3d p =
            Vec3d(Vec3{corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                       corner & 4 ? box.low.z : box.high.z});
        for (int end = 0; end < 2; end++) {
            Vec3d moved = transform_point(mover.world_from_start(end), p);
            over_time.add(to_vec3(moved));
            if (!mover.motion.turns()) continue;
            float r = static_cast<float>(length(moved - origins[end]));
            for (Vec3d o : origins) over_time.add(box_of_ball(to_vec3(o), r));
        }
    }
    const auto& [low, high] = over_time;
    Vec3 slack = 1e-5f * (high - low) + 1e-6f * max(abs(high), abs(low));
    return {low - slack, high + slack};
}
