#include "common/geometry/motion.h"

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

/// source  Shepperd 1978: from the largest of the four, so that none is divided by a small one
Quaternion quaternion_of(const Transform& r) {
    double xx = r.x[0], yy = r.y[1], zz = r.z[2], w2 = 1 + xx + yy + zz;
    if (w2 >= 1) {
        double s = 2 * std::sqrt(w2);
        return {s / 4, {(r.y[2] - r.z[1]) / s, (r.z[0] - r.x[2]) / s, (r.x[1] - r.y[0]) / s}};
    }
    if (xx >= yy && xx >= zz) {
        double s = 2 * std::sqrt(1 + xx - yy - zz);
        return {(r.y[2] - r.z[1]) / s, {s / 4, (r.x[1] + r.y[0]) / s, (r.z[0] + r.x[2]) / s}};
    }
    if (yy >= zz) {
        double s = 2 * std::sqrt(1 - xx + yy - zz);
        return {(r.z[0] - r.x[2]) / s, {(r.x[1] + r.y[0]) / s, s / 4, (r.y[2] + r.z[1]) / s}};
    }
    double s = 2 * std::sqrt(1 - xx - yy + zz);
    return {(r.x[1] - r.y[0]) / s, {(r.z[0] + r.x[2]) / s, (r.y[2] + r.z[1]) / s, s / 4}};
}

double dot(const Quaternion& a, const Quaternion& b) { return a.w * b.w + ::dot(a.v, b.v); }

/// The way along the arc from a to b.
Quaternion between(const Quaternion& a, const Quaternion& b, double t) {
    double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
    if (angle < 1e-9) return a;
    double s = std::sin((1 - t) * angle) / std::sin(angle),
           u = std::sin(t * angle) / std::sin(angle);
    return {s * a.w + u * b.w, s * a.v + u * b.v};
}

Transform rotation(const Quaternion& q) {
    auto turn = [&](Vec3d p) {
        Vec3d c = 2.0 * cross(q.v, p);
        return p + q.w * c + cross(q.v, c);
    };
    return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})};
}

}  // namespace

Motion::Motion(const Transform& start, const Transform& end) {
    for (int i = 0; i < 2; i++) {
        const Transform& m = i == 0 ? start : end;
        Transform r = rotation_of(m);
        moved_[i] = m.o;
        turned_[i] = quaternion_of(r);
        stretched_[i] = inverse(r) * m;
        stretched_[i].o = {0, 0, 0};
    }
    if (dot(turned_[0], turned_[1]) < 0) {  // the shorter way round
        turned_[1] = {-turned_[1].w, -1 * turned_[1].v};
    }
    turns_ = dot(turned_[0], turned_[1]) < 1 - 1e-12;
}

Transform Motion::at(double time) const {
    double t = std::clamp(time, 0.0, 1.0);
    auto mix = [&](Vec3d a, Vec3d b) { return (1 - t) * a + t * b; };
    Transform stretch = {mix(stretched_[0].x, stretched_[1].x),
                         mix(stretched_[0].y, stretched_[1].y),
                         mix(stretched_[0].z, stretched_[1].z)};
    Transform m = rotation(between(turned_[0], turned_[1], t)) * stretch;
    m.o = mix(moved_[0], moved_[1]);
    return m;
}
