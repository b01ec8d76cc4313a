#include "tests/check/naming.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <numbers>
#include <set>

#include "tests/check/probes.h"

namespace {

constexpr double pi_exact = std::numbers::pi;

/// The parts of a key of evidence.
struct Key {
    std::string probe, name;
    explicit Key(const std::string& key) {
        size_t slash = key.find('/'), from = key.starts_with("2:") ? 2 : 0;
        probe = key.substr(from, slash - from), name = key.substr(slash + 1);
    }
};
bool is_dark(const std::string& key) { return key.ends_with(" dark"); }

/// What a number is when nothing is wrong.
Quantity as_it_should_be(const std::string& key) { return {is_dark(key) ? 0.0 : 1.0, 0}; }

/// The error of a prediction beside the noise of both measurements.
double model_error(const std::string& key, double predicted) {
    if (is_dark(key)) return 1e-3;
    if (key.ends_with("/noise")) return 0.15 * std::abs(predicted);
    return 0.01 * std::max(std::abs(predicted), 0.3);
}

/// Whether a number that is no mean of light is looked at: some mistakes show in no other.
bool tells(const std::string& probe, const std::string& name) {
    static const std::set<std::pair<std::string, std::string>> all = {{"floor", "samples"},
                                                                      {"sphere", "rays"},
                                                                      {"red", "noise"},
                                                                      {"sizes", "noise"},
                                                                      {"floor", "noise"}};
    return all.contains({probe, name});
}

void add_evidence(Evidence& evidence, const Findings& f, const std::string& before) {
    for (const auto& [probe, row] : f.expected()) {
        if (!f.has(probe)) continue;
        for (const auto& [name, q] : row) {
            if (!(q.mean > 0) || q.se > 0.015 * q.mean) continue;  // too rare to say
            if (!is_class(name) && name != "all" && !tells(probe, name)) continue;
            if (!f.measured().at(probe).contains(name) && !is_class(name)) continue;
            Quantity r = f.ratio(probe, name);
            if (!std::isfinite(r.mean) || !std::isfinite(r.se)) r = {1e6, 1e3};
            evidence[before + probe + "/" + name] = r;
        }
    }
    for (const auto& [probe, row] : f.measured())
        for (const auto& [name, q] : row)
            if (is_class(name) && !(Findings::find(f.expected(), probe, name).mean > 0))
                evidence[before + probe + "/" + name + " dark"] = q;
}

/// What paths may have in common: by their class, and by the scene in which they run.
struct Event {
    std::string words;  // "that pass a mirror or glass"
    std::function<bool(const Probe&, const std::string&)> happens;
};
bool has_word(const Probe& probe, const char* word) {
    return probe.text.find(word) != std::string::npos;
}
int count_lights(const Probe& probe) {
    int count = 0;
    for (size_t at = 0; (at = probe.text.find("LightSource", at)) != std::string::npos; at++)
        count++;
    return count;
}
std::vector<Event> events() {
    auto scatterings = [](const std::string& name) {
        return name == "longer" ? 9u : name.size() - 2;
    };
    std::vector<Event> all = {
        {"", [](const Probe&, const std::string&) { return true; }},
        {"that pass a mirror or glass",
         [](const Probe&, const std::string& c) { return c.find('S') != std::string::npos; }},
        {"that pass neither mirror nor glass",
         [](const Probe&, const std::string& c) { return c.find('S') == std::string::npos; }},
        {"that reach the light from a mirror or glass",
         [](const Probe&, const std::string& c) { return c.size() > 2 && c[1] == 'S'; }},
        {"whose light is sampled: the last vertex before it is diffuse or rough",
         [](const Probe&, const std::string& c) { return c.size() > 2 && c[1] == 'D'; }}};
    for (unsigned n : {1u, 2u, 3u, 4u})
        all.push_back({n == 1 ? "that scatter at all"
                              : "that scatter " + std::to_string(n) + " times or more",
                       [=](const Probe&, const std::string& c) { return scatterings(c) >= n; }});
    all.push_back({"that scatter once",
                   [=](const Probe&, const std::string& c) { return scatterings(c) == 1; }});
    return all;
}
std::vector<Event> surroundings() {
    auto with = [](const char* word) {
        return [=](const Probe& p, const std::string&) { return has_word(p, word); };
    };
    auto without = [](const char* word) {
        return [=](const Probe& p, const std::string&) { return !has_word(p, word); };
    };
    return {{"", [](const Probe&, const std::string&) { return true; }},
            {"under a sky", with("infinite")},
            {"without a sky", without("infinite")},
            {"with lamps", with("AreaLightSource")},
            {"with more than one light",
             [](const Probe& p, const std::string&) { return count_lights(p) > 1; }},
            {"with a point light", with("LightSource \"point\"")},
            {"with a distant light", with("LightSource \"distant\"")},
            {"with disks", with("\"disk\"")},
            {"with what moves", with("ActiveTransform")},
            {"with two-sided lamps", with("\"bool twosided\" true")},
            {"with glass", with("dielectric")},
            {"with rough metal", with("roughness")},
            {"with normals that are not the surface's", with("normal N")},
            {"with a camera lens", with("lensradius")}};
}

}  // namespace

