#include "tests/measure/lines.h"

#include <algorithm>
#include <cmath>

#include "tests/measure/finding.h"
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

/// What the slopes say: all alike, or from which to which.
std::string finding(const LinePanel& panel) {
    const Line *least = nullptr, *most = nullptr;
    for (const Line& line : panel.lines) {
        double slope = line.slope();
        if (!std::isfinite(slope)) continue;
        if (!least || slope < least->slope()) least = &line;
        if (!most || slope > most->slope()) most = &line;
    }
    if (!least) return "";
    auto power = [](const Line& line) { return "x^" + two_decimals(line.slope()); };
    if (most->slope() - least->slope() < 0.1) return "all about as " + power(*least);
    return power(*least) + " to " + power(*most);
}

// In pixels: a panel, its plot, and right of that the names.
constexpr double panel_width = 800, panel_height = 480, left = 85, right = 405, top = 75,
                 bottom = 70, names = 435, line_height = 20, title_height = 50;

/// One panel, whose corner is at (x0, y0).
class PanelScript {
public:
    PanelScript(const LinePanel& panel, const std::string& prefix, double x0, double y0,
                double width, double height)
        : panel_(panel), prefix_(prefix), x0_(x0), y0_(y0), width_(width), height_(height) {
        for (const Line& line : panel.lines) {
            for (double y : line.y) {
                if (!(y > 0)) continue;
                low_ = std::min(low_, y / 1.3), high_ = std::max(high_, y * 1.3);
            }
        }
    }
    std::string text() const {
        auto side = [](const char* name, double share) {
            return "set " + std::string(name) + "margin at screen " + digits(share) + "\n";
        };
        std::string script = side("l", (x0_ + left) / width_) + side("r", (x0_ + right) / width_) +
                             side("t", 1 - (y0_ + top) / height_) +
                             side("b", 1 - (y0_ + panel_height - bottom) / height_),
                    plot = "plot ";
        for (size_t i = 0; i < panel_.lines.size(); i++) {
            const Line& line = panel_.lines[i];
            std::string data = prefix_ + std::to_string(i);
            std::vector<std::vector<double>> points;
            for (size_t k = 0; k < line.x.size(); k++) points.push_back({line.x[k], line.y[k]});
            script += data_block(data, points);
            plot += (i ? ", $" : "$") + data +
                    " using 1:2 with linespoints lw 2.5 pt 7 ps 0.7 lc rgb '" + line.color +
                    "' notitle";
        }
        return script + "unset label\nunset arrow\n" +
               label(panel_.title + ": " + finding(panel_), left, top - 20) + named_ends() +
               "set yrange [" + digits(low_) + ":" + digits(high_) + "]\nset xlabel " +
               quoted_for_gnuplot(panel_.x_label) + "\nset ylabel " +
               quoted_for_gnuplot(panel_.y_label) + " offset 1\n" + panel_.x_axis + "\n" + plot +
               "\n";
    }

private:
    std::string at(double x, double y) const {
        return "screen " + digits((x0_ + x) / width_) + "," + digits(1 - (y0_ + y) / height_);
    }
    std::string label(const std::string& words, double x, double y) const {
        return "set label " + quoted_for_gnuplot(words) + " at " + at(x, y) + "\n";
    }
    /// Names with slopes in a column right of the plot, each joined with the end of its line.
    std::string named_ends() const {
        std::vector<const Line*> drawn;
        std::vector<double> wanted;
        double pixels = (panel_height - top - bottom) / std::log(high_ / low_);
        for (const Line& line : panel_.lines) {
            if (line.y.empty() || !(line.y.back() > 0)) continue;
            drawn.push_back(&line);
            wanted.push_back(top + pixels * std::log(high_ / line.y.back()));
        }
        std::vector<double> y = spread_out(wanted, line_height, top, panel_height - bottom);
        std::string script;
        for (size_t i = 0; i < drawn.size(); i++) {
            const Line& line = *drawn[i];
            script += "set arrow from first " + digits(line.x.back()) + "," +
                      digits(line.y.back()) + " to " + at(names - 5, y[i]) +
                      " nohead lw 1 lc rgb '" + line.color + "'\n" +
                      label(line.label + ": x^" + two_decimals(line.slope()), names, y[i]);
        }
        return script;
    }

    const LinePanel& panel_;
    std::string prefix_;
    double x0_, y0_, width_, height_, low_ = INFINITY, high_ = 0;
};

}  // namespace

void draw_panels(const std::string& path, const std::string& title,
                 const std::vector<LinePanel>& panels, int columns) {
    int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    double width = panel_width * columns, height = panel_height * rows + title_height;
    std::string script = "set encoding utf8\nset multiplot title " + quoted_for_gnuplot(title) +
                         " font ',20'\nset logscale xy\nset format y '1e%T'\n"
                         "set grid lt 1 lc rgb '#dddddd'\nunset key\n";
    for (size_t p = 0; p < panels.size(); p++) {
        auto i = static_cast<int>(p);
        std::string prefix = "p";
        prefix += std::to_string(p) + "_";
        PanelScript panel(panels[p], prefix, panel_width * (i % columns),
                          title_height + panel_height * (i / columns), width, height);
        script += panel.text();
    }
    draw_chart(path, script + "unset multiplot", static_cast<int>(width), static_cast<int>(height));
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
