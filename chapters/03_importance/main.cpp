#include "chapters/03_importance/estimator.h"

static void add_rows(Table& table, const std::vector<ch03::Experiment>& experiments, uint64_t n,
                     uint32_t seed) {
    for (const ch03::Experiment& e : experiments) {
        Stopwatch watch;
        ch03::Outcome o = ch03::run(e, n, seed);
        table.rows.push_back({e.what, e.density, std::to_string(n), digits(o.stats.mean(), 6),
                              digits(n < 2 ? NAN : o.stats.standard_error(), 2),
                              digits(o.stats.mean() - e.truth, 2), digits(e.variance),
                              digits(n < 2 ? NAN : o.stats.variance()), digits(o.largest_share, 2),
                              digits(watch.seconds(), 2)});
    }
}

int main(int argc, char** argv) {
    return run_program([&] {
        TableOptions options = parse_table_options(argc, argv, "03_importance", 1000000);
        Table table{{"estimated", "density", "N", "estimate", "std error", "error", "exact var",
                     "measured", "largest", "seconds"},
                    {}};
        add_rows(table, ch03::sums(), options.n, options.seed);
        add_rows(table, ch03::integrals(), options.n, options.seed);
        write_results(options, table,
                      "largest: share of the largest X^2 in their sum. It stays high where the "
                      "variance is infinite;\nthere the standard error means nothing.\n",
                      ch03::densities_picture(options.seed));
        return 0;
    });
}