std::string where_to_look(const Evidence& evidence) {
    std::map<std::string, Probe> probes;
    for (const Probe& probe : all_probes()) probes.emplace(probe.name, probe);
    std::vector<std::pair<const Probe*, std::string>> off, right;
    std::string worst;
    double most = 0;
    for (const auto& [key, q] : evidence) {
        Key k(key);
        if (!is_class(k.name)) continue;
        double should = as_it_should_be(key).mean, distance = std::abs(q.mean - should);
        double least = is_dark(key) ? 2e-3 : Findings::least;
        bool is_off = !(distance <= std::max((is_dark(key) ? 4 : 5) * q.se, least));
        std::string name = is_dark(key) ? k.name.substr(0, k.name.size() - 5) : k.name;
        if (is_dark(key) && !is_off) continue;
        (is_off ? off : right).push_back({&probes.at(k.probe), name});
        double z = distance / std::max(q.se, 1e-3);
        if (is_off && z > most && !is_dark(key)) {
            most = z;
            char number[100];
            std::snprintf(number, sizeof number, "%.3g", q.mean);
            std::string factor = name_factor(q.mean);
            worst = name + " in " + probes.at(k.probe).what + " is " + number +
                    (factor.empty() ? "" : " (" + factor + ")") + " of what it should be";
        }
    }
    if (off.empty()) return "";
    // The event, with its surroundings, that all of them share and the fewest others.
    std::string best;
    size_t others = right.size() + 1;
    for (const Event& place : surroundings())
        for (const Event& event : events()) {
            auto both = [&](const auto& path) {
                return event.happens(*path.first, path.second) &&
                       place.happens(*path.first, path.second);
            };
            if (!std::all_of(off.begin(), off.end(), both)) continue;
            size_t count = static_cast<size_t>(std::count_if(right.begin(), right.end(), both));
            if (count >= others) continue;
            others = count;
            if (event.words.empty() && !place.words.empty()) {
                best = "in scenes " + place.words;
            } else {
                best = "paths" + (event.words.empty() ? "" : " " + event.words) +
                       (place.words.empty() ? "" : ", in scenes " + place.words);
            }
        }
    std::string text = std::to_string(off.size()) + " of " +
                       std::to_string(off.size() + right.size()) +
                       " classes of path are off. All of these are " + best + "; " +
                       std::to_string(others) + " other classes of this kind are right.";
    if (!worst.empty()) text += "\n    Off most surely: " + worst + ".";
    return text;
}

