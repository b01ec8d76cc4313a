// Functions of chapter 03, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact, numbers::by_chance,
        numbers::of_sets;
    auto pair = [](Vec2 p) { return Values{{"x", double{p.x}}, {"y", double{p.y}}}; };
    auto top_bits = [](uint32_t x, int n) { return static_cast<double>(x >> (32 - n)); };
    Functions all = {
        exact("torus_difference",
              [=](Draw& d) {
                  Vec2 a = d.point();
                  return pair(self::torus_difference(a, d.point()));
              }),
        exact("wrap", [=](Draw& d) { return pair(self::wrap(d.point(-2, 3))); }),
        exact("hexagonal_distance",
              [](Draw& d) -> Values {
                  return {{"", double{self::hexagonal_distance(d.count(1, 1000000))}}};
              }),
        exact("repulsion",
              [=](Draw& d) {
                  Points points = d.points(20);
                  Vec2 p = d.point(0, 1);
                  return pair(self::repulsion(points, p, d.f(d.power(0.01, 0.5))));
              }),
        exact("radical_inverse",
              [](Draw& d) -> Values {
                  uint32_t base = d.pick({2u, 3u, 5u, 7u, 17u, 19u});
                  return {{"", double{self::radical_inverse(base, d.count(0, 1u << 31))}}};
              }),
        by_chance("radical_inverse, scrambled",
                  [](Draw& d) -> Values {
                      uint32_t base = d.pick({2u, 3u, 5u, 7u, 17u, 19u}), seed = d.seed() + 3;
                      uint32_t i = d.count(0, 1u << 30), place = d.count(1, 1000);
                      auto at = [&](uint32_t k, uint32_t with) {
                          return double{self::radical_inverse(base, k, with)} - 0.5;
                      };
                      double x = at(i, seed);
                      return {{"x - 0.5", x},
                              {"that times that of the next number", x * at(i + 1, seed)},
                              {"that times that of a later number", x * at(i + place * base, seed)},
                              {"that times that of the next seed", x * at(i, seed + 1)}};
                  }),
        exact("sobol_second",
              [=](Draw& d) -> Values {
                  uint32_t x = self::sobol_second(d.count(0, ~0u));
                  return {{"the higher half", top_bits(x, 16)},
                          {"the lower half", top_bits(x << 16, 16)}};
              }),
        by_chance("owen_scramble",
                  [=](Draw& d) -> Values {
                      uint32_t x = d.seed(), seed = d.seed();
                      int bit = static_cast<int>(d.below(32));
                      uint32_t y = self::owen_scramble(x, seed),
                               z = self::owen_scramble(x ^ (1u << bit), seed);
                      int above = 31 - bit;  // bits that both have in common
                      double common = above == 0 ? 0 : top_bits(y ^ z, above);
                      double half = top_bits(y, 24) * 0x1p-24 - 0.5;
                      return {{"the fraction - 0.5", half},
                              {"bits that differ above the first that does", common},
                              {"whether that bit differs", double((y ^ z) >> bit & 1)},
                              {"1 where the next bit does", bit ? (y ^ z) >> (bit - 1) & 1 : 0.5},
                              {"the fraction - 0.5 times that of the next seed",
                               half * (self::owen_scramble(x, seed + 1) * 0x1p-32 - 0.5)}};
                  }),
        by_chance("shuffled",
                  [](Draw& d) -> Values {
                      Points points(d.count(1, 30));
                      for (size_t i = 0; i < points.size(); i++)
                          points[i] = {static_cast<float>(i), static_cast<float>(i * i)};
                      uint32_t seed = d.seed();
                      Points mixed = self::shuffled(points, seed);
                      Points next = self::shuffled(points, seed + 1);
                      double n = static_cast<double>(points.size()), sum = 0, stays = 0, alike = 0;
                      for (size_t i = 0; i < mixed.size(); i++) {
                          sum += double{mixed[i].x * mixed[i].y};
                          stays += mixed[i].x == points[i].x;
                          alike += mixed[i].x == next[i].x;
                      }
                      return {{"the size", static_cast<double>(mixed.size())},
                              {"the sum of xy", sum / (n * n * n * n)},
                              {"how many stay", stays},
                              {"how many are those of the next seed", alike},
                              {"the first", double{mixed.at(0).x} / n},
                              {"the last", double{mixed.back().x} / n}};
                  }),
        exact("estimate_4d",
              [](Draw& d) -> Values {
                  Points xy = d.points(10), zw = d.points(10);
                  auto f = [](Vec2 a, Vec2 b) { return double{a.x * b.y + a.y * a.y * b.x}; };
                  return {{"", self::estimate_4d(xy, zw, f)}};
              }),
    };
    for (auto rim : {self::Rim::torus, self::Rim::open}) {
        auto make = [rim](uint32_t n, uint32_t seed) {
            float r = n == 1 ? 0 : 0.8f / std::sqrt(static_cast<float>(n));
            return self::poisson_disc_points(r, 3 * n, seed, rim);
        };
        all.push_back(by_chance(
            rim == self::Rim::torus ? "poisson_disc_points" : "poisson_disc_points, open",
            [make](Draw& d) { return of_sets(d, 60, make); }, 1000));
    }
    for (uint32_t dimensions : {0u, 1u}) {
        auto make = [=](uint32_t n, uint32_t seed) {
            return self::halton_points(dimensions, n, seed);
        };
        all.push_back(by_chance("halton_points", [make](Draw& d) { return of_sets(d, 60, make); }));
    }
    all.push_back(
        by_chance("sobol_points", [](Draw& d) { return of_sets(d, 60, self::sobol_points); }));
    using Set = self::PointSet;
    for (auto [set, name] : {std::pair{Set::uniform, "uniform"},
                             {Set::jittered, "jittered"},
                             {Set::poisson, "poisson"},
                             {Set::repelled, "repelled"},
                             {Set::halton, "halton"},
                             {Set::sobol, "sobol"}}) {
        uint32_t most = set == Set::repelled ? 10 : 30, draws = set == Set::repelled ? 100 : 500;
        std::string kind = name;
        auto make = [set](uint32_t n, uint32_t seed) { return self::make_points(set, n, seed); };
        all.push_back(by_chance(
            "make_points, " + kind, [=](Draw& d) { return of_sets(d, most, make); }, draws));
        auto second = [set](uint32_t n, uint32_t seed) { return self::second_pair(set, n, seed); };
        all.push_back(by_chance(
            "second_pair, " + kind, [=](Draw& d) { return of_sets(d, most, second); }, draws));
        all.push_back(by_chance(
            "second_pair beside make_points, " + kind,
            [=](Draw& d) -> Values {
                uint32_t n = d.count(2, most), seed = d.seed();
                Points xy = make(n, seed), zw = second(n, seed);
                RunningStats xz, yw, xw;
                for (size_t i = 0; i < std::min(xy.size(), zw.size()); i++) {
                    Vec2 a = {xy[i].x - 0.5f, xy[i].y - 0.5f}, b = {zw[i].x - 0.5f, zw[i].y - 0.5f};
                    xz.add(double{a.x * b.x}), yw.add(double{a.y * b.y}), xw.add(double{a.x * b.y});
                }
                return {{"the mean of (x - 0.5)(z - 0.5)", xz.mean()},
                        {"the mean of (y - 0.5)(w - 0.5)", yw.mean()},
                        {"the mean of (x - 0.5)(w - 0.5)", xw.mean()}};
            },
            draws));
    }
    all.push_back(by_chance(
        "repelled_points",
        [](Draw& d) {
            int steps = static_cast<int>(d.count(0, 20));
            return of_sets(d, 8, [steps](uint32_t n, uint32_t seed) {
                return self::repelled_points(n, steps, seed);
            });
        },
        200));
    return all;
}
