#include "tests/measure/gnuplot.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "common/error.h"
#include "common/files.h"

namespace {

void need_gnuplot() {
    static bool here = std::system("command -v gnuplot >/dev/null") == 0 ||
                       std::system("common/tools/install gnuplot-nox") == 0;
    if (!here) throw InputError("error: gnuplot is missing, and could not be installed");
}

}  // namespace

void draw_chart(const std::string& path, const std::string& script, int width, int height) {
    need_gnuplot();
    std::string size = std::to_string(width) + "," + std::to_string(height);
    std::string file = path + ".gnuplot";
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    write_file_atomically(
        file, "set terminal svg noenhanced size " + size +
                  " font 'DejaVu Sans,15' background '#ffffff'\nset output '" + path + ".svg'\n" +
                  script + "\nset terminal png noenhanced size " + size +
                  " font 'DejaVu Sans,12'\nset output '" + path + ".png'\nreplot\n");
    if (std::system(("gnuplot " + file).c_str()) != 0) {
        throw InputError(file + ": error: gnuplot failed");
    }
    std::filesystem::remove(file);
}

std::string quoted_for_gnuplot(const std::string& text) {
    std::string quoted = "'";
    for (char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
    return quoted + "'";
}
