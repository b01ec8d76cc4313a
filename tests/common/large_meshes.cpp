// Meshes that are large enough for what the builder of the hierarchy does only with many triangles.
#include "common/geometry/bvh_build.h"
#include "common/geometry/shapes.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

TEST_SUITE("large meshes") {
    TEST_CASE("brute: a hundred thousand triangles are hit as the linear scan hits them") {
        Geometry ball;
        add_bumpy_ball(ball, {3, -2, 5}, 2, 320);
        REQUIRE(ball.triangles.size() > 100000);
        Sampler random = random_numbers(4);
        for (int threads : {1, 2}) {
            Bvh bvh = build_bvh(ball, threads);
            for (int i = 0; i < 100; i++) {
                Ray ray = {Vec3{3, -2, 5} + 5 * uniform_direction(random.u2()), {}};
                ray.d = normalize(Vec3{3, -2, 5} + uniform_direction(random.u2()) - ray.o);
                PrimHit truth = linear_scan(ball, ray), found = closest_hit(bvh, ball, ray);
                CHECK(truth.prim != PrimHit::none);
                CHECK(found.prim == truth.prim);
                CHECK(any_hit(bvh, ball, ray));
            }
        }
    }
}
