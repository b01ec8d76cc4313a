// What differs between systems, in one place: the names of files, locks, the signals that end a
// program, and its streams. All else is written in standard C++.
#pragma once
#include <atomic>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

/// The file that `name` names, and its name again. Names are UTF-8 in all of the code, and those
/// that it makes have slashes; in Windows itself they are UTF-16, with backslashes.
std::filesystem::path file_path(const std::string& name);
std::string file_name(const std::filesystem::path& path);

/// Makes a file that no other program can make until this one removes it or ends, in whatever way:
/// the number of the lock. -1: errno is EWOULDBLOCK where another program has it, or just had it.
int lock_file(const std::string& name);
void unlock_file(int lock, const std::string& name);

/// The file of this program, which was started by the command `program`; with links resolved, and
/// empty if it is not known.
std::filesystem::path own_file(const std::string& program);

/// Opens those of stdin, stdout and stderr that are closed, to read or write nothing. Else the next
/// file opened would take its number, and printed text would end up in that file. Then lets what
/// cannot be written fail with a message, not by a signal; and keeps what is printed in memory.
void prepare_streams();

/// The signals that end a program from outside. On Windows these are Ctrl-C, Ctrl-Break, and
/// SIGTERM for a window that is closed.
#ifdef _WIN32
constexpr int stop_signals[] = {SIGINT, SIGTERM, SIGBREAK};
#else
constexpr int stop_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2};
#endif
/// Whether one of them has come since they were caught.
inline std::atomic<bool> stop_requested = false;

/// Lets them ask for a stop, or end the program again; except those that it was started to ignore.
/// One that comes again, at least half a second later, ends the program.
void catch_stop_signals();
void release_stop_signals();
