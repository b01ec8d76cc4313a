// Functions of chapter 06, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact;
    auto box_values = [](const Box& b) {
        return Values{{"low.x", b.low.x},   {"low.y", b.low.y},   {"low.z", b.low.z},
                      {"high.x", b.high.x}, {"high.y", b.high.y}, {"high.z", b.high.z}};
    };
    auto box = [](Draw& d) {
        Box b;
        b.add(d.vector());
        b.add(d.vector());
        return b;
    };
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
    auto items_of = [](const Geometry& g) {
        std::vector<self::Item> items;
        for (uint32_t prim = 0; prim < g.size(); prim++) {
            Box b = box_of(g, prim);
            items.push_back({b, b.centre(), prim});
        }
        return items;
    };
    auto ray = [](Draw& d) {
        Ray r = {d.vector(-2, 2), {}};
        r.d = d.vector() - r.o;
        if (d.below(5) == 0) r.d = d.pick({Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}});
        if (d.below(4) == 0) r.t_max = d.f(d.power(0.1, 2));
        return r;
    };
    // What splitting all of the items makes: the work below, and how many are on the left.
    auto split = [=](auto by) {
        return [=](Draw& d) -> Values {
            std::vector<self::Item> items = items_of(clutter(d, 100));
            size_t begin = d.below(3) == 0 ? d.below(static_cast<uint32_t>(items.size())) : 0;
            size_t middle = by(items, begin, items.size());
            Box left, right;
            double numbers = 0;
            for (size_t i = 0; i < items.size(); i++) {
                if (i >= begin) (i < middle ? left : right).add(items[i].box);
                numbers += items[i].prim;
            }
            double n_left = double(middle - begin), n_right = double(items.size() - middle);
            return {{"how many go to the left", n_left},
                    {"area times number, of both sides",
                     double{left.area()} * n_left + double{right.area()} * n_right},
                    {"the sum of all items' numbers", numbers}};
        };
    };
    auto walked = [](const PrimHit& hit, const self::Work& work) {
        bool found = hit.prim != PrimHit::none;
        return Values{{"the primitive", found ? double(hit.prim) : -1},
                      {"t", found ? hit.t : 0},
                      {"b1", found ? hit.b1 : 0},
                      {"nodes", double(work.nodes)},
                      {"boxes", double(work.boxes)},
                      {"prims", double(work.prims)}};
    };
    Functions all = {
        exact("enter",
              [=](Draw& d) -> Values {
                  Box b = box(d);
                  Ray r = ray(d);
                  return {{"", self::enter(b, r, {1 / r.d.x, 1 / r.d.y, 1 / r.d.z})}};
              }),
        exact("box_of_centres",
              [=](Draw& d) {
                  auto items = items_of(clutter(d, 20));
                  size_t end = 1 + d.below(static_cast<uint32_t>(items.size()));
                  return box_values(self::box_of_centres(items, d.below(uint32_t(end)), end));
              }),
        exact("split_median", split(self::split_median), 1e-3),
        exact(
            "bin_of",
            [=](Draw& d) -> Values {
                Box b = box(d);
                self::Item item;
                for (int axis = 0; axis < 3; axis++)
                    item.centre[axis] = b.low[axis] + d.f(d.unit()) * (b.high[axis] - b.low[axis]);
                return {{"", double(self::bin_of(item, b, int(d.below(3))))}};
            },
            1e-4, 0.01),
        exact(
            "best_cut",
            [=](Draw& d) -> Values {
                auto items = items_of(clutter(d, 60));
                Box all, centres = self::box_of_centres(items, 0, items.size());
                for (const auto& item : items) all.add(item.box);
                auto cut =
                    self::best_cut(items, 0, items.size(), all.area(), centres, int(d.below(3)));
                return {{"cost", cut.cost}, {"bin", double(cut.bin)}};
            },
            1e-3, 0.01),
        exact("split_sah", split(self::split_sah), 1e-3, 0.01),
        exact(
            "build and sah_cost",
            [=](Draw& d) -> Values {
                auto h = self::build(clutter(d, 60),
                                     d.below(2) == 0 ? self::split_sah : self::split_median);
                return {{"nodes", double(h.nodes.size())}, {"sah_cost", self::sah_cost(h)}};
            },
            0.01, 0.01),
        exact(
            "collapse",
            [=](Draw& d) -> Values {
                auto four = self::collapse(self::build(clutter(d, 60), self::split_sah));
                double size = 0, area = 0;
                for (const auto& node : four.nodes) {
                    size += double(node.size);
                    for (size_t i = 0; i < node.size; i++) area += double{node.child[i].box.area()};
                }
                return {{"nodes", double(four.nodes.size())},
                        {"children", size},
                        {"the area of all boxes", area}};
            },
            0.01, 0.01),
    };
    for (auto step : {self::Step::linear, self::Step::median, self::Step::sah, self::Step::ordered,
                      self::Step::four}) {
        all.push_back(exact(
            "find, " + self::step_names[static_cast<size_t>(step)],
            [=](Draw& d) {
                Scene scene;
                scene.geometry = clutter(d, 60);
                auto finder = self::make_finder(scene, step);
                self::Work work;
                PrimHit hit = self::find(finder, scene.geometry, ray(d), work);
                return walked(hit, work);
            },
            0.01, 0.01));
    }
    return all;
}
