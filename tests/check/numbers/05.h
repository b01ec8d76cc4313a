// Functions of chapter 05, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact;
    auto vector = [](Vec3 v) { return Values{{"x", v.x}, {"y", v.y}, {"z", v.z}}; };
    auto color = [](Rgb c) { return Values{{"red", c.r}, {"green", c.g}, {"blue", c.b}}; };
    // A ray to some point near the origin; seldom it ends before.
    auto ray = [](Draw& d) {
        Vec3 o = d.vector(-2, 2), to = d.vector(-0.5, 0.5);
        Ray ray = {o, d.below(2) == 0 ? normalize(to - o) : to - o};
        if (d.below(4) == 0) ray.t_max = d.f(d.power(0.3, 3));
        return ray;
    };
    auto distance = [](std::optional<float> t) {
        return Values{{"whether it hits", t.has_value()}, {"t", t.value_or(-1)}};
    };
    static const auto random_scenes = [] {
        std::vector<Scene> scenes;
        for (uint32_t number = 0; number < 150; number++) {
            scenes.push_back(parse_scene("world.pbrt", random_world(9, number), nullptr));
            prepare(scenes.back(), 1);
        }
        return scenes;
    }();
    static auto scene = [](Draw& d) -> const Scene& { return random_scenes[d.below(150)]; };
    auto seen = [](Draw& d, const Scene& s) {
        CameraView view = camera_view(s.camera, s.width, s.height);
        return camera_ray(view, {d.f(d.from(0, s.width)), d.f(d.from(0, s.height))});
    };
    return Functions{
        exact("camera_view and camera_ray",
              [=](Draw& d) {
                  Camera camera = scene(d).camera;
                  if (d.below(4) == 0) camera.frame_aspect = d.f(d.power(0.3, 3));
                  if (d.below(4) == 0)
                      camera.screen_window = {d.f(d.from(-2, 0)), d.f(d.from(0.1, 2)),
                                              d.f(d.from(-2, 0)), d.f(d.from(0.1, 2))};
                  int w = static_cast<int>(d.count(1, 999)), h = static_cast<int>(d.count(1, 999));
                  Vec2 film = {d.f(d.from(0, w)), d.f(d.from(0, h))};
                  return vector(self::camera_ray(self::camera_view(camera, w, h), film).d);
              }),
        exact("intersect_triangle",
              [=](Draw& d) -> Values {
                  Ray r = ray(d);
                  Vec3 a = d.vector(), b = d.vector(), c = d.vector();
                  auto hit = self::intersect_triangle(r, a, b, c);
                  if (!hit) return {{"whether it hits", 0}, {"t", 0}, {"b1", 0}, {"b2", 0}};
                  return {{"whether it hits", 1}, {"t", hit->t}, {"b1", hit->b1}, {"b2", hit->b2}};
              }),
        exact("intersect_sphere",
              [=](Draw& d) {
                  Ray r = ray(d);
                  Vec3 c = d.vector();
                  return distance(self::intersect_sphere(r, c, d.f(d.power(0.1, 3))));
              }),
        exact("intersect_disk",
              [=](Draw& d) {
                  Ray r = ray(d);
                  Vec3 c = d.vector(), n = d.direction();
                  return distance(self::intersect_disk(r, c, n, d.f(d.power(0.1, 3))));
              }),
        exact(
            "linear_scan",
            [=](Draw& d) -> Values {
                const Scene& s = scene(d);
                Ray r = seen(d, s);
                if (d.below(4) == 0) r.t_max = d.f(d.power(0.1, 10));
                PrimHit hit = self::linear_scan(s.geometry, r);
                bool found = hit.prim != PrimHit::none;
                return {{"the primitive", found ? double(hit.prim) : -1}, {"t", found ? hit.t : 0}};
            }),
        exact("reflect",
              [=](Draw& d) {
                  Vec3 wo = d.direction();
                  return vector(self::reflect(wo, d.direction()));
              }),
        exact("refract",
              [=](Draw& d) {
                  Vec3 wo = d.direction(), n = d.direction();
                  if (dot(wo, n) < 0) n = -n;
                  return vector(self::refract(wo, n, d.f(d.power(0.4, 2.5))).value_or(Vec3{}));
              }),
        exact("fresnel_dielectric",
              [](Draw& d) -> Values {
                  float cos = d.f(d.unit());
                  return {{"", double{self::fresnel_dielectric(cos, d.f(d.power(0.4, 2.5)))}}};
              }),
        exact("lamp_of",
              [=](Draw& d) {
                  const Scene& s = scene(d);
                  const Light& light = s.lights[d.below(static_cast<uint32_t>(s.lights.size()))];
                  if (light.type != LightType::area) return Values{};
                  auto lamp =
                      self::lamp_of(s.geometry, light, light.first_prim + d.below(light.prims));
                  Values values = {{"radius", lamp.radius},
                                   {"two_sided", lamp.two_sided},
                                   {"intensity", average(lamp.intensity)}};
                  for (auto& value : vector(lamp.p))
                      values.push_back({"p." + value.first, value.second});
                  for (auto& value : vector(lamp.n))
                      values.push_back({"n." + value.first, value.second});
                  return values;
              }),
        exact(
            "shade_all",
            [=](Draw& d) {
                const Scene& s = scene(d);
                std::optional<Hit> x = intersect(s, seen(d, s));
                if (!x || x->material->type != MaterialType::diffuse) return Values{};
                Recorder recorder;
                return color(self::shade_all(s, *x, {1, 0.5f, 0.25f}, recorder));
            },
            1e-3, 0.005),
        exact(
            "trace",
            [=](Draw& d) {
                const Scene& s = scene(d);
                Ray r = seen(d, s);
                Sampler sampler(SamplerType::independent, 1, 1);
                Recorder recorder(true);
                recorder.start();
                Values values = color(self::trace(s, r, sampler, recorder));
                std::map<std::string, double> classes = {{"LE", 0},   {"LDE", 0},   {"LSE", 0},
                                                         {"LDSE", 0}, {"LDSSE", 0}, {"LSSE", 0}};
                for (const Contribution& part : recorder.contributions())
                    if (classes.contains(part.path_class))
                        classes[part.path_class] += double{average(part.L)};
                values.insert(values.end(), classes.begin(), classes.end());
                return values;
            },
            1e-3, 0.01),
    };
}
