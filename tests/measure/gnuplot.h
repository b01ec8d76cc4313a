// Charts: a script for gnuplot, drawn as SVG and as PNG.
#pragma once
#include <string>
#include <vector>

/// Draws the script's plots to PATH.svg and PATH.png, `width` x `height` pixels; installs gnuplot
/// where it is missing. The script sets neither terminal nor output.
void draw_chart(const std::string& path, const std::string& script, int width, int height);

/// Text in single quotes for gnuplot.
std::string quoted_for_gnuplot(const std::string& text);

/// A block of data named $NAME for gnuplot, one row per line.
std::string data_block(const std::string& name, const std::vector<std::vector<double>>& rows);

/// Draws PATH.tsv, a table of lines (see plot.gp), to PATH.svg and PATH.png.
void draw_table(const std::string& path, const std::string& title);
