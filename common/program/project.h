// The project's own files, wherever one of its programs is started.
#pragma once
#include <string>

/// The path to file `name` of the project, from the working directory: it is looked for in the
/// folder of the program and in those above. `name` itself where it is not found.
///
/// program  argv[0]: with a slash it says where the program is, without one PATH does
std::string project_file(const std::string& program, const std::string& name);
