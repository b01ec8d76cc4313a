// Checks the files that a program is going to write, before it renders.
#pragma once
#include <functional>

#include "common/options/options.h"
#include "common/scene/scene.h"

/// The file name of the picture that --explain draws.
std::string drawing_path(const RenderOptions& options);

/// Whether a program uses this file name for files that it writes while it runs.
using IsWritten = std::function<bool(const std::string& name)>;

/// Throws early the errors that writing the results would throw later (see files.h), and refuses to
/// overwrite a file that the scene was read from. Makes the folder of --split.
/// more: files that the chapter writes besides those of the options
/// is_beside: of files that it writes beside its first picture
void check_outputs(const Scene& scene, const RenderOptions& options,
                   const std::vector<std::string>& more = {}, const IsWritten& is_beside = {});
