// The files that a program is going to write, looked at before its work.
#pragma once
#include "common/program/options.h"
#include "common/scene/scene.h"

/// The picture that --explain draws.
std::string drawing_path(const RenderOptions& options);

/// Throws now what writing the results would throw later (see files.h), and refuses what would
/// overwrite a file that the scene was read from. Makes the folder of --split.
/// more: what the chapter writes beside what the options say
void check_outputs(const Scene& scene, const RenderOptions& options,
                   const std::vector<std::string>& more = {});
