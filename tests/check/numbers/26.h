// Functions of chapter 26, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::exact, numbers::by_chance, numbers::from;
    auto triangle = [](Draw& d, Vec3 near, float size) {
        self::Patch p;
        for (Vec3& corner : p.p) corner = near + size * d.vector();
        Vec3 sides = cross(p.p[1] - p.p[0], p.p[2] - p.p[0]);
        p.n = normalize(sides), p.area = length(sides) / 2;
        p.centre = (p.p[0] + p.p[1] + p.p[2]) / 3;
        p.eps = rounding_error(3);
        p.rho = {d.f(d.from(0, 0.9)), d.f(d.from(0, 0.9)), d.f(d.from(0, 0.9))};
        if (d.below(3) == 0) p.E = {d.f(d.power(0.01, 10)), d.f(d.power(0.01, 10)), 1};
        return p;
    };
    // Two patches, seldom far from each other or of other sizes.
    auto two = [=](Draw& d) {
        float size = d.f(d.pick({1.0, 1.0, d.power(0.01, 1)}));
        Vec3 away = d.f(d.pick({0.3, 1.0, 2.0, d.power(1, 100)})) * d.direction();
        return std::pair{triangle(d, {}, 1), triangle(d, away, size)};
    };
    // Several patches, what they exchange (rows sum to less than 1), and light on its way.
    struct Room {
        self::Patches patches;
        self::Matrix G;
        self::Solution s;
    };
    auto room = [=](Draw& d) {
        Room r;
        size_t n = d.count(2, 12);
        r.patches.closed = d.below(3) == 0;
        r.G.assign(n, std::vector<float>(n));
        auto light = [&] { return d.below(4) == 0 ? 0 : d.from(0, 2); };
        for (size_t i = 0; i < n; i++) {
            r.patches.patch.push_back(triangle(d, {}, 1));
            r.s.H.push_back({light(), light(), light()});
            r.s.unshot.push_back({light(), light(), light()});
            for (size_t j = 0; j < i; j++) {
                float area = std::min(r.patches.patch[i].area, r.patches.patch[j].area);
                r.G[i][j] = r.G[j][i] = d.below(4) == 0 ? 0 : area / float(n) * d.f(d.from(0, 1));
            }
        }
        return r;
    };
    auto state = [](const self::Solution& s, double more = 0) {
        Rgbd H, unshot;
        for (size_t i = 0; i < s.H.size(); i++) H += double(i + 1) * s.H[i];
        for (size_t i = 0; i < s.unshot.size(); i++) unshot += double(i + 1) * s.unshot[i];
        return std::vector{
            H.r, H.g, H.b, unshot.r, unshot.g, unshot.b, sum_of(s.escaped), double(s.steps), more};
    };
    // A board, to hide what is behind it.
    static const Scene scene = [] {
        Scene board = parse_scene("board.pbrt",
                                  "Camera \"perspective\" WorldBegin LightSource \"infinite\"\n"
                                  "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
                                  "\"point3 P\" [-1 0 -1  1 0 -1  1 0 1  -1 0 1]\n",
                                  nullptr);
        prepare(board, 1);
        return board;
    }();
    return {
        exact("by_centres",
              [=](Draw& d) {
                  auto [p, q] = two(d);
                  return self::by_centres(p, q, p.centre, q.centre);
              }),
        exact("point_to_polygon, beside area / distance^2",
              [=](Draw& d) {
                  self::Patch q = triangle(d, {}, d.f(d.pick({1.0, d.power(0.001, 1)})));
                  std::vector<Vec3> corners(q.p.begin(), q.p.end());
                  if (d.below(2) == 0) corners.push_back(q.p[0] + 0.3f * (q.p[2] - q.p[1]));
                  Vec3 x = d.f(d.pick({1.0, 1.0, d.power(1, 1000)})) * d.vector();
                  if (d.below(5) == 0) x = q.p[0];
                  double size = double{q.area / length_squared(q.centre - x)};
                  return self::point_to_polygon(x, d.direction(), corners) / size;
              }),
        exact("mean_to_polygon, beside area / distance^2",
              [=](Draw& d) {
                  auto [p, q] = two(d);
                  double size = double{q.area / length_squared(q.centre - p.centre)};
                  return self::mean_to_polygon(p.p, p.n, q, int(d.below(4))) / size;
              }),
        by_chance("pairs_of_points",
                  [=](Draw& d) {
                      self::Patch p = triangle(d, {}, 1), q = p;
                      uint32_t key = d.seed();
                      auto pairs = self::pairs_of_points(p, q, key);
                      auto others = self::pairs_of_points(p, q, key + 1);
                      double both = 0, next = 0, far = 0;
                      for (size_t i = 0; i < pairs.size(); i++) {
                          auto [x, y] = pairs[i];
                          both += double{dot(x - p.centre, y - p.centre)};
                          next += double{dot(x - p.centre, others[i][0] - p.centre)};
                          far +=
                              double{length_squared(x - p.centre) - length_squared(y - p.centre)};
                      }
                      return Values{{"a point by its partner", both},
                                    {"a point by the next key's", next},
                                    {"how much farther one is than its partner", far}};
                  }),
        by_chance("exchange",
                  [=](Draw& d) {
                      auto [p, q] = two(d);
                      uint32_t key = d.seed();
                      double size = double{p.area * q.area},
                             G = self::exchange(scene, p, q, key) / size,
                             next = self::exchange(scene, p, q, key + 1) / size;
                      return Values{{"G over both areas", G}, {"that by the next key's", G * next}};
                  }),
        exact("sweep",
              [=](Draw& d) {
                  Room r = room(d);
                  auto kind = d.pick({self::Sweep::jacobi, self::Sweep::gauss_seidel});
                  double change = self::sweep(r.G, r.patches.patch, kind, r.s);
                  return state(r.s, change);
              }),
        exact("solve",
              [=](Draw& d) {
                  Room r = room(d);
                  r.s.H.clear();
                  auto kind = d.pick({self::Sweep::jacobi, self::Sweep::gauss_seidel});
                  self::solve(r.G, r.patches.patch, kind, d.power(1e-9, 0.1), r.s);
                  return state(r.s);
              }),
        exact("shoot",
              [=](Draw& d) {
                  Room r = room(d);
                  size_t i = d.below(uint32_t(r.G.size()));
                  self::shoot(r.patches, i, r.G[i], r.s);
                  self::shoot(r.patches, 0, r.G[0], r.s);
                  return state(r.s, double(self::brightest(r.patches.patch, r.s).value_or(99)));
              }),
        exact("ambient",
              [=](Draw& d) {
                  Room r = room(d);
                  for (auto& H : r.s.H) H = 3 * H + Rgbd{2, 2, 2};
                  r.s.escaped = d.pick({0.0, 0.1}) * Rgbd{1, 1, 1};
                  return self::ambient(r.patches.patch, r.s, d.pick({1 - 1e-6, 0.5}));
              }),
    };
}
