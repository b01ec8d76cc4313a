// Functions of chapter 04, for numbers.h.
inline numbers::Functions functions() {
    using numbers::Draw, numbers::Values, numbers::Functions, numbers::exact, numbers::by_chance;
    auto scaled = [](std::vector<double> weights) {
        double sum = 0;
        for (double w : weights) sum += w;
        for (double& w : weights) w /= sum;
        return weights;
    };
    // As many values as probabilities, of both signs.
    auto terms = [](Draw& d, size_t n) {
        std::vector<double> f(n);
        for (double& x : f) x = d.below(4) == 0 ? 0 : d.from(-1, 3);
        return f;
    };
    auto sum_of = [](const std::vector<double>& list) {
        double sum = 0, place = 0;
        for (double x : list) sum += x * (++place);
        return sum;
    };
    Functions all = {
        exact("sample_pmf",
              [=](Draw& d) -> Values {
                  auto pmf = scaled(d.weights(d.pick({1u, 3u, 40u})));
                  return {{"", static_cast<double>(self::sample_pmf(pmf, d.unit()))}};
              }),
        exact("sample_pmf, after rounding",
              [](Draw& d) -> Values {
                  std::vector<double> pmf(2 + d.below(20), 0);
                  pmf[d.below(static_cast<uint32_t>(pmf.size()))] = 1 - 1e-9;
                  return {{"", static_cast<double>(self::sample_pmf(pmf, 1 - 1e-12))}};
              }),
        exact("estimate_sum",
              [=](Draw& d) -> Values {
                  auto pmf = scaled(d.weights(10));
                  auto f = terms(d, pmf.size());
                  return {{"", self::estimate_sum(f, pmf, d.unit())}};
              }),
        exact("exact_mean",
              [=](Draw& d) -> Values {
                  auto pmf = scaled(d.weights(10));
                  return {{"", self::exact_mean(terms(d, pmf.size()), pmf)}};
              }),
        exact("exact_variance",
              [=](Draw& d) -> Values {
                  auto pmf = scaled(d.weights(10));
                  return {{"", self::exact_variance(terms(d, pmf.size()), pmf)}};
              }),
        exact("for_each_roll",
              [=](Draw& d) -> Values {
                  double a = d.from(-1, 1), b = d.from(-1, 1);
                  auto values =
                      self::for_each_roll([=](double x, double y) { return x * a + y * y * b; });
                  return {{"the size", static_cast<double>(values.size())},
                          {"a sum of them", sum_of(values)}};
              }),
        exact("normalized",
              [=](Draw& d) -> Values {
                  auto weights = self::normalized(d.weights(20));
                  return {{"a sum of them", sum_of(weights)}};
              }),
        exact("open_unit",
              [](Draw& d) -> Values {
                  double x = self::open_unit(d.point());
                  return {{"", x}, {"from 1", 1 - x}, {"1 where it is 0 or 1", x <= 0 || x >= 1}};
              }),
    };
    for (const self::Density& density :
         {self::uniform, self::linear, self::quadratic, self::inverse_root, self::falling,
          self::rising, self::left_half, self::distance}) {
        std::string name = std::string("Density ") + density.name;
        all.push_back(exact(name + ", pdf and invert", [=](Draw& d) -> Values {
            double x = d.from(0.001, 0.499 * (1 + d.below(2))), u = d.from(0.001, 0.999);
            return {{"pdf", density.pdf(x)},
                    {"invert", density.invert(x)},
                    {"invert of sample", density.invert(density.sample(u)) - u}};
        }));
        all.push_back(by_chance(name + ", sample", [=](Draw& d) -> Values {
            double x = density.sample(d.from(1e-6, 1));
            return {{"x", x}, {"x^3", x * x * x}};
        }));
        all.push_back(exact("estimate_integral by " + name, [=](Draw& d) -> Values {
            double a = d.from(-2, 2);
            return {{"", self::estimate_integral([a](double x) { return a + x * x; }, density,
                                                 d.from(0, 1))}};
        }));
    }
    // Densities that are 0 or infinite where they are sampled.
    all.push_back(
        exact("estimate_integral where the density is 0 or infinite", [](Draw& d) -> Values {
            self::Density none = self::uniform;
            none.pdf = d.below(2) == 0 ? [](double) { return 0.0; }
                                       : [](double) { return double{infinity}; };
            return {{"", self::estimate_integral([](double) { return 1; }, none, d.unit())}};
        }));
    return all;
}
