// Functions of chapter 01, for numbers.h.
inline numbers::Functions functions() {
    using numbers::point_in, numbers::Draw, numbers::Values, numbers::exact, numbers::by_chance,
        numbers::point, numbers::count, numbers::power;
    auto slope = [](Vec2 x) { return double{x.x} + 3 * double{x.y} * double{x.y} - 1.5; };
    return {
        exact("score_dart", self::score_dart, point),
        exact("RunningStats",
              [](Draw& d) {
                  self::RunningStats all;
                  double base = d.pick({0.0, 1.0, -1e6});
                  auto some = [&](uint32_t most) {
                      self::RunningStats stats;
                      double place = base + d.from(-1, 1);
                      for (uint32_t n = d.below(most); n > 0; n--) stats.add(place + d.from(-1, 1));
                      return stats;
                  };
                  for (uint32_t part = d.below(4); part > 0; part--) {
                      self::RunningStats stats = some(20);
                      for (uint32_t twice = d.pick({0u, 3u, 33u}); twice > 0; twice--)
                          stats.merge(self::RunningStats(stats));
                      all.merge(stats);
                  }
                  all.merge(some(3));
                  return Values{{"count()", double(all.count())},
                                {"mean()", all.mean()},
                                {"variance()", all.variance()},
                                {"standard_error()", all.standard_error()}};
              }),
        by_chance("throw_darts",
                  [=](Draw& d) {
                      uint64_t first = d.pick({0ull, 1ull, 1000ull, (1ull << 32) - 10});
                      uint32_t n = d.count(0, 60), seed = d.seed();
                      auto darts = self::throw_darts(slope, first, first + n, seed);
                      auto after = self::throw_darts(slope, first + n, first + 2 * n, seed);
                      auto other = self::throw_darts(slope, first, first + n, seed + 1);
                      return Values{{"count()", double(darts.count())},
                                    {"mean()", darts.mean()},
                                    {"variance()", darts.variance()},
                                    {"mean() by that of later darts", darts.mean() * after.mean()},
                                    {"mean() by the next seed's", darts.mean() * other.mean()}};
                  }),
        by_chance(
            "measured_standard_error",
            [=](Draw& d) {
                uint32_t n = d.count(1, 30), runs = d.count(2, 20), seed = d.seed();
                double less = 1 / std::sqrt(n);
                double it = self::measured_standard_error(slope, n, runs, seed) - less,
                       next = self::measured_standard_error(slope, n, runs, seed + 1) - less;
                return Values{{"the result", it}, {"the result by the next seed's", it * next}};
            }),
        exact("sum_in_float", self::sum_in_float, power(1e-3, 1e3), count(0, 10000)),
        exact("score_board", self::score_board, point_in(-1.3, 1.3)),
        by_chance("sample_hit", [](Draw& d) { return self::sample_hit(d.point()); }),
        exact("pdf_hit", self::pdf_hit, point_in(-2, 2)),
        exact("sample_hit of invert_hit",
              [](Draw& d) {
                  Vec2 x = d.point(-1.5, 1.5), y = self::sample_hit(self::invert_hit(x));
                  return Vec2{std::round((y.x - x.x) * 1e3f), std::round((y.y - x.y) * 1e3f)};
              }),
        exact("expected_score", [](Draw&) { return self::expected_score(); }),
    };
}
