// Tables of results: aligned for people, tab-separated for programs.
#pragma once
#include <ctime>
#include <string>
#include <vector>

#include "common/picture/image.h"
#include "common/render/options.h"

struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// x with `significant` digits; "infinite", or "unknown" if it is not a number.
std::string digits(double x, int significant = 5);

/// One line per row, the columns aligned to the right (the first to the left).
std::string aligned(const Table& table);
std::string tab_separated(const Table& table);

/// The slope of the straight line fitted to (log x, log y) by least squares: -1/2 if four times the
/// samples halve the error. NaN for fewer than two points.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

/// Prints the table and the notes below it (nothing with --quiet), and writes every --out FILE:
/// .tsv the table, all others the picture. Throws InputError.
void write_results(const TableOptions& options, const Table& table, const std::string& notes,
                   const Image& picture);

/// Seconds of processor time since construction: other programs on the machine do not count.
class Stopwatch {
public:
    double seconds() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

private:
    std::clock_t start_ = std::clock();
};
