// Functions of chapter 04, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact, numbers::unit,
        numbers::from;
    auto pmf = [](Draw& d) {
        std::vector<double> weights = d.weights(d.pick({1u, 3u, 40u}));
        double sum = 0;
        for (double w : weights) sum += w;
        for (double& w : weights) w /= sum;
        return weights;
    };
    // Of f and pmf.
    auto of_terms = [=](auto function) {
        return [=](Draw& d) {
            std::vector<double> p = pmf(d), f(p.size());
            for (double& x : f) x = d.below(4) == 0 ? 0 : d.from(-1, 3);
            return function(f, p, d);
        };
    };
    Functions all = {
        exact(
            "sample_pmf", [](const auto& p, double u) { return double(self::sample_pmf(p, u)); },
            pmf, unit),
        exact("sample_pmf, after rounding",
              [](Draw& d) {
                  std::vector<double> p(2 + d.below(20), 0);
                  p[d.below(uint32_t(p.size()))] = 1 - 1e-9;
                  return double(self::sample_pmf(p, 1 - 1e-12));
              }),
        exact("estimate_sum", of_terms([](auto& f, auto& p, Draw& d) {
                  return self::estimate_sum(f, p, d.unit());
              })),
        exact("exact_mean",
              of_terms([](auto& f, auto& p, Draw&) { return self::exact_mean(f, p); })),
        exact("exact_variance",
              of_terms([](auto& f, auto& p, Draw&) { return self::exact_variance(f, p); })),
        exact(
            "for_each_roll",
            [](double a, double b) {
                return self::for_each_roll([=](double x, double y) { return x * a + y * y * b; });
            },
            from(-1, 1), from(-1, 1)),
        exact("normalized", [](Draw& d) { return self::normalized(d.weights(20)); }),
        exact("open_unit",
              [](Draw& d) {
                  double x = self::open_unit(d.point());
                  return Values{
                      {"", x}, {"1 less that", 1 - x}, {"whether it is 0 or 1", x <= 0 || x >= 1}};
              }),
    };
    for (const self::Density& density :
         {self::uniform, self::linear, self::quadratic, self::inverse_root, self::falling,
          self::rising, self::left_half, self::distance}) {
        std::string name = density.name;
        all.push_back(exact("pdf of " + name, density.pdf, from(0.001, 0.999)));
        all.push_back(exact("invert of " + name, density.invert,
                            from(0.001, name.ends_with("1/2]") ? 0.499 : 0.999)));
        all.push_back(exact("sample of " + name, density.sample, from(1e-6, 1)));
        all.push_back(exact(
            "estimate_integral by " + name,
            [=](double a, double u) {
                return self::estimate_integral([=](double x) { return a + x * x; }, density, u);
            },
            from(-2, 2), from(0, 1)));
    }
    // Where the density is 0 or infinite.
    for (double pdf : {0.0, double{infinity}}) {
        self::Density none = self::uniform;
        none.pdf = pdf == 0 ? [](double) { return 0.0; } : [](double) { return double{infinity}; };
        all.push_back(exact(
            "estimate_integral by nothing",
            [=](double u) { return self::estimate_integral([](double) { return 1; }, none, u); },
            unit));
    }
    return all;
}
