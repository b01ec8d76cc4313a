// Functions of chapter 05, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::exact, numbers::unit, numbers::direction,
        numbers::power;
    static const auto random_scenes = [] {
        std::vector<Scene> scenes;
        for (uint32_t number = 0; number < 150; number++) {
            scenes.push_back(parse_scene("world.pbrt", random_world(9, number), nullptr));
            prepare(scenes.back(), 1);
        }
        return scenes;
    }();
    // A ray of the camera of one of them.
    auto seen = [](Draw& d, const Scene& s) {
        ::CameraView view = ::camera_view(s.camera, s.width, s.height);
        return ::camera_ray(view, {d.f(d.from(0, s.width)), d.f(d.from(0, s.height))});
    };
    return {
        exact("camera_view and camera_ray",
              [=](Draw& d) {
                  Camera camera = random_scenes[d.below(150)].camera;
                  if (d.below(4) == 0) camera.frame_aspect = d.f(d.power(0.3, 3));
                  if (d.below(4) == 0)
                      camera.screen_window = {d.f(d.from(-2, 0)), d.f(d.from(0.1, 2)),
                                              d.f(d.from(-2, 0)), d.f(d.from(0.1, 2))};
                  int w = int(d.count(1, 999)), h = int(d.count(1, 999));
                  Vec2 film = {d.f(d.from(0, w)), d.f(d.from(0, h))};
                  return self::camera_ray(self::camera_view(camera, w, h), film).d;
              }),
        exact("linear_scan",
              [=](Draw& d) {
                  Geometry g;
                  float size = d.f(d.pick({1.0, 1.0, d.power(1e-5, 1e3)}));
                  for (uint32_t i = 0; i < 9; i++) g.positions.push_back(size * d.vector());
                  for (uint32_t i = 0; i < 3 * d.below(4); i += 3)
                      g.triangles.push_back({{i, i + 1, i + 2}, 0});
                  for (uint32_t i = d.below(3); i > 0; i--)
                      g.spheres.push_back({size * d.vector(), size * d.f(d.power(0.1, 2)), 0});
                  for (uint32_t i = d.below(3); i > 0; i--)
                      g.disks.push_back(
                          {size * d.vector(), d.direction(), size * d.f(d.power(0.1, 2)), 0});
                  Vec3 o = size * d.vector();
                  Ray ray = {o, 0.5f * size * d.vector() - o};
                  if (d.below(3) == 0) ray.d = normalize(ray.d), ray.t_max = 2 * size;
                  PrimHit hit = self::linear_scan(g, ray);
                  bool found = hit.prim != PrimHit::none;
                  return Values{{"the primitive", found ? double(hit.prim) : -1},
                                {"t", found ? hit.t / size : 0},
                                {"b1", found ? hit.b1 : 0},
                                {"b2", found ? hit.b2 : 0}};
              }),
        exact("reflect", self::reflect, direction, direction),
        exact(
            "refract",
            [](Vec3 wo, Vec3 n, double eta) {
                return self::refract(wo, dot(wo, n) < 0 ? -n : n, float(eta));
            },
            direction, direction, power(0.4, 2.5)),
        exact("fresnel_dielectric", self::fresnel_dielectric, unit, power(0.4, 2.5)),
        exact("trace",
              [=](Draw& d) {
                  const Scene& s = random_scenes[d.below(150)];
                  Ray ray = seen(d, s);
                  Sampler sampler(SamplerType::independent, 1, 1);
                  Recorder recorder;
                  return self::trace(s, ray, sampler, recorder);
              })
            .within(1e-3, 0.01),
    };
}
