// The pyramid of strategies: a picture of each, alone and weighed, as one sheet.
#pragma once
#include "common/path/bidirectional.h"
#include "common/picture/sheet.h"
#include "common/program/render.h"

namespace ch21 {

/// A row for each number of edges, from 2 on; in it all strategies from s = 0 on. Left as they are,
/// right each with its weight: a row sums to all light of its paths.
inline Image pyramid(Scene scene, RenderOptions options) {
    constexpr int side = 96, most = 5;  // pixels; edges
    int rows = std::min(most, scene.max_depth + 1) - 1;
    scene.width = scene.height = side;
    options.film.clear(), options.split.clear();
    options.quiet = true;
    std::vector<Tile> tiles;
    for (int edges = 2; edges < rows + 2; edges++) {
        for (bool weighted : {false, true}) {
            for (int s = 0; s <= most; s++) {
                Tile& tile = tiles.emplace_back();
                int t = edges + 1 - s;
                if (t < 1) continue;
                auto trace = splat_trace_with<bidirectional::trace>(
                    bidirectional::prepare(scene, s, t, weighted));
                tile.image = render_film(scene, options, trace).film.image();
                tile.lines = {"s " + std::to_string(s) + ", t " + std::to_string(t),
                              weighted ? "weighed" : "alone"};
            }
        }
    }
    return sheet(tiles, 2 * (most + 1));
}

}  // namespace ch21
