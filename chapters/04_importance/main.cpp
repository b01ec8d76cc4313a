// Chapter 04 as a program: prints the experiments as a table, and draws six densities.
#include "chapters/04_importance/figure.h"

int main(int argc, char** argv) {
    return run_program([&] {
        TableOptions options = parse_table_options(argc, argv, "04_importance", 1000000);
        write_results(options, ch04::results_table(options.n, options.seed),
                      "largest: share of the largest X^2 in their sum. It stays high where the "
                      "variance is infinite;\nthere the standard error means nothing.\n",
                      ch04::densities_picture(options.seed));
        return 0;
    });
}
