#include <cmath>
#include <cstdio>
#include <sstream>

#include "common/base/files.h"
#include "tests/diagnose/judge.h"

namespace {

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
}
double mean_of(const Tiles& tiles) {
    double sum = 0;
    for (Quantity q : tiles) sum += q.mean;
    return sum / static_cast<double>(tiles.size());
}
bool is_dark(const SmallScene& scene, size_t tile) {
    return scene.should[tile].mean < std::max(1e-3 * mean_of(scene.should), 1e-4);
}
/// Whether a mistake shows here in all renderers, but not to the same extent: it depends on what
/// one of their samples holds.
bool depends_on_style(const std::string& mistake, const std::string& scene) {
    return mistake.starts_with("each sample is clamped") && scene != "frame" && scene != "wide";
}

}  // namespace

double scale_of(const SmallScene& scene, size_t tile) {
    return is_dark(scene, tile) ? std::max(mean_of(scene.should), 0.01) : scene.should[tile].mean;
}
std::string key_of(const SmallScene& scene, size_t tile) {
    return scene.name + "/" + std::to_string(tile) + (is_dark(scene, tile) ? " dark" : "");
}

std::vector<Hypothesis> read_effects() {
    std::map<std::string, const SmallScene*> scenes;
    for (const SmallScene& scene : small_scenes()) scenes[scene.name] = &scene;
    std::vector<Hypothesis> effects;
    for (const std::string& line : split(read_file("tests/diagnose/effects.tsv"), '\n')) {
        std::vector<std::string> cells = split(line, '\t');
        if (line[0] == '#' || cells.size() < 3) continue;
        Hypothesis h{cells[1], {}};
        for (const std::string& effect : split(cells[2], ';')) {
            size_t equal = effect.find('='), error = effect.find('~');
            const SmallScene& scene = *scenes.at(effect.substr(0, equal));
            std::vector<std::string> numbers =
                split(effect.substr(equal + 1, error - equal - 1), ' ');
            // One number: each tile was as uncertain as that, not only their mean.
            double alike = 0;
            for (size_t i = 0; i < scene.should.size(); i++) alike += !is_dark(scene, i);
            if (numbers.size() > 1) alike = 1;
            for (size_t i = 0; i < scene.should.size(); i++) {
                if (numbers.size() == 1 && is_dark(scene, i)) continue;
                double mean = std::stod(numbers.size() == 1 ? numbers[0] : numbers.at(i));
                double se = std::stod(effect.substr(error + 1)) * std::sqrt(alike);
                if (depends_on_style(cells[1], scene.name))
                    se = std::max(se, 0.2 + 0.5 * std::abs(mean - 1));
                h.predicted[key_of(scene, i)] = {mean, se};
            }
        }
        effects.push_back(h);
    }
    return effects;
}
