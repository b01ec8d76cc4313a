#include "tests/measure/lines.h"

#include <algorithm>
#include <cmath>

#include "tests/measure/gnuplot.h"

namespace {

std::string two_decimals(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", x);
    return std::isnan(x) ? "-" : text;
}

/// The first line with each label.
std::vector<Line> all_lines(const std::vector<LinePanel>& panels) {
    std::vector<Line> all;
    for (const LinePanel& panel : panels) {
        for (const Line& line : panel.lines) {
            auto same = [&](const Line& known) { return known.label == line.label; };
            if (std::none_of(all.begin(), all.end(), same)) all.push_back(line);
        }
    }
    return all;
}

std::string look(const Line& line) {
    return " with linespoints lw 2.5 pt 7 ps 0.7 lc rgb '" + line.color + "' ";
}

std::string plot_command(const LinePanel& panel, const std::string& prefix) {
    std::string plot = "plot ";
    for (size_t i = 0; i < panel.lines.size(); i++) {
        plot += i ? ", $" : "$";
        plot += prefix + std::to_string(i) + " using 1:2" + look(panel.lines[i]) + "notitle";
    }
    return plot;
}

}  // namespace

void draw_panels(const std::string& path, const std::string& title,
                 const std::vector<LinePanel>& panels, int columns) {
    int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    int width = 470 * columns + 350, height = 490 * rows + 50;
    double plots = 470.0 * columns / width;
    std::string script =
        "set multiplot layout " + std::to_string(rows) + "," + std::to_string(columns) + " title " +
        quoted_for_gnuplot(title) + " margins " + digits(100.0 / width) + "," + digits(plots) +
        "," + digits(70.0 / height) + "," + digits(1 - 90.0 / height) + " spacing " +
        digits(120.0 / width) + "," + digits(120.0 / height) +
        "\nset logscale xy\nset format y '1e%T'\n"
        "set grid lt 1 lc rgb '#dddddd'\nset key at screen " +
        digits(plots + 0.015) + ",0.85 left top Left reverse samplen 1.5 spacing 1.25\n";
    std::string legend;
    for (const Line& line : all_lines(panels)) {
        legend += ", keyentry" + look(line) + "title " + quoted_for_gnuplot(line.label);
    }
    for (size_t p = 0; p < panels.size(); p++) {
        std::string prefix = "p";
        prefix += std::to_string(p) + "_";
        for (size_t i = 0; i < panels[p].lines.size(); i++) {
            std::vector<std::vector<double>> points;
            const Line& line = panels[p].lines[i];
            for (size_t k = 0; k < line.x.size(); k++) points.push_back({line.x[k], line.y[k]});
            script += data_block(prefix + std::to_string(i), points);
        }
        script += "set title " + quoted_for_gnuplot(panels[p].title) + "\nset xlabel " +
                  quoted_for_gnuplot(panels[p].x_label) + "\nset ylabel " +
                  quoted_for_gnuplot(panels[p].y_label) + " offset 1\n" + panels[p].x_axis + "\n" +
                  plot_command(panels[p], prefix) + (p == 0 ? legend : "") + "\nunset key\n";
    }
    draw_chart(path, script + "unset multiplot", width, height);
}

Table points_table(const std::vector<LinePanel>& panels) {
    Table table{{"panel", "line", "x", "y"}, {}};
    for (const LinePanel& panel : panels) {
        for (const Line& line : panel.lines) {
            for (size_t i = 0; i < line.x.size(); i++) {
                table.rows.push_back({panel.title + ": " + panel.y_label + " over " + panel.x_label,
                                      line.label, digits(line.x[i]), digits(line.y[i])});
            }
        }
    }
    return table;
}

Table slopes_table(const std::vector<LinePanel>& panels) {
    Table table{{"slopes"}, {}};
    for (const LinePanel& panel : panels) {
        table.columns.push_back(panel.title);
        table.columns.push_back("theory");
    }
    for (const Line& line : all_lines(panels)) {
        table.rows.push_back({line.label});
        for (const LinePanel& panel : panels) {
            std::string slope = "-", theory = "-";
            for (const Line& here : panel.lines) {
                if (here.label == line.label)
                    slope = two_decimals(here.slope()), theory = here.theory;
            }
            table.rows.back().insert(table.rows.back().end(), {slope, theory});
        }
    }
    return table;
}
