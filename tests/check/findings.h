// What a chapter's pictures of the probes bring, beside what they should: by class of path.
#pragma once
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

struct Quantity {
    double mean = 0, se = 0;
};

/// By probe, then by class of path. Beside the classes: "all", the picture's mean; "parts", the sum
/// of its classes; "noise", the spread of one sample over its mean; "rays" and "samples" of a
/// sample asked for.
using Quantities = std::map<std::string, std::map<std::string, Quantity>>;

inline bool is_class(const std::string& name) { return name[0] == 'L' || name == "longer"; }

/// Measurements compared with what they should be.
class Findings {
public:
    Findings(Quantities measured, Quantities expected)
        : measured_(std::move(measured)), expected_(std::move(expected)) {}

    const Quantities& measured() const { return measured_; }
    const Quantities& expected() const { return expected_; }
    static Quantity find(const Quantities& q, const std::string& probe, const std::string& name) {
        auto row = q.find(probe);
        if (row == q.end()) return {};
        auto cell = row->second.find(name);
        return cell == row->second.end() ? Quantity{} : cell->second;
    }
    /// Whether no class of path brings anything, in any probe.
    bool black() const {
        for (const auto& [probe, row] : measured_)
            for (const auto& [name, q] : row)
                if (is_class(name) && q.mean != 0) return false;
        return true;
    }
    bool has(const std::string& probe) const { return measured_.contains(probe); }

    /// Measured over expected, with its standard error; NaN where nothing is expected.
    Quantity ratio(const std::string& probe, const std::string& name = "LDE") const {
        Quantity a = find(measured_, probe, name), b = find(expected_, probe, name);
        if (!(b.mean > 0)) return {NAN, NAN};
        double r = a.mean / b.mean;
        return {r, std::hypot(a.se / b.mean, r * b.se / b.mean)};
    }
    /// Whether it is other than expected: by 5 standard errors, and by so much that it is seen.
    bool off(const std::string& probe, const std::string& name = "LDE") const {
        if (!has(probe)) return false;
        Quantity expected = find(expected_, probe, name);
        if (!(expected.mean > 0)) return leaks(probe, name);
        if (expected.se > 0.015 * expected.mean) return false;  // too rare to say
        Quantity r = ratio(probe, name);
        return !(std::abs(r.mean - 1) <= std::max(5 * r.se, least));
    }
    /// Light of a class that should bring nothing.
    bool leaks(const std::string& probe, const std::string& name) const {
        if (find(expected_, probe, name).mean > 0) return false;
        Quantity m = find(measured_, probe, name);
        return !(m.mean <= std::max(4 * m.se, 2e-3));
    }

    static constexpr double least = 0.008;  // by which a mean must be off

private:
    Quantities measured_, expected_;
};

/// "1/pi" for 0.318: the nearest factor that mistakes are known to make, or "".
inline std::string name_factor(double ratio) {
    constexpr double pi_exact = std::numbers::pi;
    static const std::pair<double, const char*> factors[] = {{pi_exact, "pi"},
                                                             {1 / pi_exact, "1/pi"},
                                                             {2 * pi_exact, "2 pi"},
                                                             {0.5 / pi_exact, "1/(2 pi)"},
                                                             {4 * pi_exact, "4 pi"},
                                                             {0.25 / pi_exact, "1/(4 pi)"},
                                                             {2, "2"},
                                                             {0.5, "1/2"},
                                                             {3, "3"},
                                                             {1.0 / 3, "1/3"},
                                                             {4, "4"},
                                                             {0.25, "1/4"},
                                                             {2.25, "eta^2"},
                                                             {1 / 2.25, "1/eta^2"},
                                                             {1.5, "3/2"},
                                                             {2.0 / 3, "2/3"},
                                                             {4.0 / 3, "4/3"},
                                                             {0.75, "3/4"},
                                                             {2 / (3 * pi_exact), "2/(3 pi)"},
                                                             {pi_exact * pi_exact, "pi^2"},
                                                             {1 / (pi_exact * pi_exact), "1/pi^2"}};
    std::string best;
    double least = 0.04;
    for (const auto& [value, text] : factors) {
        double distance = std::abs(std::log(ratio / value));
        if (distance < least) least = distance, best = text;
    }
    return best;
}