namespace {

/// Where two hypotheses differ most, and what each predicts there.
std::string deciding_probe(const Hypothesis& a, const Hypothesis& b, const Evidence& evidence) {
    double most = 0;
    std::string text = "no probe tells them apart";
    for (const auto& [measured, q] : evidence) {
        const std::string& key = measured;
        auto of = [&](const Hypothesis& h) {
            auto found = h.predicted.find(key);
            return found == h.predicted.end() ? as_it_should_be(key) : found->second;
        };
        Quantity p = of(a), r = of(b);
        double z = std::abs(p.mean - r.mean) / std::hypot(p.se, r.se, model_error(key, p.mean));
        if (z <= std::max(most, 3.0)) continue;
        most = z;
        Key k(key);
        for (const Probe& probe : all_probes()) {
            if (probe.name != k.probe) continue;
            char numbers[100];
            std::snprintf(numbers, sizeof numbers, ": %.3g by the first, %.3g by the second",
                          p.mean, r.mean);
            text = k.name + " in " + probe.what + numbers;
        }
    }
    return text;
}

bool is_noisy(const Findings& f, const char* probe, double times) {
    if (!f.has(probe)) return false;
    Quantity r = f.ratio(probe, "noise");
    return r.mean - 3 * r.se > times;
}

/// Whether a class of path or the whole picture is not as bright as it should be.
bool are_means_off(const Findings& f) {
    for (const auto& [probe, row] : f.expected())
        for (const auto& [name, q] : row)
            if ((is_class(name) || name == "all") && f.off(probe, name)) return true;
    for (const auto& [probe, row] : f.measured())
        if (!f.leak(probe).empty()) return true;
    return false;
}

/// Whether anything is wrong at all: a mean, or the number of samples, their noise or their rays.
bool is_wrong(const Findings& f) {
    if (are_means_off(f)) return true;
    auto of = [&](const char* probe, const char* name) { return f.ratio(probe, name).mean; };
    return (f.has("floor") && of("floor", "samples") > 1.1) ||
           (f.has("sphere") && of("sphere", "rays") < 0.9) || is_noisy(f, "red", 1.25) ||
           (is_noisy(f, "sizes", 1.5) && !is_noisy(f, "floor", 1.3));
}

}  // namespace

Evidence evidence_of(const Findings& found, const Findings* other) {
    Evidence evidence;
    add_evidence(evidence, found, "");
    if (other) add_evidence(evidence, *other, "2:");
    // Noise tells something only of means that are right.
    if (are_means_off(found) || (other && are_means_off(*other)))
        std::erase_if(evidence, [](const auto& cell) { return cell.first.ends_with("/noise"); });
    return evidence;
}

std::string prediction_text(const Evidence& evidence) {
    std::string text;
    for (const auto& [key, q] : evidence) {
        double distance = std::abs(q.mean - as_it_should_be(key).mean);
        if (distance < std::max(3 * q.se, is_dark(key) ? 1e-3 : 0.004)) continue;
        char cell[200];
        std::snprintf(cell, sizeof cell, "%s=%.4g~%.2g", key.c_str(), q.mean, q.se);
        if (!text.empty()) text += ";";
        text += cell;
    }
    return text;
}

std::vector<Hypothesis> read_hypotheses(const std::string& text, const std::string& chapter,
                                        const std::string& code) {
    // Chapters that find light in the same ways.
    static const std::vector<std::set<std::string>> alike = {
        {"07", "08"}, {"10", "11", "12"}, {"15", "16", "17", "18"}, {"21", "22"}, {"23", "24"}};
    std::set<std::string> chapters = {chapter};
    for (const auto& group : alike)
        if (group.contains(chapter)) chapters = group;
    std::vector<Hypothesis> all;
    for (size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
        std::string line = text.substr(at, end - at), cells[5];
        for (size_t i = 0, from = 0; i < 5; i++) {
            size_t tab = std::min(line.find('\t', from), line.size());
            cells[i] = line.substr(from, tab - from), from = std::min(tab + 1, line.size());
        }
        bool own = cells[0] == chapter;
        if (line.empty() || line[0] == '#' || !chapters.contains(cells[0]) || cells[4].empty())
            continue;
        if (!own && code.find(" " + cells[2] + "(") == std::string::npos) continue;
        Hypothesis h{cells[2], cells[3], {}, own};
        for (size_t from = 0; from < cells[4].size();) {
            size_t stop = std::min(cells[4].find(';', from), cells[4].size());
            size_t equal = cells[4].find('=', from), error = cells[4].find('~', from);
            h.predicted[cells[4].substr(from, equal - from)] = {
                std::stod(cells[4].substr(equal + 1)), std::stod(cells[4].substr(error + 1))};
            from = stop + 1;
        }
        all.push_back(h);
    }
    return all;
}

