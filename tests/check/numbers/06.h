// Functions of chapter 06, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact;
    auto clutter = [](Draw& d, uint32_t most) {
        Geometry g;
        uint32_t n = d.count(1, most);
        for (uint32_t i = 0; i < 3 * n; i++)
            g.positions.push_back((i % 3 == 0 ? d.vector() : g.positions.back()) +
                                  0.2f * d.vector());
        for (uint32_t i = 0; i < n; i++) g.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}, 0});
        for (uint32_t i = d.below(4); i > 0; i--)
            g.spheres.push_back({d.vector(), d.f(d.power(0.02, 1)), 0});
        for (uint32_t i = d.below(4); i > 0; i--)
            g.disks.push_back({d.vector(), d.direction(), d.f(d.power(0.02, 1)), 0});
        return g;
    };
    auto ray = [](Draw& d) {
        Ray r = {d.vector(-2, 2), {}};
        r.d = d.vector() - r.o;
        if (d.below(5) == 0) r.d = d.pick({Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}});
        if (d.below(4) == 0) r.t_max = d.f(d.power(0.1, 2));
        return r;
    };
    Functions all = {
        exact("enter",
              [=](Draw& d) {
                  Box box;
                  box.add(d.vector());
                  box.add(d.vector());
                  Ray r = ray(d);
                  return double{self::enter(box, r, {1 / r.d.x, 1 / r.d.y, 1 / r.d.z})};
              }),
        exact("collapse",
              [=](Draw& d) {
                  auto four = self::collapse(self::build(clutter(d, 60), self::split_sah));
                  double size = 0, area = 0;
                  for (const auto& node : four.nodes) {
                      size += double(node.size);
                      for (size_t i = 0; i < node.size; i++)
                          area += double{node.child[i].box.area()};
                  }
                  return Values{{"nodes", double(four.nodes.size())},
                                {"children", size},
                                {"area of boxes", area}};
              })
            .within(0.01, 0.01),
    };
    for (auto split : {self::split_median, self::split_sah}) {
        std::string name = split == self::split_median ? "split_median" : "split_sah";
        all.push_back(
            exact("build by " + name, [=](Draw& d) {
                auto h = self::build(clutter(d, 60), split);
                return Values{{"nodes", double(h.nodes.size())}, {"sah_cost", self::sah_cost(h)}};
            }).within(0.01, 0.01));
    }
    for (size_t step = 0; step < self::step_names.size(); step++) {
        all.push_back(exact("find, " + self::step_names[step], [=](Draw& d) {
                          Scene scene;
                          scene.geometry = clutter(d, 60);
                          auto finder = self::make_finder(scene, static_cast<self::Step>(step));
                          self::Work work;
                          PrimHit hit = self::find(finder, scene.geometry, ray(d), work);
                          bool found = hit.prim != PrimHit::none;
                          return Values{{"the primitive", found ? double(hit.prim) : -1},
                                        {"t", found ? hit.t : 0},
                                        {"b1", found ? hit.b1 : 0},
                                        {"nodes", double(work.nodes)},
                                        {"boxes", double(work.boxes)},
                                        {"prims", double(work.prims)}};
                      }).within(0.01, 0.01));
    }
    return all;
}
