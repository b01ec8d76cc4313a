// Chapter 01 as a program: throws darts, prints a table, draws a picture.
#include "chapters/01_monte_carlo_pi/figure.h"

int main(int argc, char** argv) {
    return run_program([&] {
        TableOptions options = parse_table_options(argc, argv, "01_monte_carlo_pi", 1 << 20);
        write_results(options, ch01::darts_table(options.n, options.seed),
                      ch01::darts_notes(options.n, options.seed),
                      ch01::darts_picture(options.n, options.seed));
        return 0;
    });
}
