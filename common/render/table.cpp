#include "common/render/table.h"

#include <cmath>
#include <cstdio>

#include "common/base/files.h"
#include "common/base/stats.h"

std::string digits(double x, int significant) {
    if (std::isnan(x)) return "unknown";
    if (std::isinf(x)) return x > 0 ? "infinite" : "-infinite";
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", significant, x);
    return text;
}

/// A line for the names of the columns and for each row.
static std::string lines_of(const Table& table, bool aligned) {
    std::vector<std::vector<std::string>> lines = table.rows;
    lines.insert(lines.begin(), table.columns);
    std::vector<size_t> widths(table.columns.size());
    for (const auto& cells : lines)
        for (size_t c = 0; c < cells.size(); c++) widths[c] = std::max(widths[c], cells[c].size());
    std::string text;
    for (const auto& cells : lines) {
        for (size_t c = 0; c < cells.size(); c++) {
            std::string space(aligned ? widths[c] - cells[c].size() : 0, ' ');
            text += c == 0 ? cells[c] + space : (aligned ? "  " : "\t") + space + cells[c];
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    }
    return text;
}
std::string aligned(const Table& table) { return lines_of(table, true); }
std::string tab_separated(const Table& table) { return lines_of(table, false); }

double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
    RunningStats u, v, uv, uu;
    for (size_t i = 0; i < x.size(); i++) {
        double log_x = std::log(x[i]), log_y = std::log(y[i]);
        u.add(log_x);
        v.add(log_y);
        uv.add(log_x * log_y);
        uu.add(log_x * log_x);
    }
    if (x.size() < 2) return NAN;
    return (uv.mean() - u.mean() * v.mean()) / (uu.mean() - u.mean() * u.mean());
}

void write_results(const TableOptions& options, const Table& table, const std::string& notes,
                   const Image& picture) {
    if (!options.quiet) std::printf("%s\n%s", aligned(table).c_str(), notes.c_str());
    std::vector<Output> outputs;
    for (const std::string& path : options.out)
        outputs.push_back({path, [&] {
                               if (!has_ending(path, ".tsv"))
                                   return write_image(path, picture, options.comment);
                               write_file_atomically(path, tab_separated(table));
                           }});
    write_outputs(outputs);
}
