#include "tests/diagnose/judge.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/picture/comparison.h"
#include "tests/check/findings.h"

namespace {

/// The picture of a scene, if it is there and can be used; else a note says why not.
std::optional<Image> read_picture(const std::string& path, const SmallScene& scene, Folder& to) {
    if (!std::filesystem::exists(path)) return {};
    try {
        Image image = read_image(path);
        check_comparable(Image(scene.width, 16), "the scene", image, path);
        return image;
    } catch (const InputError& e) {
        to.notes.push_back(e.what());
        return {};
    }
}

/// The tiles of a picture and of one with another seed.
Tiles measure(const SmallScene& scene, const Image& a, const Image& b) {
    Tiles tiles;
    for (size_t i = 0; i < scene.should.size(); i++) {
        double sum = 0, noise = 0, n = 0, pixel = 0;
        visit_tile(i, scene.coloured, a.width, a.height, [&](int x, int y, int c) {
            double p = channel(a.at(x, y), c), q = channel(b.at(x, y), c);
            sum += (p + q) / 2, pixel += (p - q) / 2, n++;
            if (scene.coloured || c == 2) noise += pixel * pixel, pixel = 0;
        });
        tiles.push_back({sum / n, std::sqrt(noise) / n});
    }
    return tiles;
}

/// The distance, in standard errors, that one of so many comparisons has with probability 1/1000.
double threshold(size_t comparisons) {
    double z = 3;
    while (std::erfc(z / std::sqrt(2.0)) * static_cast<double>(comparisons) > 1e-3) z += 0.01;
    return z;
}

/// The tiles over what they should be. None has a smaller error than all together: where light is
/// found rarely, both renders may have found none of it.
Tiles over_reference(const SmallScene& scene, Tiles tiles) {
    double squares = 0, n = 0;
    auto is_lit = [&](size_t i) { return scene.should[i].mean == scale_of(scene, i); };
    for (size_t i = 0; i < tiles.size(); i++) {
        double scale = scale_of(scene, i);
        tiles[i] = {tiles[i].mean / scale, std::hypot(tiles[i].se, scene.should[i].se) / scale};
        if (is_lit(i)) squares += tiles[i].se * tiles[i].se, n++;
    }
    for (size_t i = 0; i < tiles.size(); i++)
        if (is_lit(i)) tiles[i].se = std::max(tiles[i].se, std::sqrt(squares / n));
    return tiles;
}

struct Off {
    std::string words;  // "" if it holds
    bool noisy = false;
};
std::string place(size_t tile) {
    static const char* channels[] = {"", ", green", ", blue"};
    return format("(row %zu, column %zu%s)", tile / 4 % 4 + 1, tile % 4 + 1, channels[tile / 16]);
}
std::string times(double ratio) {
    std::string factor = name_factor({ratio});
    return format("%.3g", ratio) + (factor.empty() ? "" : " (" + factor + ")");
}
/// Whether the tiles of a scene, over what they should be, are off by z standard errors.
Off compare(const SmallScene& scene, const Tiles& tiles, double z) {
    constexpr double least = 0.008;
    double weights = 0, sum = 0, worst = 0, low = INFINITY, high = -INFINITY;
    size_t at_low = 0, at_high = 0, leak = tiles.size();
    for (size_t i = 0; i < tiles.size(); i++) {
        double r = tiles[i].mean, se = tiles[i].se;
        if (scene.should[i].mean < scale_of(scene, i) / 2) {  // it should be black
            if (r > std::max(z * se, 4e-3)) leak = i;
            continue;
        }
        double weight = 1 / (se * se + 1e-6);
        weights += weight, sum += weight * r;
        if (std::abs(r - 1) > least) worst = std::max(worst, std::abs(r - 1) / std::max(se, 1e-3));
        if (r < low) low = r, at_low = i;
        if (r > high) high = r, at_high = i;
    }
    Off off;
    if (weights > 0) {
        double mean = sum / weights, se = 1 / std::sqrt(weights);
        if (std::abs(mean - 1) > least) worst = std::max(worst, std::abs(mean - 1) / se);
        bool even = true;
        for (size_t i : {at_low, at_high})
            even &= std::abs(tiles[i].mean - mean) <= std::max(4 * tiles[i].se, 0.02 * mean);
        if (worst > z && even) off.words = times(mean) + " of what it should be, everywhere";
        if (worst > z && !even)
            off.words = format("from %.3g %s to %.3g %s of what it should be", low,
                               place(at_low).c_str(), high, place(at_high).c_str());
        off.noisy = worst <= z && leak == tiles.size() && se > 0.05;
    }
    if (leak < tiles.size())
        off.words += (off.words.empty() ? "" : "; ") +
                     std::string("light where there should be none ") + place(leak);
    return off;
}

bool is_dark(const std::string& key) { return key.ends_with(" dark"); }
std::string scene_of(const std::string& key) { return key.substr(0, key.find('/')); }

/// What a mistake makes of a number that was measured. What is not written down has this error.
Quantity prediction(const Hypothesis& h, const std::string& key, double unwritten_se) {
    auto found = h.predicted.find(key);
    if (found != h.predicted.end()) return found->second;
    return {is_dark(key) ? 0.0 : 1.0, unwritten_se};
}

/// A factor of all numbers that are not dark, if there may be one.
std::optional<Hypothesis> with_factor(const Evidence& evidence) {
    double weights = 0, sum = 0;
    for (const auto& [key, q] : evidence) {
        if (is_dark(key)) continue;
        double weight = 1 / (q.se * q.se + 1e-4 * q.mean * q.mean + 1e-8);
        weights += weight, sum += weight * q.mean;
    }
    double factor = weights > 0 ? sum / weights : 1;
    if (std::abs(factor - 1) < 0.02) return {};
    Hypothesis h{"everything is " + times(factor) +
                     " times as bright as the reference: units, exposure, or a factor",
                 {}};
    for (const auto& [key, q] : evidence)
        if (!is_dark(key)) h.predicted[key] = {factor, 0};
    return h;
}

/// How well a hypothesis predicts the evidence.
struct Fit {
    const Hypothesis* hypothesis;
    double log_likelihood;
    double worst;  // the largest distance of a prediction, in standard errors
};
/// The error of a prediction beside the noise of both measurements.
double model_error(const std::string& key, double predicted) {
    return is_dark(key) ? 1e-3 : 0.01 * std::max(std::abs(predicted), 0.3);
}

Fit fit_of(const Hypothesis& h, const Evidence& evidence) {
    Fit fit{&h, 0, 0};
    Evidence numbers = evidence;
    for (const auto& [key, q] : h.predicted)  // of light that was not found there is none
        if (is_dark(key)) numbers.insert({key, Quantity{}});
    for (const auto& [key, q] : numbers) {
        // What is not written down was less than 3 standard errors away, of fewer samples: where
        // those are large, it may be as far away.
        Quantity p = prediction(h, key, q.se > 0.01 ? 2 * q.se : 0);
        double error = std::hypot(q.se, p.se, model_error(key, p.mean));
        double z = std::abs(q.mean - p.mean) / error;
        fit.worst = std::max(fit.worst, z);
        fit.log_likelihood -= std::min(z * z, 60.0) / 2 + std::log(error);
    }
    return fit;
}

/// The hypotheses that explain all evidence, to 6 standard errors and a thousand times better than
/// a right program does; the most likely one first.
std::vector<Fit> explanations(const std::vector<Hypothesis>& hypotheses, const Evidence& evidence) {
    // What a mistake must explain better than a right program does: else it explains nothing.
    const Hypothesis no_mistake;
    double least = fit_of(no_mistake, evidence).log_likelihood + std::log(1000.0);
    std::vector<Fit> fits;
    for (const Hypothesis& h : hypotheses) {
        Fit fit = fit_of(h, evidence);
        if (fit.worst < 6 && fit.log_likelihood > least) fits.push_back(fit);
    }
    std::sort(fits.begin(), fits.end(),
              [](const Fit& a, const Fit& b) { return a.log_likelihood > b.log_likelihood; });
    return fits;
}

/// Whether a mistake predicts something of each scene that is off, and of each scene the mean and
/// the tiles. Their chi^2 is at most 6 standard deviations too large: errors come from 16 pixels,
/// so that chance makes it larger than normal errors would.
bool fits_scenes(const Hypothesis& h, const Evidence& evidence,
                 const std::vector<std::string>& off) {
    struct Sum {
        double weights = 0, differences = 0, predictions = 0, squares = 0, chi2 = 0, n = 0;
    };
    std::map<std::string, Sum> scenes;
    std::set<std::string> predicted;
    for (const auto& [key, q] : evidence) {
        bool dark = is_dark(key);
        Quantity p = prediction(h, key, 0.005);
        if (h.predicted.contains(key)) predicted.insert(scene_of(key));
        Sum& s = scenes[scene_of(key) + (dark ? " dark" : "")];
        double weight = 1 / (q.se * q.se + 1e-6);
        s.weights += weight, s.differences += weight * (q.mean - p.mean);
        s.predictions += weight * p.mean, s.squares += weight * weight * p.se * p.se;
        double error = std::hypot(q.se, p.se, model_error(key, p.mean));
        s.chi2 += std::pow((q.mean - p.mean) / error, 2), s.n++;
    }
    for (const auto& [name, s] : scenes) {
        double model = 0.01 * std::max(s.predictions / s.weights, 0.3);
        double error =
            std::hypot(1 / std::sqrt(s.weights), std::sqrt(s.squares) / s.weights, model);
        if (std::abs(s.differences / s.weights) > 5 * error) return false;
        if (s.chi2 > s.n + 6 * std::sqrt(2 * s.n)) return false;
    }
    return std::all_of(off.begin(), off.end(),
                       [&](const std::string& name) { return predicted.contains(name); });
}

/// Whether two predictions were not measured precisely enough to tell them apart by any tile.
bool are_alike(const Hypothesis& a, const Hypothesis& b, const Evidence& evidence) {
    return std::none_of(evidence.begin(), evidence.end(), [&](const auto& tile) {
        Quantity p = prediction(a, tile.first, 0.002), r = prediction(b, tile.first, 0.002);
        double error = std::hypot(4 * p.se, 4 * r.se, 0.01 * p.mean) + 1e-3;
        return std::abs(p.mean - r.mean) > error;
    });
}

}  // namespace

