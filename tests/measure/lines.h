// Log-log charts of measured lines, with their slopes.
#pragma once
#include <string>
#include <vector>

#include "common/results/table.h"

/// One line: what was measured, and the slope that theory says.
struct Line {
    std::string label, color;
    std::string theory;  // such as "-0.50"; empty: none
    std::vector<double> x, y;
    double slope() const { return fitted_slope(x, y); }
};

struct LinePanel {
    std::string title, x_label, y_label;
    std::vector<Line> lines;
    std::string x_axis =
        "set xtics autofreq\nset xrange [*:*]\nset format x '1e%T'";  // for gnuplot
};

/// Draws panels side by side, `columns` in a row, to PATH.svg and PATH.png. Each says what its
/// slopes are, and names its lines at their ends.
void draw_panels(const std::string& path, const std::string& title,
                 const std::vector<LinePanel>& panels, int columns);

/// Rows: panel, line, x, y.
Table points_table(const std::vector<LinePanel>& panels);

/// Rows: lines; columns: the slope in each panel, and what theory says of it.
Table slopes_table(const std::vector<LinePanel>& panels);
