// Tables of measured lines, which plot.gp draws.
#pragma once
#include <string>
#include <vector>

/// One line of a chart: what was measured.
struct Line {
    std::string panel, label, color;
    std::vector<double> x = {}, y = {};
};

/// Writes FOLDER/NAME.tsv, and draws it as NAME.svg and NAME.png.
void write_lines(const std::string& folder, const std::string& name, const std::string& title,
                 const std::string& x_label, const std::string& y_label,
                 const std::vector<Line>& lines);