Folder read_folder(const std::string& folder) {
    Folder to;
    size_t same = 0, pairs = 0;
    for (const SmallScene& scene : small_scenes()) {
        std::string stem = folder + "/" + scene.name;
        size_t notes = to.notes.size();
        std::optional<Image> a = read_picture(stem + ".pfm", scene, to);
        std::optional<Image> b = read_picture(stem + ".2.pfm", scene, to);
        if (!a && to.notes.size() == notes) to.missing.push_back(scene.name);
        if (a && !b && to.notes.size() == notes)
            to.notes.push_back(stem + ": error: how noisy is it? There is no " + scene.name +
                               ".2.pfm (another seed)");
        if (!a || !b) continue;
        bool flat = std::count(a->pixels.begin(), a->pixels.end(), a->pixels[0]) ==
                    static_cast<std::ptrdiff_t>(a->pixels.size());
        if (!flat) pairs++, same += a->pixels == b->pixels;
        to.scenes[scene.name] = measure(scene, *a, *b);
    }
    if (pairs > 8 && same > pairs * 2 / 3) {
        to.notes.push_back(
            folder + ": error: NAME.pfm and NAME.2.pfm are the same: they need different seeds");
        to.scenes.clear();
    }
    return to;
}

namespace {

/// What is off, scene by scene, and the numbers by which mistakes are told apart.
struct Evaluation {
    Evidence evidence;
    std::vector<std::string> off;
};

Evaluation evaluate(const Folder& folder, Diagnosis& d) {
    Evaluation e;
    size_t comparisons = 0, held = 0;
    for (const auto& [name, tiles] : folder.scenes) comparisons += tiles.size() + 1;
    double z = threshold(comparisons);
    for (const SmallScene& scene : small_scenes()) {
        auto found = folder.scenes.find(scene.name);
        if (found == folder.scenes.end()) continue;
        Tiles tiles = over_reference(scene, found->second);
        for (size_t i = 0; i < tiles.size(); i++) e.evidence[key_of(scene, i)] = tiles[i];
        Off result = compare(scene, tiles, z);
        bool is_off = !result.words.empty();
        if (is_off) e.off.push_back(scene.name);
        held += !is_off && !result.noisy, d.noisy += result.noisy;
        d.text += format("%-14s ", scene.name.c_str()) +
                  (is_off         ? "OFF    " + result.words
                   : result.noisy ? "cannot be judged: too noisy"
                                  : "holds") +
                  "\n";
    }
    d.off = static_cast<int>(e.off.size());
    d.text += format(
        "\n%zu of %zu scenes hold, %d are off, %d cannot be judged. By %zu comparisons: "
        "chance alone would make one of a thousand such sets off.\n",
        held, folder.scenes.size(), d.off, d.noisy, comparisons);
    if (!folder.missing.empty()) d.text += "Not there, and not judged:";
    for (const std::string& name : folder.missing) d.text += " " + name;
    d.text += folder.missing.empty() ? "" : "\n";
    return e;
}

}  // namespace

