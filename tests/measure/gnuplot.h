// Charts: a script for gnuplot, drawn as SVG and as PNG.
#pragma once
#include <string>

/// Draws the script's plot to PATH.svg and PATH.png, `width` x `height` pixels; installs gnuplot
/// where it is missing. The script gets the variables of neither terminal nor output.
void draw_chart(const std::string& path, const std::string& script, int width, int height);

/// Text in single quotes for gnuplot, with nothing in it that its enhanced mode would change.
std::string quoted_for_gnuplot(const std::string& text);
