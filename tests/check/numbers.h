// The reader's functions beside the chapter's own, with random arguments: for chapters
// whose functions return numbers. tests/check/check compiles numbers/NN.h for both files.
#pragma once
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/hash.h"
#include "common/base/stats.h"
#include "common/base/vec.h"
#include "common/scene/camera.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
#include "tests/known/scenes.h"

namespace numbers {

/// What a function returned, or what is known of it: names and numbers.
using Values = std::vector<std::pair<std::string, double>>;

inline std::string digits(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return text;
}

/// Arguments, from a hash of the number of the draw. Often one at the end of its range.
class Draw {
public:
    explicit Draw(uint32_t number) : number_(number) {}

    /// In [0,1), as a float has it.
    double unit() {
        switch (below(20)) {
            case 0: return say(0);
            case 1: return say(1 - 0x1p-24);
            default: return say((bits() >> 8) * 0x1p-24);
        }
    }
    double from(double low, double high) { return say(low + (high - low) * bits() * 0x1p-32); }
    /// Evenly in the logarithm.
    double power(double low, double high) {
        return say(low * std::pow(high / low, bits() * 0x1p-32));
    }
    /// A whole number, evenly in the logarithm; low and high often.
    uint32_t count(uint32_t low, uint32_t high) {
        uint32_t kind = below(10);
        if (kind < 2) return static_cast<uint32_t>(say(kind == 0 ? low : high));
        double x = low + std::pow(high - low + 1.0, bits() * 0x1p-32) - 1;
        return static_cast<uint32_t>(say(std::floor(x)));
    }
    uint32_t below(uint32_t n) { return bits() % n; }
    uint32_t seed() { return static_cast<uint32_t>(say(below(8) == 0 ? below(3) : bits())); }
    template <class T>
    T pick(std::initializer_list<T> list) {
        return list.begin()[below(static_cast<uint32_t>(list.size()))];
    }

    float f(double x) { return static_cast<float>(x); }
    Vec2 point() {
        float x = f(unit());
        return {x, f(unit())};
    }
    Vec2 point(double low, double high) {
        float x = f(from(low, high));
        return {x, f(from(low, high))};
    }
    Vec3 vector(double low = -1, double high = 1) {
        Vec2 xy = point(low, high);
        return {xy.x, xy.y, f(from(low, high))};
    }
    Vec3 direction() {
        Vec3 d = vector();
        return length(d) > 0.1f ? normalize(d) : Vec3{0, 0, 1};
    }
    /// Numbers, up to this many and at least one; some are 0.
    std::vector<double> weights(uint32_t most) {
        std::vector<double> list(1 + below(most));
        for (double& w : list) w = below(4) == 0 ? 0 : power(1e-3, 1);
        list[below(static_cast<uint32_t>(list.size()))] = 1;
        return list;
    }
    std::vector<Vec2> points(uint32_t most) {
        std::vector<Vec2> list(below(most + 1));
        for (Vec2& p : list) p = point();
        return list;
    }

    /// The arguments so far, in words.
    const std::string& said() const { return said_; }

private:
    uint32_t bits() { return hash32(number_, count_++); }
    double say(double x) {
        if (said_.size() < 60)
            said_ += (said_.empty() ? "" : ", ") + digits(x);
        else if (!said_.ends_with("..."))
            said_ += ", ...";
        return x;
    }
    uint32_t number_, count_ = 0;
    std::string said_;
};

// Arguments: functions of a Draw.
inline double unit(Draw& d) { return d.unit(); }
inline Vec2 point(Draw& d) { return d.point(); }
inline Vec3 vector(Draw& d) { return d.vector(); }
inline Vec3 direction(Draw& d) { return d.direction(); }
inline uint32_t seed(Draw& d) { return d.seed(); }
inline auto from(double low, double high) {
    return [=](Draw& d) { return d.from(low, high); };
}
inline auto power(double low, double high) {
    return [=](Draw& d) { return d.power(low, high); };
}
inline auto count(uint32_t low, uint32_t high) {
    return [=](Draw& d) { return d.count(low, high); };
}
inline auto point_in(double low, double high) {
    return [=](Draw& d) { return d.point(low, high); };
}
inline auto points(uint32_t most) {
    return [=](Draw& d) { return d.points(most); };
}

// What a function returned, as numbers.
inline Values values_of(Values v) { return v; }
inline Values values_of(double x) { return {{"", x}}; }
inline Values values_of(Vec2 p) { return {{"x", p.x}, {"y", p.y}}; }
inline Values values_of(Vec3 p) { return {{"x", p.x}, {"y", p.y}, {"z", p.z}}; }
inline Values values_of(Rgbd c) { return {{"red", c.r}, {"green", c.g}, {"blue", c.b}}; }
inline Values values_of(Rgb c) { return values_of(Rgbd(c)); }
inline Values values_of(const std::vector<double>& list) {
    double sum = 0, place = 0;
    for (double x : list) sum += x * ++place;
    return {{"the size", double(list.size())}, {"a sum", sum}};
}
template <class T>
Values values_of(const std::optional<T>& x) {
    Values values = values_of(x.value_or(T{}));
    values.push_back({"whether there is any", x.has_value()});
    return values;
}

/// A function of the chapter, and how it is compared.
struct Function {
    std::string name;
    std::function<Values(Draw&)> values;
    bool by_chance = false;   // the values' means, and those of their squares, alone are known
    double tolerance = 1e-4;  // of a value
    double rounded = 0.002;   // the share of draws in which rounding may decide
    uint32_t draws = 5000;