Diagnosis judge(const Folder& folder, const std::vector<Hypothesis>& effects) {
    Diagnosis d;
    const auto [evidence, off] = evaluate(folder, d);
    if (off.empty()) return d;

    std::vector<Hypothesis> hypotheses = effects;
    for (Hypothesis& h : hypotheses)
        std::erase_if(h.predicted,
                      [&](const auto& cell) { return !evidence.contains(cell.first); });
    if (std::optional<Hypothesis> factor = with_factor(evidence)) hypotheses.push_back(*factor);
    std::vector<Fit> fits = explanations(hypotheses, evidence);
    std::erase_if(fits,
                  [&](const Fit& fit) { return !fits_scenes(*fit.hypothesis, evidence, off); });
    std::vector<std::string> best;
    for (const Fit& fit : fits) {
        const Hypothesis& h = *fit.hypothesis;
        bool is_less_likely = fit.log_likelihood < fits[0].log_likelihood - std::log(1000);
        if (is_less_likely && !are_alike(h, *fits[0].hypothesis, evidence)) continue;
        if (std::find(best.begin(), best.end(), h.text) == best.end()) best.push_back(h.text);
    }
    if (best.size() <= 2)
        for (const std::string& name : best) d.name += (d.name.empty() ? "" : "; or ") + name;
    d.text +=
        best.empty() ? "No known mistake explains all numbers.\n"
        : best.size() == 1
            ? "It looks like this mistake: " + d.name + ".\n    This explains all " +
                  std::to_string(evidence.size()) +
                  " numbers that were measured, a thousand times better than any other known "
                  "mistake.\n"
            : format("%zu known mistakes explain all numbers about equally well", best.size()) +
                  (d.name.empty() ? "" : ": " + d.name) + ".\n";
    return d;
}
