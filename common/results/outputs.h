// Checks the files that a program is going to write, before it renders.
#pragma once
#include "common/options/options.h"
#include "common/scene/scene.h"

/// The file name of the picture that --explain draws.
std::string drawing_path(const RenderOptions& options);

/// Throws early the errors that writing the results would throw later (see files.h), and refuses to
/// overwrite a file that the scene was read from. Makes the folder of --split.
void check_outputs(const Scene& scene, const RenderOptions& options);
