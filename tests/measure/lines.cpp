#include "tests/measure/lines.h"

#include <cstdio>

#include "tests/measure/gnuplot.h"
#include "tests/measure/measure.h"

void write_lines(const std::string& folder, const std::string& name, const std::string& title,
                 const std::string& x_label, const std::string& y_label,
                 const std::vector<Line>& lines) {
    Table table{{"panel", "line", x_label, y_label, "colour"}, {}};
    for (const Line& line : lines) {
        for (size_t i = 0; i < line.x.size(); i++) {
            table.rows.push_back(
                {line.panel, line.label, digits(line.x[i]), digits(line.y[i]), line.color});
        }
    }
    write_table(folder, name, table);
    draw_table(folder + "/" + name, title);
}

Table slopes_table(const std::vector<Line>& lines) {
    Table table{{"against", "line", "slope", "theory"}, {}};
    for (const Line& line : lines) {
        char slope[32];
        std::snprintf(slope, sizeof slope, "%.2f", line.slope());
        table.rows.push_back({line.panel, line.label, slope, line.theory});
    }
    return table;
}
