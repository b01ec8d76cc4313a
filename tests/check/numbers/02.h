// Functions of chapter 02, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact, numbers::by_chance,
        numbers::of_sets;
    Functions all = {
        by_chance("random_pair",
                  [](Draw& d) -> Values {
                      uint32_t seed = d.seed(), i = d.count(0, 1u << 30);
                      auto x = [](Vec2 u) { return double{u.x} - 0.5; };
                      auto y = [](Vec2 u) { return double{u.y} - 0.5; };
                      Vec2 u = self::random_pair(seed, i), next = self::random_pair(seed, i + 1),
                           other = self::random_pair(seed + 1, i);
                      return {{"x", x(u)},
                              {"y", y(u)},
                              {"xy", x(u) * y(u)},
                              {"x times that of the next pair", x(u) * x(next)},
                              {"y times x of the next pair", y(u) * x(next)},
                              {"x times that of the next seed", x(u) * x(other)},
                              {"y times that of the next seed", y(u) * y(other)}};
                  }),
        by_chance("jitter_in_stratum",
                  [](Draw& d) -> Values {
                      uint32_t n = d.count(1, 1u << 26), i = d.below(n);
                      Vec2 x = self::jitter_in_stratum(i, n, d.point());
                      return {{"x", double{x.x}},
                              {"y", double{x.y}},
                              {"xy", double{x.x * x.y}},
                              {"1 where it is outside of the square",
                               x.x < 0 || x.x >= 1 || x.y < 0 || x.y >= 1 ? 1.0 : 0.0}};
                  }),
        exact("jitter_in_stratum, all of n in the middle",
              [](Draw& d) -> Values {
                  uint32_t n = d.count(1, 300);
                  double distance = 0, both = 0;
                  for (uint32_t i = 0; i < n; i++) {
                      Vec2 x = self::jitter_in_stratum(i, n, {0.5f, 0.5f});
                      both += double{x.x * x.x} * double{x.y * x.y};
                      distance += std::hypot(double{x.x} - 0.5, double{x.y} - 0.5);
                  }
                  return {{"the mean square of xy", both / n},
                          {"the mean distance from the centre", distance / n}};
              }),
        exact("below_1",
              [](Draw& d) -> Values {
                  double x = d.pick({d.unit(), 1.0, 1.5, 1 - 0x1p-24});
                  return {{"", 1e6 * (1 - double{self::below_1(d.f(x))})}};
              }),
        exact("jitter_in_interval",
              [](Draw& d) -> Values {
                  uint32_t n = d.count(1, 1u << 20), i = d.below(n);
                  return {{"", double{self::jitter_in_interval(i, n, d.f(d.unit()))}}};
              }),
        exact("jitter_rook, all of n in the middle",
              [](Draw& d) -> Values {
                  uint32_t n = d.count(1, 100), seed = d.seed();
                  double x = 0, y = 0;
                  for (uint32_t i = 0; i < n; i++) {
                      Vec2 p = self::jitter_rook(i, n, seed, {0.5f, 0.5f});
                      x += double{p.x * p.x * p.x}, y += double{p.y * p.y * p.y};
                  }
                  return {{"the mean of x^3", x / n}, {"the mean of y^3", y / n}};
              }),
        by_chance("jitter_rook",
                  [](Draw& d) -> Values {
                      uint32_t n = d.count(2, 1u << 20), i = d.below(n - 1), seed = d.seed();
                      auto at = [&](uint32_t k, uint32_t with) {
                          Vec2 p = self::jitter_rook(k, n, with, {0.5f, 0.5f});
                          return Vec2{p.x - 0.5f, p.y - 0.5f};
                      };
                      Vec2 p = at(i, seed);
                      return {{"xy", double{p.x * p.y}},
                              {"y times that of the next point", double{p.y * at(i + 1, seed).y}},
                              {"y times that of the next seed", double{p.y * at(i, seed + 1).y}}};
                  }),
        exact("estimate",
              [](Draw& d) -> Values {
                  self::Points points = d.points(20);
                  return {{"", self::estimate(points, [](Vec2 x) { return double{x.x - x.y}; })}};
              }),
        exact("quarter_circle",
              [](Draw& d) -> Values {
                  return {{"", self::quarter_circle(d.point())}};
              }),
        exact("product",
              [](Draw& d) -> Values {
                  return {{"", self::product(d.point())}};
              }),
        exact("sees_light",
              [](Draw& d) -> Values {
                  Vec2 u = d.point();
                  return {{"", self::sees_light(u, d.from(-0.2, 1.6))}};
              }),
        exact("fraction_seen",
              [](Draw& d) -> Values {
                  return {{"", self::fraction_seen(d.from(-0.5, 2))}};
              }),
    };
    for (auto [set, name] : {std::pair{self::PointSet::uniform, "make_points, uniform"},
                             {self::PointSet::jittered, "make_points, jittered"},
                             {self::PointSet::rooks, "make_points, rooks"}}) {
        auto make = [set](uint32_t n, uint32_t seed) { return self::make_points(set, n, seed); };
        all.push_back(by_chance(name, [make](Draw& d) { return of_sets(d, 40, make); }));
    }
    return all;
}
