#include "common/geometry/geometry.h"

Box bounds_of(const Geometry& g) {
    Box box;
    auto add = [&](Vec3 p, float r) {
        box.low = min(box.low, p - Vec3{r, r, r}), box.high = max(box.high, p + Vec3{r, r, r});
    };
    for (Vec3 p : g.positions) add(p, 0);
    for (const Sphere& s : g.spheres) add(s.c, s.r);
    for (const Disk& d : g.disks) add(d.c, d.r);
    return box;
}
