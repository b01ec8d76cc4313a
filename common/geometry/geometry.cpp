#include "common/geometry/geometry.h"

Box bounds_of(const Geometry& g) {
    Box box;
    auto add_ball = [&](Vec3 c, float r) {
        box.add(c - Vec3{r, r, r});
        box.add(c + Vec3{r, r, r});
    };
    for (Vec3 p : g.positions) box.add(p);
    for (const Sphere& s : g.spheres) add_ball(s.c, s.r);
    for (const Disk& d : g.disks) add_ball(d.c, d.r);
    return box;
}
