// Functions of chapter 01, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact, numbers::by_chance;
    auto slope = [](Vec2 x) { return double{x.x} + 3 * double{x.y} * double{x.y}; };
    return Functions{
        exact("score_dart",
              [](Draw& d) -> Values {
                  return {{"", self::score_dart(d.point())}};
              }),
        exact("RunningStats",
              [](Draw& d) -> Values {
                  self::RunningStats all;
                  double base = d.pick({0.0, 1.0, -1e6});
                  for (uint32_t part = d.below(4); part > 0; part--) {
                      self::RunningStats stats;
                      for (uint32_t n = d.below(20); n > 0; n--) stats.add(base + d.from(-1, 1));
                      all.merge(stats);
                  }
                  for (uint32_t twice = d.count(0, 40); twice > 0; twice--)
                      all.merge(self::RunningStats(all));
                  for (uint32_t n = d.below(3); n > 0; n--) all.add(base + d.from(-1, 1));
                  return {{"count()", static_cast<double>(all.count())},
                          {"mean()", all.mean()},
                          {"variance()", all.variance()},
                          {"standard_error()", all.standard_error()}};
              }),
        by_chance("throw_darts",
                  [=](Draw& d) -> Values {
                      uint64_t first = d.pick({0ull, 1ull, 1000ull, (1ull << 32) - 10});
                      uint32_t n = d.count(0, 60), seed = d.seed();
                      auto mean = [&](uint64_t from, uint32_t with) {
                          return self::throw_darts(slope, from, from + n, with).mean() - 1.5;
                      };
                      auto darts = self::throw_darts(slope, first, first + n, seed);
                      double other = mean(first + n, seed), next = mean(first, seed + 1);
                      return {{"count()", static_cast<double>(darts.count())},
                              {"mean()", darts.mean()},
                              {"variance()", darts.variance()},
                              {"mean() times that of the next darts", (darts.mean() - 1.5) * other},
                              {"mean() times that of the next seed", (darts.mean() - 1.5) * next}};
                  }),
        by_chance("measured_standard_error",
                  [=](Draw& d) -> Values {
                      uint64_t n = d.count(1, 30);
                      uint32_t runs = d.count(2, 20), seed = d.seed();
                      auto measured = [&](uint32_t with) {
                          return self::measured_standard_error(slope, n, runs, with);
                      };
                      double it = measured(seed), ideal = 1 / std::sqrt(n);
                      return {{"the result", it},
                              {"the result times that of the next seed",
                               (it - ideal) * (measured(seed + 1) - ideal)}};
                  }),
        exact("sum_in_float",
              [](Draw& d) -> Values {
                  float x = d.f(d.power(1e-3, 1e3));
                  return {{"", double{self::sum_in_float(x, d.count(0, 10000))}}};
              }),
        exact("score_board",
              [](Draw& d) -> Values {
                  return {{"", self::score_board(d.point(-1.3, 1.3))}};
              }),
        by_chance("sample_hit",
                  [](Draw& d) -> Values {
                      Vec2 x = self::sample_hit(d.point());
                      return {{"x", double{x.x}}, {"y", double{x.y}}, {"xy", double{x.x * x.y}}};
                  }),
        exact("pdf_hit",
              [](Draw& d) -> Values {
                  return {{"", self::pdf_hit(d.point(-2, 2))}};
              }),
        exact("invert_hit",
              [](Draw& d) -> Values {
                  Vec2 x = d.point(-1.5, 1.5), y = self::sample_hit(self::invert_hit(x));
                  return {{"x of sample_hit of it", std::round(double{y.x - x.x} * 1e3)},
                          {"y of sample_hit of it", std::round(double{y.y - x.y} * 1e3)}};
              }),
        exact("expected_score",
              [](Draw&) -> Values {
                  return {{"", self::expected_score()}};
              }),
    };
}
