#include "tests/diagnose/judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "common/base/error.h"
#include "common/base/files.h"

namespace {

template <typename... Args>
std::string format(const char* pattern, Args... args) {
    char text[600];
    std::snprintf(text, sizeof text, pattern, args...);
    return text;
}

/// The picture FOLDER/STEM.pfm or .png, if it is there and can be used; else a note says why not.
std::optional<Image> read_picture(const std::string& stem, const SmallScene& scene, Folder& to,
                                  bool& coarse) {
    for (const char* kind : {".pfm", ".png"}) {
        std::string path = stem + kind;
        if (!std::filesystem::exists(path)) continue;
        coarse |= kind[2] == 'n';
        try {
            Image image = read_image(path);
            int width = scene.name == "wide" ? 32 : 16;
            if (image.width != width || image.height != 16)
                throw InputError(format("%s: error: %d x %d pixels, not %d x 16", path.c_str(),
                                        image.width, image.height, width));
            auto bad = std::find_if(image.pixels.begin(), image.pixels.end(),
                                    [](Rgb c) { return !is_finite(c); });
            if (bad != image.pixels.end()) {
                int at = static_cast<int>(bad - image.pixels.begin());
                throw InputError(
                    format("%s: error: a pixel is not finite, column %d of row %d from the top",
                           path.c_str(), at % width + 1, at / width + 1));
            }
            return image;
        } catch (const InputError& e) {
            to.notes.push_back(e.what());
            return {};
        }
    }
    return {};
}

/// The tiles of a picture and another one: a second render, or the errors of the pixels.
SmallPicture measure(const SmallScene& scene, const Image& a, const Image& b, bool is_error,
                     bool coarse) {
    SmallPicture m;
    m.coarse = coarse;
    for (size_t i = 0; i < count_tiles(scene); i++) {
        double sum = 0, noise = 0, n = 0, step = 0, pixel = 0;
        bool clipped = false;
        visit_tile(i, scene.coloured, a.width, a.height, [&](int x, int y, int c) {
            double p = channel(a.at(x, y), c), q = channel(b.at(x, y), c);
            sum += is_error ? p : (p + q) / 2, pixel += is_error ? q : (p - q) / 2, n++;
            if (scene.coloured || c == 2) noise += pixel * pixel, pixel = 0;
            clipped |= coarse && std::max(p, is_error ? 0 : q) >= 1;
            // The width of an 8-bit code, whose derivative is that of the sRGB curve.
            step += (p <= 0.0031308 ? 1 / 12.92 : 2.4 / 1.055 * std::pow(p, 1 - 1 / 2.4)) / 255;
        });
        double se2 = noise / (n * n) + (coarse ? std::pow(0.29 * step / n, 2) : 0);
        m.tiles.push_back({sum / n, clipped ? INFINITY : std::sqrt(se2)});
    }
    return m;
}

/// The distance, in standard errors, that one of so many comparisons has with probability 1/1000.
double threshold(size_t comparisons) {
    double z = 3;
    while (std::erfc(z / std::sqrt(2.0)) * static_cast<double>(comparisons) > 1e-3) z += 0.01;
    return z;
}

/// No tile has a smaller error than all together: where light is found rarely, both renders may
/// have found none of it.
void use_common_noise(Tiles& tiles, const Tiles& should) {
    double squares = 0, n = 0;
    auto counts = [&](size_t i) {
        return should[i].mean == scale_of(should, i) && std::isfinite(tiles[i].se);
    };
    for (size_t i = 0; i < tiles.size(); i++)
        if (counts(i)) squares += tiles[i].se * tiles[i].se, n++;
    for (size_t i = 0; i < tiles.size(); i++)
        if (counts(i)) tiles[i].se = std::max(tiles[i].se, std::sqrt(squares / n));
}

struct Off {
    std::string words;  // "" if it holds
    bool noisy = false;
};
std::string place(size_t tile) {
    static const char* rows[] = {"top", "upper middle", "lower middle", "bottom"};
    static const char* columns[] = {"left", "left of the middle", "right of the middle", "right"};
    std::string channel = tile < 16 ? "" : tile < 32 ? ", green" : ", blue";
    return std::string("(") + rows[tile / 4 % 4] + ", " + columns[tile % 4] + channel + ")";
}
std::string times(double ratio) {
    std::string factor = name_factor(ratio);
    return format("%.3g", ratio) + (factor.empty() ? "" : " (" + factor + ")");
}
/// Whether the tiles of a scene are as they should be; `tiles` over scale_of.
Off compare(const Tiles& should, const Tiles& tiles, double z, double least) {
    double weights = 0, sum = 0, worst = 0, low = INFINITY, high = -INFINITY;
    size_t at_low = 0, at_high = 0, leak = tiles.size();
    bool uneven = false;
    for (size_t i = 0; i < tiles.size(); i++) {
        bool dark = should[i].mean < scale_of(should, i) / 2;
        if (dark && tiles[i].mean > std::max(z * tiles[i].se, 4e-3)) leak = i;
        if (dark || !std::isfinite(tiles[i].se)) continue;
        double weight = 1 / (tiles[i].se * tiles[i].se + 1e-6), r = tiles[i].mean;
        weights += weight, sum += weight * r;
        if (std::abs(r - 1) > least)
            worst = std::max(worst, std::abs(r - 1) / std::max(tiles[i].se, 1e-3));
        if (r < low) low = r, at_low = i;
        if (r > high) high = r, at_high = i;
    }
    Off off;
    if (weights == 0) {
        off.noisy = std::none_of(tiles.begin(), tiles.end(),
                                 [](Quantity q) { return std::isfinite(q.se); });
        if (leak < tiles.size()) off.words = "light where there should be none " + place(leak);
        return off;
    }
    double mean = sum / weights, se = 1 / std::sqrt(weights);
    if (std::abs(mean - 1) > least) worst = std::max(worst, std::abs(mean - 1) / se);
    for (size_t i : {at_low, at_high})
        uneven |= std::abs(tiles[i].mean - mean) > std::max(4 * tiles[i].se, 0.02 * mean);
    if (worst > z && !uneven) off.words = times(mean) + " of what it should be, everywhere";
    if (worst > z && uneven)
        off.words = format("from %.3g %s to %.3g %s of what it should be", low,
                           place(at_low).c_str(), high, place(at_high).c_str());
    if (leak < tiles.size())
        off.words += (off.words.empty() ? "" : "; ") +
                     std::string("light where there should be none ") + place(leak);
    off.noisy = off.words.empty() && se > 0.05;
    return off;
}

bool is_dark(const std::string& key) { return key.ends_with(" dark"); }
std::string scene_of(const std::string& key) { return key.substr(0, key.find('/')); }

/// A factor that all non-dark numbers may have: of everything, or of scenes with lamps alone.
Hypothesis with_factor(const Evidence& evidence, const std::set<std::string>& scenes,
                       const std::set<std::string>& unknown, const char* what) {
    double weights = 0, sum = 0;
    Hypothesis h;
    for (const auto& [key, q] : evidence) {
        if (is_dark(key) || !scenes.contains(scene_of(key))) continue;
        double weight = 1 / (q.se * q.se + 1e-4 * q.mean * q.mean + 1e-8);
        weights += weight, sum += weight * q.mean;
    }
    double factor = weights > 0 ? sum / weights : 1;
    if (std::abs(factor - 1) < 0.02) return h;
    for (const auto& [key, q] : evidence) {
        if (is_dark(key)) continue;
        if (scenes.contains(scene_of(key))) h.predicted[key] = {factor, 0};
        if (unknown.contains(scene_of(key))) h.predicted[key] = q;
    }
    h.text = std::string(what) + " " + times(factor) +
             " times as bright as the reference: units, exposure, or a factor";
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
        auto found = h.predicted.find(key);
        // What is not written down was less than 3 standard errors away, of fewer samples: where
        // those are large, it may be as far away.
        Quantity p = {is_dark(key) ? 0.0 : 1.0, q.se > 0.01 ? 2 * q.se : 0};
        if (found != h.predicted.end()) p = found->second;
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
        auto found = h.predicted.find(key);
        Quantity p = {dark ? 0.0 : 1.0, 0.005};
        if (found != h.predicted.end()) p = found->second, predicted.insert(scene_of(key));
        Sum& s = scenes[scene_of(key) + (dark ? " dark" : "")];
        double weight = 1 / (q.se * q.se + 1e-6);
        s.weights += weight, s.differences += weight * (q.mean - p.mean);
        s.predictions += weight * p.mean, s.squares += weight * weight * p.se * p.se;
        double least = dark ? 1e-3 : 0.01 * std::max(p.mean, 0.3);
        s.chi2 += std::pow((q.mean - p.mean) / std::hypot(q.se, p.se, least), 2), s.n++;
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

/// What a mistake makes of a number that was measured.
Quantity prediction(const Hypothesis& h, const std::string& key) {
    auto found = h.predicted.find(key);
    if (found != h.predicted.end()) return found->second;
    return {is_dark(key) ? 0.0 : 1.0, 0.002};
}

/// Whether two predictions were not measured precisely enough to tell them apart: neither by a tile
/// nor by the mean of a scene.
bool are_alike(const Hypothesis& a, const Hypothesis& b, const Evidence& evidence) {
    struct Sum {
        double differences = 0, squares = 0, model = 0;
    };
    std::map<std::string, Sum> scenes;
    auto differ = [](double distance, double error, double model) {
        return std::abs(distance) > std::hypot(4 * error, model) + 1e-3;
    };
    for (const auto& [key, q] : evidence) {
        Quantity p = prediction(a, key), r = prediction(b, key);
        double error = std::hypot(p.se, r.se);
        if (differ(p.mean - r.mean, error, 0.01 * p.mean)) return false;
        Sum& s = scenes[scene_of(key)];
        s.differences += p.mean - r.mean, s.squares += error * error,
            s.model += 0.01 * p.mean + 1e-3;
    }
    return std::none_of(scenes.begin(), scenes.end(), [&](const auto& scene) {
        const Sum& s = scene.second;
        return differ(s.differences, std::sqrt(s.squares), s.model);
    });
}

}  // namespace

Folder read_folder(const std::string& folder) {
    Folder to;
    size_t same = 0, pairs = 0;
    for (const SmallScene& scene : small_scenes()) {
        std::string stem = folder + "/" + scene.name;
        bool coarse = false;
        size_t notes = to.notes.size();
        std::optional<Image> a = read_picture(stem, scene, to, coarse);
        std::optional<Image> b = read_picture(stem + ".2", scene, to, coarse);
        bool is_error = !b;
        if (!b) b = read_picture(stem + ".err", scene, to, coarse);
        if (!a && to.notes.size() == notes) {
            to.missing.push_back(scene.name);
            if (std::filesystem::exists(stem + ".exr"))
                to.notes.push_back(stem +
                                   ".exr: error: this format is not read; the page shows how to "
                                   "make a .pfm of it");
        }
        if (a && !b && to.notes.size() == notes)
            to.notes.push_back(stem + ": error: how noisy is it? There is neither " + scene.name +
                               ".2.pfm (another seed) nor " + scene.name + ".err.pfm");
        if (!a || !b || to.notes.size() > notes) continue;
        bool flat = std::count(a->pixels.begin(), a->pixels.end(), a->pixels[0]) ==
                    static_cast<std::ptrdiff_t>(a->pixels.size());
        if (!is_error && !flat) pairs++, same += a->pixels == b->pixels;
        to.scenes[scene.name] = measure(scene, *a, *b, is_error, coarse);
    }
    if (pairs > 8 && same > pairs * 2 / 3) {
        to.notes.push_back(
            folder + ": error: NAME.pfm and NAME.2.pfm are the same: they need different seeds");
        to.scenes.clear();
    }
    bool coarse = std::any_of(to.scenes.begin(), to.scenes.end(),
                              [](const auto& s) { return s.second.coarse; });
    if (coarse)
        to.notes.push_back(folder +
                           ": warning: pictures of 8 bits are coarse, are taken as sRGB, and end "
                           "at 1: a .pfm tells more");
    return to;
}

Diagnosis judge(const Folder& folder, const References& references,
                const std::vector<Hypothesis>& effects) {
    Diagnosis d;
    Evidence evidence;
    std::vector<std::string> off, held;
    std::set<std::string> all, lamps, mixed;
    size_t comparisons = 0;
    for (const auto& [name, m] : folder.scenes) comparisons += m.tiles.size() + 1;
    double z = threshold(comparisons);
    for (const SmallScene& scene : small_scenes()) {
        auto found = folder.scenes.find(scene.name);
        if (found == folder.scenes.end()) continue;
        const Tiles& should = references.at(scene.name);
        Tiles tiles = found->second.tiles;
        for (size_t i = 0; i < tiles.size(); i++) {
            double scale = scale_of(should, i);
            tiles[i] = {tiles[i].mean / scale, std::hypot(tiles[i].se, should[i].se) / scale};
            if (found->second.coarse) tiles[i].se = std::hypot(tiles[i].se, 0.005);
        }
        use_common_noise(tiles, should);
        for (size_t i = 0; i < tiles.size(); i++)
            if (std::isfinite(tiles[i].se)) evidence[key_of(scene.name, should, i)] = tiles[i];
        Off result = compare(should, tiles, z, found->second.coarse ? 0.03 : 0.008);
        if (!result.words.empty()) off.push_back(scene.name);
        if (result.words.empty() && !result.noisy) held.push_back(scene.name);
        d.noisy += result.noisy;
        d.text += format("%-14s ", scene.name.c_str()) +
                  (!result.words.empty() ? "OFF    " + result.words
                   : result.noisy        ? "cannot be judged: too noisy, or above 1 in 8 bits"
                                         : "holds") +
                  "\n";
        all.insert(scene.name);
        if (!scene.has.contains("a sky"))
            lamps.insert(scene.name);
        else if (scene.has.contains("more than one light"))
            mixed.insert(scene.name);
    }
    d.off = static_cast<int>(off.size()), d.held = static_cast<int>(held.size());
    d.text += format("\n%d of %zu scenes hold, %d are off%s. ", d.held, all.size(), d.off,
                     d.noisy ? format(", %d cannot be judged", d.noisy).c_str() : "");
    d.text +=
        format("By %zu comparisons: chance alone would make one of a thousand such sets off.\n",
               comparisons);
    if (!folder.missing.empty()) {
        d.text += "Not there, and not judged:";
        for (const std::string& name : folder.missing) d.text += " " + name;
        d.text += "\n";
    }
    if (off.empty()) return d;

    std::vector<Hypothesis> hypotheses;
    for (Hypothesis h : effects) {
        std::erase_if(h.predicted,
                      [&](const auto& cell) { return !evidence.contains(cell.first); });
        hypotheses.push_back(h);
    }
    Hypothesis factors[] = {
        with_factor(evidence, all, {}, "everything is"),
        with_factor(evidence, lamps, mixed, "the light of lamps, not of the sky, is")};
    for (const Hypothesis& h : factors)
        if (!h.text.empty()) hypotheses.push_back(h);
    std::vector<Fit> fits = explanations(hypotheses, evidence);
    std::erase_if(fits,
                  [&](const Fit& fit) { return !fits_scenes(*fit.hypothesis, evidence, off); });
    std::vector<std::string> best;
    for (const Fit& fit : fits) {
        const Hypothesis &h = *fit.hypothesis, &first = *fits[0].hypothesis;
        bool is_less_likely = fit.log_likelihood < fits[0].log_likelihood - std::log(1000);
        if (is_less_likely && !are_alike(h, first, evidence)) continue;
        if (std::find(best.begin(), best.end(), h.text) == best.end()) best.push_back(h.text);
    }
    if (best.size() == 1) {
        d.name = best[0];
        d.text +=
            "It looks like this mistake: " + d.name + ".\n    This explains all " +
            std::to_string(evidence.size()) +
            " numbers that were measured, a thousand times better than any other known mistake.\n";
    } else if (best.size() == 2) {
        d.name = best[0] + "; or " + best[1];
        d.text += "Two mistakes explain all numbers about equally well:\n    " + best[0] +
                  "; or\n    " + best[1] + ".\n";
    } else {
        d.text += best.empty()
                      ? "No known mistake explains all numbers.\n"
                      : format("%zu known mistakes explain all numbers about equally well.\n",
                               best.size());
    }
    return d;
}