    Function within(double of_value, double of_draws) const {
        Function f = *this;
        f.tolerance = of_value, f.rounded = of_draws;
        return f;
    }
};
using Functions = std::vector<Function>;

/// f(arguments...), or what f makes of a Draw.
template <class F>
Function exact(const std::string& name, const F& f) {
    return {name, [=](Draw& d) { return values_of(f(d)); }};
}
template <class F, class... Arguments>
Function exact(const std::string& name, const F& f,
               const Arguments&... arguments) requires(sizeof...(Arguments) > 0) {
    return {name, [=](Draw& d) { return values_of(std::apply(f, std::tuple{arguments(d)...})); }};
}
template <class F>
Function by_chance(const std::string& name, const F& f, uint32_t draws = 5000) {
    return {name, [=](Draw& d) { return values_of(f(d)); }, true, 1e-4, 0.002, draws};
}

/// What is known of sets of points on the square: estimates from them, less what is right, times
/// the number of points, since the error of even sets falls faster than that of random ones.
template <class Make>
Values of_sets(Draw& d, uint32_t most, const Make& make) {
    uint32_t n = d.count(1, most), seed = d.seed();
    struct Estimates {
        double xy = 0, circle = 0, diagonal = 0;
    };
    auto from = [](const std::vector<Vec2>& points) {
        RunningStats xy, circle, diagonal;
        for (Vec2 p : points) {
            xy.add(double{p.x} * double{p.y} - 0.25);
            circle.add((p.x * p.x + p.y * p.y <= 1 ? 4 : 0) - std::numbers::pi);
            diagonal.add(double{std::abs(p.x - p.y)} - 1 / 3.0);
        }
        double n = static_cast<double>(points.size());
        return Estimates{n * xy.mean(), n * circle.mean(), n * diagonal.mean()};
    };
    std::vector<Vec2> points = make(n, seed);
    double nearest = 1, outside = 0;
    for (size_t i = 0; i < points.size(); i++) {
        Vec2 p = points[i];
        outside += !(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
        for (size_t k = 0; k < i; k++)
            nearest = std::min(nearest, double{std::hypot(p.x - points[k].x, p.y - points[k].y)});
    }
    Estimates e = from(points), next = from(make(n, seed + 1));
    return {{"the number of points", static_cast<double>(points.size())},
            {"the number of points outside of the square", outside},
            {"the least distance", nearest},
            {"the error for xy", e.xy},
            {"the error for pi", e.circle},
            {"the error for |x - y|", e.diagonal},
            {"the error for xy times that of the next seed", e.xy * next.xy},
            {"the error for pi times that of the next seed", e.circle * next.circle}};
}

template <class Make>
Function sets(const std::string& name, uint32_t most, const Make& make, uint32_t draws = 2000) {
    return by_chance(
        name, [=](Draw& d) { return of_sets(d, most, make); }, draws);
}

/// What is wrong with the reader's function; "": nothing.
inline std::string difference(const Function& own, const Function& mine) {
    struct Compared {
        RunningStats should, squares, by, by_squares;  // the chapter's; the reader's less these
    };
    std::map<std::string, Compared> all;
    uint32_t wrong = 0;
    std::string first;
    for (uint32_t i = 0; i < own.draws; i++) {
        Draw draw(i), same(i);
        Values should = own.values(draw), is = mine.values(same);
        bool off = is.size() != should.size();
        for (size_t k = 0; k < std::min(is.size(), should.size()); k++) {
            auto [name, a] = should[k];
            double b = is[k].second;
            auto& [shoulds, squares, by, by_squares] = all[name];
            shoulds.add(a), squares.add(a * a);
            double size = std::abs(a) + 1e-4 * std::sqrt(squares.mean());
            bool both = a == b || (std::isnan(a) && std::isnan(b));
            bool near = both || std::abs(a - b) <= mine.tolerance * size;
            by.add(near ? 0 : b - a), by_squares.add(near ? 0 : b * b - a * a);
            bool counts = own.by_chance ? std::isfinite(a) && !std::isfinite(b) : !near;
            if (counts && first.empty())
                first = own.name + "(" + draw.said() + "): " + (name.empty() ? "" : name + " is ") +
                        digits(b) + ", and the chapter's " + digits(a);
            off |= counts;
        }
        if (off && first.empty()) first = own.name + "(" + draw.said() + ") has another size";
        wrong += off;
    }
    if (wrong > own.rounded * own.draws) return first;

    // The mean of no value is off by more than chance explains, nor is that of its square.
    for (const auto& [name, c] : all) {
        if (!own.by_chance) break;
        auto is_off = [](const RunningStats& by, double size) {
            return std::abs(by.mean()) > std::max(6 * by.standard_error(), 0.003 * size);
        };
        double size = std::sqrt(c.squares.mean());
        if (is_off(c.by, size))
            return own.name + ": the mean of " + name + " is " +
                   digits(c.should.mean() + c.by.mean()) + ", and the chapter's " +
                   digits(c.should.mean());
        if (is_off(c.by_squares, c.squares.mean()))
            return own.name + ": the mean square of " + name + " is " +
                   digits(c.squares.mean() + c.by_squares.mean()) + ", and the chapter's " +
                   digits(c.squares.mean());
    }
    return "";
}

/// Fails for each function that is not the chapter's. One that is not written yet is left out, and
/// then said.
inline void compare(const Functions& own, const Functions& mine) {
    std::string waits;
    for (size_t i = 0; i < own.size(); i++) {
        try {
            std::string found = difference(own[i], mine[i]);
            if (!found.empty()) FAIL_CHECK(found);
        } catch (const std::logic_error& e) {
            waits = e.what();
        }
    }
    if (!waits.empty()) throw std::logic_error(waits);
}

}  // namespace numbers
