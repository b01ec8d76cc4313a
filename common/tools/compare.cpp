// compare A B: how far picture A is from the reference B.
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/text.h"
#include "common/picture/comparison.h"
#include "common/render/options.h"

static void print(const Comparison& c, double trim) {
    Table table{{"", "mean A", "mean B", "A - B", "standard errors", "blocks beyond 5"}, {}};
    for (const ChannelComparison& row : c.rows)
        table.rows.push_back({row.name, digits(row.mean_a), digits(row.mean_b),
                              percent(row.difference()), digits(row.z(), 3),
                              std::to_string(row.beyond_5) + " of " + std::to_string(c.blocks)});
    std::printf("%s", aligned(table).c_str());
    if (trim > 0) std::printf("without the worst %g %% of the pixels:\n", trim);
    std::printf("MSE %.4g   RMSE %.4g   relMSE %.4g\n", c.mse, std::sqrt(c.mse), c.rel_mse);
}

int main(int argc, char** argv) {
    return run_program([&] {
        std::vector<std::string> pictures;
        std::string out;
        double trim = 0, range = 0;
        std::vector<Option> options = {
            {"out", "FILE", "write the error of each pixel as a colour (.ppm, .pfm or .png)",
             [&](const std::string& text) { out = parse_picture("out", text); }},
            positive_option("range", "R",
                            "the relative error that is white there, not of all but 1 %", range),
            positive_option("trim", "PERCENT", "leave the worst pixels out of the errors", trim)};
        parse_options(
            argc, argv, "A B",
            "How far picture A is from the reference B (.film, .pfm, .png or .ppm): in numbers, "
            "then in words.\nA .film tells its standard error; of other pictures it is estimated "
            "from the differences of pixels\nwithin blocks of 8x8, as if pixels were independent. "
            "A .pfm does not tell what it shows.",
            options, [&](const std::string& word) { pictures.push_back(word); });
        if (trim >= 100) throw UsageError("error: --trim takes less than 100");
        if (pictures.size() != 2)
            throw UsageError("error: two pictures are needed, not " +
                             std::to_string(pictures.size()) + "; --help says how");
        if (!out.empty()) check_outputs({out}, pictures);
        Picture a = read_picture(pictures[0]), b = read_picture(pictures[1]);
        for (const std::string& line : doubts(a, b)) std::printf("%s\n", line.c_str());
        check_comparable(a.image, a.file, b.image, b.file);
        Comparison c = compare(a.image, b.image, trim);
        double known = std::hypot(a.standard_error, b.standard_error);
        double scale = std::isnan(known) ? 1 : known / c.rows[0].standard_error;
        for (ChannelComparison& row : c.rows) row.standard_error *= scale;
        print(c, trim);
        std::printf("verdict: %s\n", verdict(c, a, b).c_str());
        if (out.empty()) return 0;
        write_image(out, error_image(a.image, b.image, range), command_line(argc, argv));
        std::printf("wrote %s: relative error |A-B| / sqrt(B^2 + 0.01), black 0, white %.3g\n",
                    out.c_str(), range);
        return 0;
    });
}
