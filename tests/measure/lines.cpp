#include "tests/measure/lines.h"

#include <algorithm>
#include <cstdlib>

#include "common/base/error.h"
#include "tests/measure/measure.h"
#include "tests/support/work.h"

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
    std::string path = folder + "/" + name, words = title;
    std::replace(words.begin(), words.end(), '\'', ' ');
    std::string command = "gnuplot -c tests/measure/plot.gp '" + path + ".tsv' '" + words + "'";
    if (std::system(command.c_str()) != 0)
        throw InputError(path + ".tsv: error: gnuplot failed, or is not installed");
    say_wrote(path + ".svg and .png");
}
