// Finds the project's own files, in whatever folder a program is started.
#pragma once
#include <string>

/// The path of the project's file `name`, from the working directory. It is searched in the folder
/// of the program and in the folders above. If it is not found: `name` itself.
///
/// program  argv[0]: with a slash it is the program's path; without one, PATH is searched
std::string project_file(const std::string& program, const std::string& name);
