#include "chapters/02_stratification/estimator.h"

/// Every kind of points with N = 16, 64, 256, ... up to n, and its efficiency for pi,
/// 1 / (relative error^2 seconds); and the slopes of the errors.
static std::pair<Table, Table> compare_sets(uint64_t n, uint32_t seed) {
    Table errors{
        {"points", "N", "pi", "error of pi", "of xy", "of penumbra", "seconds", "efficiency"}, {}};
    Table slopes{{"slope of the error", "pi, penumbra", "theory", "xy", "theory"}, {}};
    for (const ch02::Kind& kind : ch02::kinds) {
        std::vector<double> counts, edge, smooth;
        for (uint32_t N = 16; N <= std::min<uint64_t>(n, kind.largest); N *= 4) {
            ch02::Measurement m = ch02::measure(kind.set, N, kind.runs, seed);
            errors.rows.push_back({kind.name, digits(m.count, 4), digits(m.pi),
                                   digits(m.errors[0], 3), digits(m.errors[1], 3),
                                   digits(m.errors[2], 3), digits(m.seconds, 2),
                                   digits(std::pow(m.pi / m.errors[0], 2) / m.seconds, 2)});
            counts.push_back(m.count);
            edge.push_back(std::sqrt(m.errors[0] * m.errors[2]));
            smooth.push_back(m.errors[1]);
        }
        slopes.rows.push_back({kind.name, digits(fitted_slope(counts, edge), 2), kind.edge,
                               digits(fitted_slope(counts, smooth), 2), kind.smooth});
    }
    return {errors, slopes};
}

int main(int argc, char** argv) {
    return run_program([&] {
        TableOptions options = parse_table_options(argc, argv, "02_stratification", 1024);
        auto [errors, slopes] = compare_sets(options.n, options.seed);
        write_results(options, errors, aligned(slopes) + ch02::six_by_six(options.seed),
                      ch02::sets_picture(options.seed));
        return 0;
    });
}
