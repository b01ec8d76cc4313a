// The pyramid of strategies: a picture of each, without and with its MIS weight, as one sheet.
#pragma once
#include "chapters/21_bidirectional/estimator.h"
#include "common/picture/drawing.h"
#include "common/render/render.h"

namespace ch21 {

inline std::string strategy_name(int s, int t) {
    return "s " + std::to_string(s) + ", t " + std::to_string(t);
}

/// A row for each number of edges, from 2 on; in it all strategies from s = 0 on. Left: each alone,
/// without its weight. Right: each with its weight; a row sums to all light of its paths.
inline Image pyramid(Scene scene, RenderOptions options) {
    constexpr int side = 96, most = 5;  // pixels; edges
    int rows = std::min(most, scene.max_depth + 1) - 1;
    scene.width = scene.height = side;
    options.film.clear(), options.split.clear();
    options.quiet = true;
    std::vector<Tile> tiles;
    for (int edges = 2; edges < rows + 2; edges++) {
        for (bool weighted : {false, true}) {
            options.unweighted = !weighted;
            for (int s = 0; s <= most; s++) {
                Tile& tile = tiles.emplace_back();
                int t = edges + 1 - s;
                if (t < 1) continue;
                options.strategy = strategy_name(s, t);
                auto all = method_of<trace>(endpoints_of(scene));
                tile.image = render_film(scene, options, all).film.image();
                tile.lines = {options.strategy, weighted ? "weighted" : "alone"};
            }
        }
    }
    return sheet(tiles, 2 * (most + 1));
}

}  // namespace ch21
