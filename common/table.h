// Tables of results: aligned for people, tab-separated for programs.
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "common/image.h"
#include "common/options.h"

struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// x with so many significant digits; "infinite", or "unknown" when it is not a number.
std::string digits(double x, int significant = 5);

/// One line per row, the columns aligned to the right (the first to the left).
std::string aligned(const Table& table);
std::string tab_separated(const Table& table);

/// The slope of the straight line through (log x, log y) with the least squares: -1/2 where four
/// times the samples halve the error. NaN for fewer than two points.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

/// Prints the table and the notes below it (nothing with --quiet), and writes every --out FILE:
/// .tsv the table, all others the picture. Throws InputError.
void write_results(const TableOptions& options, const Table& table, const std::string& notes,
                   const Image& picture);

/// Seconds since it was made.
class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
