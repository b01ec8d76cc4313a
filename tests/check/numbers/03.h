// Functions of chapter 03, for numbers.h.
inline numbers::Functions functions() {
    using numbers::point_in, numbers::Draw, numbers::Values, numbers::Functions, numbers::exact,
        numbers::by_chance, numbers::sets, numbers::point, numbers::count, numbers::power,
        numbers::points;
    auto top_bits = [](uint32_t x, int n) { return n == 0 ? 0.0 : double(x >> (32 - n)); };
    auto any_base = [](Draw& d) { return d.pick({2u, 3u, 5u, 7u, 17u, 19u}); };
    Functions all = {
        exact("torus_difference", self::torus_difference, point, point),
        exact("wrap", self::wrap, point_in(-2, 3)),
        exact("hexagonal_distance", self::hexagonal_distance, count(1, 1000000)),
        exact("repulsion", self::repulsion, points(20), point_in(0, 1), power(0.01, 0.5)),
        exact(
            "radical_inverse",
            [](uint32_t base, uint32_t i) { return double{self::radical_inverse(base, i)}; },
            any_base, count(0, 1u << 31)),
        by_chance("radical_inverse, scrambled",
                  [=](Draw& d) {
                      uint32_t base = any_base(d), seed = d.seed() + 3, i = d.count(0, 1u << 30),
                               later = i + base * d.count(1, 1000);
                      auto at = [&](uint32_t k, uint32_t with) {
                          return double{self::radical_inverse(base, k, with)} - 0.5;
                      };
                      double x = at(i, seed);
                      return Values{{"x", x},
                                    {"x by that of the next number", x * at(i + 1, seed)},
                                    {"x by that of a later number", x * at(later, seed)},
                                    {"x by the next seed's", x * at(i, seed + 1)}};
                  }),
        sets("radical_inverse, scrambled, as points", 64,
             [](uint32_t n, uint32_t seed) {
                 Points all;
                 for (uint32_t i = 0; i < n; i++)
                     all.push_back({self::radical_inverse(2, i, seed + 3), 0.5f});
                 return all;
             }),
        exact("sobol_second", self::sobol_second, count(0, ~0u)).within(0, 0),
        by_chance("owen_scramble",
                  [=](Draw& d) {
                      uint32_t x = d.seed(), seed = d.seed(), y = self::owen_scramble(x, seed);
                      int bit = int(d.below(32));
                      uint32_t differ = y ^ self::owen_scramble(x ^ (1u << bit), seed);
                      double half = y * 0x1p-32 - 0.5;
                      double next = self::owen_scramble(x, seed + 1) * 0x1p-32 - 0.5;
                      return Values{
                          {"the fraction", half},
                          {"bits that differ above the first", top_bits(differ, 31 - bit)},
                          {"whether that bit differs", double(differ >> bit & 1)},
                          {"whether the next does", bit ? differ >> (bit - 1) & 1 : 0.5},
                          {"the fraction by the next seed's", half * next}};
                  }),
        by_chance("shuffled",
                  [](Draw& d) {
                      Points ordered(d.count(1, 30));
                      for (size_t i = 0; i < ordered.size(); i++)
                          ordered[i] = {float(i), float(i * i)};
                      uint32_t seed = d.seed();
                      Points mixed = self::shuffled(ordered, seed),
                             next = self::shuffled(ordered, seed + 1);
                      double n = double(ordered.size()), sum = 0, stays = 0, alike = 0;
                      for (size_t i = 0; i < mixed.size(); i++) {
                          sum += double{mixed[i].x * mixed[i].y} / (n * n * n);
                          stays += mixed[i].x == ordered[i].x;
                          alike += mixed[i].x == next[i].x;
                      }
                      return Values{{"the size", double(mixed.size())},
                                    {"the sum of xy", sum},
                                    {"how many stay", stays},
                                    {"how many are the next seed's", alike},
                                    {"the first", mixed.at(0).x / n},
                                    {"the last", mixed.back().x / n}};
                  }),
        exact(
            "estimate_4d",
            [](const Points& xy, const Points& zw) {
                auto f = [](Vec2 a, Vec2 b) { return double{a.x * b.y + a.y * a.y * b.x}; };
                return self::estimate_4d(xy, zw, f);
            },
            points(10), points(10)),
        sets(
            "repelled_points", 8,
            [](uint32_t n, uint32_t seed) {
                return self::repelled_points(n, int(seed % 20), seed);
            },
            200),
    };
    for (auto rim : {self::Rim::torus, self::Rim::open})
        all.push_back(sets(
            rim == self::Rim::torus ? "poisson_disc_points" : "poisson_disc_points, open", 60,
            [rim](uint32_t n, uint32_t seed) {
                float r = n == 1 ? 0 : 0.8f / std::sqrt(float(n));
                return self::poisson_disc_points(r, 3 * n, seed, rim);
            },
            1000));
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
        auto second = [set](uint32_t n, uint32_t seed) { return self::second_pair(set, n, seed); };
        all.push_back(sets("make_points, " + kind, most, make, draws));
        all.push_back(sets("second_pair, " + kind, most, second, draws));
        all.push_back(by_chance(
            "second_pair beside make_points, " + kind,
            [=](Draw& d) {
                uint32_t n = d.count(2, most), seed = d.seed();
                Points xy = make(n, seed), zw = second(n, seed);
                auto mean = [&](auto f) { return self::estimate_4d(xy, zw, f); };
                return Values{
                    {"the mean of xz", mean([](Vec2 a, Vec2 b) { return a.x * b.x - 0.25; })},
                    {"the mean of yw", mean([](Vec2 a, Vec2 b) { return a.y * b.y - 0.25; })},
                    {"the mean of xw", mean([](Vec2 a, Vec2 b) { return a.x * b.y - 0.25; })}};
            },
            draws));
    }
    return all;
}
