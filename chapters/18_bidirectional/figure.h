// The pyramid of strategies: a picture of each, alone and weighed, as one sheet.
#pragma once
#include "chapters/18_bidirectional/estimator.h"
#include "common/base/files.h"
#include "common/picture/image.h"
#include "common/program/render.h"

namespace ch18 {

/// A row for each number of edges, from 2 on; in it all strategies from s = 0 on. Left as they are,
/// right each with its weight: a row sums to all light of its paths.
inline Image pyramid(Scene scene, RenderOptions options) {
    constexpr int side = 96, gap = 4, most = 5;  // pixels; edges
    int rows = std::min(most, scene.max_depth + 1) - 1, half = (most + 1) * (side + gap) + gap;
    scene.width = scene.height = side;
    options.film.clear(), options.split.clear();
    options.quiet = true;
    Image sheet(2 * half, std::max(1, rows) * (side + gap) + gap);
    for (int edges = 2; edges < rows + 2; edges++) {
        for (int s = 0; s <= edges; s++) {
            for (bool weighted : {false, true}) {
                Prepared prepared = prepare(scene, s, edges + 1 - s, weighted);
                Image picture =
                    render_film(scene, options, splat_trace_with<trace>(prepared)).film.image();
                int left = (weighted ? half : 0) + gap + s * (side + gap);
                int top = gap + (edges - 2) * (side + gap);
                for (int y = 0; y < side; y++) {
                    for (int x = 0; x < side; x++) {
                        sheet.at(left + x, top + y) = picture.at(x, y);
                    }
                }
            }
        }
    }
    return sheet;
}

}  // namespace ch18
