// The chart of make bench.
#pragma once
#include "common/results/table.h"
#include "tests/measure/gnuplot.h"

/// One panel for each kind of ray, with a group of bars for each mesh.
///
/// table  rows: mesh, kind of ray, then M rays/s of each of `steps`; "-": not measured
inline void draw_bench(const std::string& path, const Table& table, size_t steps) {
    const char* colors[] = {"#cccccc", "#aab8d0", "#7c9fd0", "#3f7cc0",
                            "#205090", "#c03020", "#e0c060", "#c09020"};
    std::string script =
        "set multiplot layout 2,2 title 'Rays per second, one thread' margins 0.06,0.84,0.09,0.9 "
        "spacing 0.05,0.17\nset logscale y\nset yrange [0.005:50]\nset grid y lt 1 lc rgb "
        "'#dddddd'\nset style data histogram\nset style histogram clustered gap 1\n"
        "set style fill solid noborder\nset key at screen 0.85,0.85 left top Left reverse "
        "samplen 1.5 spacing 1.25\nset ylabel 'M rays/s' offset 1\n"
        "set xtics nomirror rotate by 15 right\n";
    for (const std::string kind : {"primary", "bounce", "second bounce", "shadow"}) {
        std::vector<std::vector<double>> bars;
        std::string tics, block = kind.substr(0, kind.find(' ')), plot = "plot ";
        for (const auto& row : table.rows) {
            if (row[1] != kind) continue;
            tics += (bars.empty() ? "" : ", ") + quoted_for_gnuplot(row[0]) + " " +
                    std::to_string(bars.size());
            bars.emplace_back();
            for (size_t k = 0; k < steps; k++) {
                bars.back().push_back(row[2 + k] == "-" ? std::nan("") : std::stod(row[2 + k]));
            }
        }
        for (size_t k = 0; k < steps; k++) {
            plot += (k > 0 ? ", $" : "$") + block + " using " + std::to_string(k + 1) +
                    " lc rgb '" + colors[k] + "' title " + quoted_for_gnuplot(table.columns[2 + k]);
        }
        script += data_block(block, bars) + "set title " + quoted_for_gnuplot(kind) +
                  "\nset xtics (" + tics + ")\n" + plot + "\nunset key\nunset ylabel\n";
    }
    draw_chart(path, script + "unset multiplot", 1600, 900);
}
