// Laws that hold for any motion of any shape.
#include <doctest/doctest.h>

#include "common/scene/intersect.h"
#include "common/scene/mover.h"
#include "tests/support/estimators.h"

namespace {

Vec3d any_direction(Sampler& random) { return Vec3d(uniform_direction(random.u2())); }
Transform any_rotation(Sampler& random) {
    return rotation(360 * double{random.u1()}, any_direction(random));
}

/// An axis of space, or one next to it.
Vec3d any_axis(int i) {
    double next = i % 6 < 3 ? 0 : 1e-5;
    Vec3d axis = {next, next, next};
    axis[static_cast<size_t>(i % 3)] = 1;
    return axis;
}

/// The angle of a rotation, in radians: its trace is 1 + 2 cos.
double angle_of(const Transform& r) {
    return std::acos(std::clamp((r.x[0] + r.y[1] + r.z[2] - 1) / 2, -1.0, 1.0));
}

std::string as_text(const Transform& t) {
    std::string text;
    auto put = [&](double x) { text += format("%.17g ", x); };
    for (Vec3d c : {t.x, t.y, t.z}) {
        for (double x : {c.x, c.y, c.z}) put(x);
        text += "0 ";
    }
    for (double x : {t.o.x, t.o.y, t.o.z}) put(x);
    return "[" + text + "1] ";
}

/// Two triangles with a normal at each corner that leans away from their own.
const std::string bent_mesh =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-1 -1 0  1 -1 .2  1 1 "
    "0  -1 1 .3] \"normal N\" [-.2 -.1 1  .1 -.1 1  .2 .1 1  -.1 .2 1] ";

Scene moving_mesh(const Transform& start, const Transform& end) {
    return world_of(
        "LightSource \"infinite\" AttributeBegin Translate 0 0 1e5 Shape \"sphere\" "
        "AttributeEnd AttributeBegin ActiveTransform StartTime "
        "ConcatTransform " +
        as_text(start) + "ActiveTransform EndTime ConcatTransform " + as_text(end) +
        "ActiveTransform All " + bent_mesh + "AttributeEnd");
}

}  // namespace

TEST_SUITE("motion") {
    TEST_CASE("identity: a turn has one speed all the way, and takes the shorter way round") {
        Sampler random = random_numbers(7);
        for (int i = 0; i < 400; i++) {
            Transform start = i % 4 == 0 ? Transform{} : any_rotation(random);
            Transform end = any_rotation(random);
            if (i % 4 == 1) end = rotation(180, any_direction(random)) * start;
            if (i < 12) end = rotation(i < 6 ? 180 : 179.999, any_axis(i));
            if (i < 12) start = {};
            Motion motion(start, end);
            double whole = angle_of(end * inverse(start));
            CHECK(motion.turns());
            for (double t : {0.0, 0.125, 0.5, 0.75, 1.0}) {
                CAPTURE(t);
                Transform at = motion.at(t);
                CHECK(std::abs(angle_of(at * inverse(start)) - t * whole) < 1e-6);
                CHECK(std::abs(angle_of(end * inverse(at)) - (1 - t) * whole) < 1e-6);
                CHECK(std::abs(determinant(at) - 1) < 1e-9);
            }
        }
    }

    TEST_CASE("brute: a mesh with normals of its own is met as the same mesh at rest is") {
        Sampler random = random_numbers(9);
        int hits = 0, missed = 0;
        for (int i = 0; i < 12; i++) {
            CAPTURE(i);
            Vec3d stretch = {1, 0.6, i % 3 == 0 ? -1.5 : 1.5};
            Transform start = any_rotation(random) * scaling(stretch);
            Transform end = translation(any_direction(random)) * any_rotation(random) *
                            scaling({0.6, i % 2 == 0 ? 1.0 : 2.0, 1}) * start;
            Scene moving = moving_mesh(start, end);
            REQUIRE(moving.movers.size() == 1);
            double time = double{random.u1()};
            Transform now = Motion(start, end).at(time);
            // Before 0 and after 1 it rests, where the transforms have it.
            if (i < 2) time = -1, now = start;
            if (i > 9) time = 2, now = end;
            Scene still =
                world_of("LightSource \"infinite\" ConcatTransform " + as_text(now) + bent_mesh);
            for (int k = 0; k < 300; k++) {
                Vec3 o = to_vec3(4.0 * any_direction(random)), at = to_vec3(any_direction(random));
                Ray ray = {o, normalize(at - o), infinity, static_cast<float>(time)};
                std::optional<Hit> a = intersect(moving, ray), b = intersect(still, ray);
                missed += a.has_value() != b.has_value();
                if (!a || !b || a->front != b->front) continue;  // at a rim, by rounding
                // Seen edge-on, a smoothed normal is used or not: rounding decides.
                if (std::min(-dot(ray.d, a->n), -dot(ray.d, b->n)) < 0.05f) continue;
                hits++;
                CHECK(length(a->p - b->p) < 2e-5f);
                CHECK(length(a->n - b->n) < 1e-4f);
                CHECK(length(a->ng - b->ng) < 1e-4f);
                a->n = a->ng, b->n = b->ng;  // as if it looked away from this ray
                CHECK(length(smooth_normal(moving, *a) - smooth_normal(still, *b)) < 1e-4f);
                CHECK(std::abs(length(a->n) - 1) < 1e-5f);
                CHECK(std::abs(length(a->ng) - 1) < 1e-5f);
                CHECK(a->time == ray.time);
            }
        }
        CHECK(hits > 500);
        CHECK(missed < 5);
    }

    TEST_CASE("truth: a point that moves is within its stated error of the plane that moves") {
        Sampler random = random_numbers(10);
        // Near or far from the origin at the start and at the end, and a hundred times as large.
        struct {
            double start, end, size;
        } cases[] = {{1, 1, 1}, {1000, 1, 1}, {1, 1000, 1}, {30, 0, 100}};
        for (const auto& c : cases) {
            double worst = 0;
            for (int i = 0; i < 500; i++) {
                Transform start =
                    translation(c.start * any_direction(random)) * any_rotation(random);
                Transform end = translation(c.end * any_direction(random)) * any_rotation(random) *
                                scaling({c.size, c.size, 1.5 * c.size});
                Scene scene = moving_mesh(start, end);
                const Mover& mover = *scene.movers[0];
                Ray ray;
                ray.time = i % 2 == 0 ? 1 : random.u1();
                Transform now = mover.world_from_start(double{ray.time});
                Vec3 centre = to_vec3(mover.motion.at(double{ray.time}).o);
                float size = static_cast<float>(length(now.x));
                ray.o = centre + 6 * size * uniform_direction(random.u2());
                ray.d = normalize(centre + 0.5f * size * uniform_direction(random.u2()) - ray.o);
                std::optional<Hit> x = intersect(scene, ray);
                if (!x) continue;
                double nearest = 1e30;
                for (const Triangle& triangle : mover.geometry.triangles) {
                    Vec3d p[3];
                    for (size_t v = 0; v < 3; v++)
                        p[v] = transform_point(now, Vec3d(mover.geometry.positions[triangle.v[v]]));
                    Vec3d n = normalize(cross(p[1] - p[0], p[2] - p[0]));
                    nearest = std::min(nearest, std::abs(dot(n, Vec3d(x->p) - p[0])));
                }
                worst = std::max(worst, nearest / double{x->eps});
            }
            CHECK(worst < 1);
            CHECK(worst > 0.05);  // not much more careful than is needed
        }
    }
}
