// Writes the results of a render: pictures, statistics, and a summary.
#pragma once
#include "common/render/render_film.h"

/// Writes pictures and statistics, and prints a summary. Returns the exit code: 1 if a sample was
/// not finite, 3 if a signal stopped the render before its end.
int write_results(const Scene& scene, const RenderOptions& options, const Rendering& rendering);

/// "mean 0.150432 +- 0.000102", or with "standard error unknown".
std::string mean_and_error(const Film& film);

/// The file name of the picture that --explain draws.
std::string drawing_path(const RenderOptions& options);

/// Throws early the errors that writing the results would throw later (see files.h), and refuses to
/// overwrite a file that the scene was read from. Makes the folder of --split.
void check_outputs(const Scene& scene, const RenderOptions& options);
