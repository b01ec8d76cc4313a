// The files that a program is going to write, looked at before its work.
#pragma once
#include <functional>

#include "common/program/options.h"
#include "common/scene/scene.h"

/// The picture that --explain draws.
std::string drawing_path(const RenderOptions& options);

/// Whether a name is one of those that a program gives to files while it works.
using IsWritten = std::function<bool(const std::string& name)>;

/// Throws now what writing the results would throw later (see files.h), and refuses what would
/// overwrite a file that the scene was read from. Makes the folder of --split.
/// more: what the chapter writes beside what the options say
/// is_beside: of files that it writes beside its first picture
void check_outputs(const Scene& scene, const RenderOptions& options,
                   const std::vector<std::string>& more = {}, const IsWritten& is_beside = {});
