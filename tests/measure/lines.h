// Tables of measured lines, with their slopes; plot.gp draws them.
#pragma once
#include <string>
#include <vector>

#include "common/results/table.h"

/// One line of a chart: what was measured, and the slope that theory says.
struct Line {
    std::string panel, label, color;
    std::string theory;  // such as "-0.50"; empty: none
    std::vector<double> x = {}, y = {};
    double slope() const { return fitted_slope(x, y); }
};

/// Writes FOLDER/NAME.tsv, and draws it as NAME.svg and NAME.png.
void write_lines(const std::string& folder, const std::string& name, const std::string& title,
                 const std::string& x_label, const std::string& y_label,
                 const std::vector<Line>& lines);

/// Rows: lines, with their slopes, and what theory says of them.
Table slopes_table(const std::vector<Line>& lines);