std::vector<Fit> explanations(const std::vector<Hypothesis>& hypotheses, const Evidence& evidence,
                              double ratio) {
    auto fit_of = [&](const Hypothesis& h) {
        Fit fit{&h, 0, 0};
        Evidence numbers = evidence;
        for (const auto& [key, q] : h.predicted)  // of light that was not found there is none
            if (is_dark(key)) numbers.insert({key, Quantity{}});
        for (const auto& [key, q] : numbers) {
            auto found = h.predicted.find(key);
            // What is not written down was less than 3 standard errors away, of fewer samples:
            // where those are large, it may be as far away.
            Quantity p = {as_it_should_be(key).mean, q.se > 0.01 ? 2 * q.se : 0};
            if (found != h.predicted.end()) p = found->second;
            // Noise and rays of another chapter say nothing: as if they were one error away.
            bool known = h.own || !(key.ends_with("/noise") || key.ends_with("/rays"));
            if (!known) p = q;
            double error = std::hypot(q.se, p.se, model_error(key, p.mean));
            double z = known ? std::abs(q.mean - p.mean) / error : 1;
            fit.worst = std::max(fit.worst, z);
            fit.log_likelihood -= std::min(z * z, 60.0) / 2 + std::log(error);
        }
        return fit;
    };
    // What a mistake must explain better than a right program does: else it explains nothing.
    const Hypothesis no_mistake{"-", "", {}, true};
    double least = fit_of(no_mistake).log_likelihood + std::log(1000.0);
    std::vector<Fit> fits;
    for (const Hypothesis& h : hypotheses) {
        Fit fit = fit_of(h);
        if (fit.explains() && fit.log_likelihood > least) fits.push_back(fit);
    }
    std::sort(fits.begin(), fits.end(),
              [](const Fit& a, const Fit& b) { return a.log_likelihood > b.log_likelihood; });
    while (!fits.empty() &&
           fits.back().log_likelihood < fits.front().log_likelihood - std::log(ratio))
        fits.pop_back();
    return fits;
}

std::string name_mistake(const std::vector<Hypothesis>& hypotheses, const Findings& found,
                         const Findings* other) {
    if (!is_wrong(found) && !(other && is_wrong(*other))) return "";
    Evidence evidence = evidence_of(found, other);
    std::vector<Fit> fits = explanations(hypotheses, evidence);
    // The best of each routine.
    std::vector<const Hypothesis*> best;
    std::set<std::string> routines;
    auto has_routine = [](const Hypothesis& h) { return h.routine != "-"; };
    for (const Fit& fit : fits) {
        const Hypothesis& h = *fit.hypothesis;
        if (routines.insert(has_routine(h) ? h.routine : h.text).second) best.push_back(&h);
    }
    auto words = [&](const Hypothesis& h) {
        return has_routine(h) ? std::string("in `").append(h.routine).append("`, ").append(h.text)
                              : h.text;
    };
    std::string text;
    if (best.size() == 1) {
        text.append("It looks like this mistake: ").append(words(*best[0])).append(".\n");
        if (fits.size() > 1)
            text.append("    Or: ").append(words(*fits[1].hypothesis)).append(".\n");
        text.append("    This explains all ").append(std::to_string(evidence.size()));
        text.append(" numbers that were measured, a thousand times better than any other mistake ");
        text.append("that the check knows.");
    } else if (best.size() == 2) {
        text.append(
            "Two mistakes explain all numbers that were measured about equally well:\n    ");
        text.append(words(*best[0])).append("; or\n    ").append(words(*best[1]));
        text.append(".\n    What would decide: ");
        text.append(deciding_probe(*best[0], *best[1], evidence)).append(".");
    } else {
        text = best.empty() ? "No mistake that the check knows explains all numbers."
                            : "Many mistakes explain all numbers about equally well.";
        std::string where = where_to_look(evidence);
        if (!where.empty()) text.append("\n    Where to look: ").append(where);
    }
    return text;
}

std::string name_factor(double ratio) {
    struct Factor {
        double value;
        const char* text;
    };
    static const std::vector<Factor> factors = {{pi_exact, "pi"},
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
    for (const Factor& factor : factors) {
        double distance = std::abs(std::log(ratio / factor.value));
        if (distance < least) least = distance, best = factor.text;
    }
    return best;
}
