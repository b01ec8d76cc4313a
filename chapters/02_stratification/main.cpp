// Chapter 02 as a program: compares random points and strata in tables and in a picture.
#include "chapters/02_stratification/figure.h"

int main(int argc, char** argv) {
    return run_program([&] {
        TableOptions options = parse_table_options(argc, argv, "02_stratification", 1024);
        auto [errors, slopes] = ch02::compare_sets(options.n, options.seed);
        write_results(options, errors, aligned(slopes) + ch02::six_by_six(options.seed),
                      ch02::sets_picture(options.seed));
        return 0;
    });
}
