// compare A B: how far picture A is from the reference B.
#include <cstdio>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/percent.h"
#include "common/picture/comparison.h"
#include "common/picture/verdict.h"
#include "common/render/options.h"
#include "common/render/table.h"

namespace {

void print_mean(const char* name, const PictureFacts& facts, double mean) {
    std::printf("%s  %s  mean %.6g", name, facts.file.c_str(), mean);
    bool known = !std::isnan(facts.standard_error);
    if (known) std::printf(" +- %.2g (%s)\n", facts.standard_error, facts.known_from.c_str());
    if (!known) std::printf(", standard error unknown\n");
}

/// "3 %), 20", of standard errors.
std::string difference(const ChannelComparison& c, double standard_error) {
    double d = c.mean_a - c.mean_b;
    bool same = std::abs(d) <= 1e-6 * std::abs(c.mean_b);  // rounding
    return percent(d / c.mean_b) + "), " + digits(same ? 0 : d / standard_error, 3);
}

/// A figure, and on the next line what it is.
void explain(const char* words) { std::printf("    %s\n", words); }

void print_errors(double trim, const Comparison& c) {
    if (trim > 0) std::printf("without the worst %g %% of the pixels:\n", trim);
    std::printf("MSE %.4g   RMSE %.4g   relMSE %.4g\n", c.mse, c.rmse, c.rel_mse);
    explain("mean of (a-b)^2; its root; mean of (a-b)^2 / (b^2 + 0.01), by which dark parts count");
    std::printf("worst 0.1 %% of the pixels: %.3g %% of the squared error\n", 100 * c.worst_share);
    explain(
        "0.1 to 2 %: noise everywhere; much more: a few bright specks, which samples hardly cure");
    std::printf("median of A/B over the pixels: %.5g\n", c.median_ratio);
    explain(
        "of the middle pixel: 2 or 1/pi is a factor, below 1 also noise: most have too little, few "
        "too much");
    if (c.blocks == 0) return;
    std::printf("%d blocks of 8x8: largest |z| %.3g at %d,%d; %d beyond 5\n", c.blocks, c.worst_z,
                c.worst_x, c.worst_y, c.beyond_5);
    explain("how many standard errors a block differs by: noise alone hardly ever passes 5");
}

void print(double trim, const PictureFacts& a, const PictureFacts& b, const Comparison& c) {
    print_mean("A", a, c.mean_a);
    print_mean("B", b, c.mean_b);
    double se = std::hypot(a.standard_error, b.standard_error);
    bool known = !std::isnan(se);
    if (!known) se = c.standard_error;
    std::printf("A - B  %.3g (%s standard errors by %s\n", c.mean_a - c.mean_b,
                difference(c, se).c_str(),
                known ? "the files beside both" : "the differences of pixels within blocks");
    explain("below 5 standard errors the means may be the same, beyond they are not");
    for (size_t i = 0; i < c.channels.size(); i++) {
        const ChannelComparison& channel = c.channels[i];
        std::printf(
            "%-5s  means %.4g and %.4g: A - B %.3g (%s standard errors; median of A/B %.5g\n",
            channel_names[i], channel.mean_a, channel.mean_b, channel.mean_a - channel.mean_b,
            difference(channel, channel.standard_error).c_str(), channel.median_ratio);
    }
    print_errors(trim, c);
    std::printf("verdict: %s\n", verdict(c, se, a, b).c_str());
}

}  // namespace

int main(int argc, char** argv) {
    return run_program([&] {
        std::vector<std::string> pictures;
        std::string out;
        double trim = 0, range = 0;
        std::vector<Option> options = {
            {"out", "FILE", "write the error of each pixel as a colour (.ppm, .pfm or .png)",
             [&](const std::string& text) { out = parse_picture("out", text); }},
            positive_option("range", "R",
                            "the relative error that is white there (default: of all but 1 %)",
                            range),
            positive_option("trim", "PERCENT", "leave the worst pixels out of the errors", trim)};
        parse_options(
            argc, argv, "A B",
            "How far picture A is from the reference B, .pfm, .png or .ppm, figure by figure and "
            "then in words. What a picture shows is known from its notes (.ppm and .png have them; "
            "a .pfm cannot)\nand from what --stats wrote beside it (NAME.json); so are standard "
            "errors, or from NAME.err.pfm.",
            options, [&](const std::string& word) { pictures.push_back(word); });
        if (trim >= 100) throw UsageError("error: --trim takes less than 100");
        if (pictures.size() != 2)
            throw UsageError("error: two pictures are needed, not " +
                             std::to_string(pictures.size()) + "; --help says how");
        if (!out.empty()) check_outputs({out}, pictures);

        Image a = read_image(pictures[0]), b = read_image(pictures[1]);
        PictureFacts facts_a = facts_of(pictures[0], a), facts_b = facts_of(pictures[1], b);
        for (const std::string& line : doubts(facts_a, facts_b)) std::printf("%s\n", line.c_str());
        check_comparable(a, pictures[0], b, pictures[1]);
        print(trim, facts_a, facts_b, compare(a, b, trim));
        if (out.empty()) return 0;
        if (range == 0) range = error_range(a, b);
        write_image(out, error_image(a, b, range), command_line(argc, argv));
        std::printf("wrote %s: relative error |A-B| / sqrt(B^2 + 0.01), black 0, white %.3g\n",
                    out.c_str(), range);
        return 0;
    });
}
