// Chapter 03 as a program: compares the kinds of points in tables and in a picture.
#include "chapters/03_point_sets/figure.h"

int main(int argc, char** argv) {
    return run_program([&] {
        TableOptions options = parse_table_options(argc, argv, "03_point_sets", 1024);
        auto [errors, slopes] = ch03::compare_sets(options.n, options.seed);
        write_results(options, errors,
                      aligned(slopes) + "\n" + aligned(ch03::compare_pairs(options.seed)),
                      ch03::sets_picture(options.seed));
        return 0;
    });
}
