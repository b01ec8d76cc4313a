#include "tests/measure/gnuplot.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/results/table.h"
#include "tests/support/work.h"

namespace {

void need_gnuplot() {
    static bool here = std::system("command -v gnuplot >/dev/null") == 0 ||
                       std::system("common/tools/install gnuplot-nox") == 0;
    if (!here) throw InputError("error: gnuplot is missing, and could not be installed");
}

}  // namespace

void draw_chart(const std::string& path, const std::string& script, int width, int height) {
    need_gnuplot();
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::string size = std::to_string(width) + "," + std::to_string(height), all;
    for (const char* kind : {"svg", "png"}) {
        all += std::string("set terminal ") + (kind[0] == 's' ? "svg" : "pngcairo") +
               " noenhanced font 'DejaVu Sans,15' background '#ffffff' size " + size +
               "\nset output '" + path + "." + kind + "'\n" + script + "\nunset output\nreset\n";
    }
    std::string file = path + ".gnuplot";
    write_file_atomically(file, all);
    if (std::system(("gnuplot '" + file + "'").c_str()) != 0) {
        throw InputError(file + ": error: gnuplot failed");
    }
    std::filesystem::remove(file);
    say_wrote(path + ".svg and .png");
}

std::string quoted_for_gnuplot(const std::string& text) {
    std::string quoted = "'";
    for (char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
    return quoted + "'";
}

std::string data_block(const std::string& name, const std::vector<std::vector<double>>& rows) {
    std::string block = "$" + name + " << EOD\n";
    for (const auto& row : rows) {
        for (double x : row) block += digits(x, 9) + " ";
        block += "\n";
    }
    return block + "EOD\n";
}

void draw_table(const std::string& path, const std::string& title) {
    need_gnuplot();
    std::string words = title;
    std::replace(words.begin(), words.end(), '\'', ' ');
    std::string command = "gnuplot -c tests/measure/plot.gp '" + path + ".tsv' '" + words + "'";
    if (std::system(command.c_str()) != 0) throw InputError(path + ".tsv: error: gnuplot failed");
    say_wrote(path + ".svg and .png");
}
