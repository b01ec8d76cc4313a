// Functions of chapter 02, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact, numbers::by_chance,
        numbers::sets, numbers::point, numbers::from, numbers::points;
    auto centred = [](Vec2 u) { return Vec2{u.x - 0.5f, u.y - 0.5f}; };
    Functions all = {
        by_chance("random_pair",
                  [=](Draw& d) {
                      uint32_t seed = d.seed(), i = d.count(0, 1u << 30);
                      Vec2 u = centred(self::random_pair(seed, i)),
                           next = centred(self::random_pair(seed, i + 1)),
                           other = centred(self::random_pair(seed + 1, i));
                      return Values{{"x", u.x},
                                    {"y", u.y},
                                    {"xy", u.x * u.y},
                                    {"x by that of the next pair", u.x * next.x},
                                    {"y by x of the next pair", u.y * next.x},
                                    {"x by the next seed's", u.x * other.x},
                                    {"y by the next seed's", u.y * other.y}};
                  }),
        by_chance(
            "jitter_in_stratum",
            [](Draw& d) {
                uint32_t n = d.count(1, 1u << 26), i = d.below(n);
                Vec2 x = self::jitter_in_stratum(i, n, d.point());
                bool outside = x.x < 0 || x.x >= 1 || x.y < 0 || x.y >= 1;
                return Values{{"x", x.x}, {"y", x.y}, {"xy", x.x * x.y}, {"outside", outside}};
            }),
        exact("jitter_in_stratum, all strata",
              [](Draw& d) {
                  uint32_t n = d.count(1, 300);
                  double distance = 0, both = 0;
                  for (uint32_t i = 0; i < n; i++) {
                      Vec2 x = self::jitter_in_stratum(i, n, {0.5f, 0.5f});
                      both += double{x.x * x.x} * double{x.y * x.y};
                      distance += std::hypot(double{x.x} - 0.5, double{x.y} - 0.5);
                  }
                  return Values{{"the mean of x^2 y^2", both / n},
                                {"the mean distance", distance / n}};
              }),
        exact(
            "1 - below_1", [](double x) { return 1e6 * (1 - double{self::below_1(float(x))}); },
            [](Draw& d) {
                return d.pick({d.unit(), 1.0, 1.5, 1 - 0x1p-24});
            }),
        exact("jitter_in_interval",
              [](Draw& d) {
                  uint32_t n = d.count(1, 1u << 20), i = d.below(n);
                  return double{self::jitter_in_interval(i, n, d.f(d.unit()))};
              }),
        exact("jitter_rook, all rooks",
              [](Draw& d) {
                  uint32_t n = d.count(1, 100), seed = d.seed();
                  Vec2 sum;
                  for (uint32_t i = 0; i < n; i++) {
                      Vec2 p = self::jitter_rook(i, n, seed, {0.5f, 0.5f});
                      sum = {sum.x + p.x * p.x * p.x, sum.y + p.y * p.y * p.y};
                  }
                  return sum;
              }),
        by_chance("jitter_rook",
                  [=](Draw& d) {
                      uint32_t n = d.count(2, 1u << 20), i = d.below(n - 1), seed = d.seed();
                      Vec2 u = d.point(), p = centred(self::jitter_rook(i, n, seed, u)),
                           next = centred(self::jitter_rook(i + 1, n, seed, u)),
                           other = centred(self::jitter_rook(i, n, seed + 1, u));
                      return Values{{"xy", p.x * p.y},
                                    {"y by that of the next point", p.y * next.y},
                                    {"y by the next seed's", p.y * other.y}};
                  }),
        exact(
            "estimate",
            [](const Points& p) {
                return self::estimate(p, [](Vec2 x) { return double{x.x - x.y}; });
            },
            points(20)),
        exact("quarter_circle", self::quarter_circle, point),
        exact("product", self::product, point),
        exact("sees_light", self::sees_light, point, from(-0.2, 1.6)),
        exact("fraction_seen", self::fraction_seen, from(-0.5, 2)),
    };
    using Set = self::PointSet;
    for (auto [set, name] :
         {std::pair{Set::uniform, "uniform"}, {Set::jittered, "jittered"}, {Set::rooks, "rooks"}})
        all.push_back(
            sets(std::string("make_points, ") + name, 40,
                 [set](uint32_t n, uint32_t seed) { return self::make_points(set, n, seed); }));
    return all;
}
