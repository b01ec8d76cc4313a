// What differs between systems, in one place: the names of files, files, the signals that end a
// program, and its streams. All else is written in standard C++.
#pragma once
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The file that `name` names, and its name again. Names are UTF-8 in all of the code, and those
/// that it makes have slashes; in Windows itself they are UTF-16, with backslashes.
std::filesystem::path file_path(const std::string& name);
std::string file_name(const std::filesystem::path& path);

/// Opens a file to read, a device to write, or a new file to write: the number of the open file, or
/// -1; then errno says why. As long as a new file is open, remove_left_over() lets it be.
int open_file(const std::string& name);
int open_device(const std::string& name);
int open_new_file(const std::string& name);
void close_file(int file);
/// How many bytes were read or written; -1: errno says why.
ptrdiff_t read_bytes(int file, void* to, size_t size);
ptrdiff_t write_bytes(int file, const void* from, size_t size);
uint64_t bytes_in(int file);
/// Waits until what was written is on the disk. False where it cannot get there: errno says why.
bool reach_disk(int file);
/// Whether all that was written could be taken, as closing the file tells. It stays open.
bool closes_well(int file);

/// Locks a file against other programs, until the process ends in whatever way, and makes an empty
/// one where none is: the number of the lock. -1: errno is EWOULDBLOCK where another has it.
int lock_file(const std::string& name);
/// The lock of what `file`, open and new, has been put in the place of; `file` keeps the old one.
void pass_lock(int& lock, int& file);
/// Ends the lock; removes the file if it is empty still.
void unlock_file(int lock, const std::string& name);

/// A device or a pipe: it cannot be replaced, only written to.
bool is_device(const std::string& name);
/// Whether the device can be written to; else errno says why.
bool takes_writes(const std::string& device);
/// Removes a file that this program has begun and no process writes any more.
void remove_left_over(const std::string& name);
/// Gives an open new file the permissions that `name` has.
void copy_permissions(const std::string& name, int file);
/// Why the file cannot be replaced by another, as far as can be told; empty where it can.
std::string why_not_replaced(const std::string& name);
/// Renames an open file, over what has that name. False where that cannot be: errno says why. On
/// Windows it cannot as long as a program has the old one open: this is tried for a second.
bool rename_over(int file, const std::string& from, const std::string& to);
/// A name of the disk that holds the folder: two folders of one disk have the same.
std::string disk_of(const std::string& folder);

/// The file of this program, which was started by the command `program`; with links resolved, and
/// empty if it is not known.
std::filesystem::path own_file(const std::string& program);

/// What strtod does where a point is a point, whatever the user's language makes of it.
double plain_strtod(const char* text, char** end);

/// Opens those of stdin, stdout and stderr that are closed, to read or write nothing. Else the next
/// file opened would take its number, and printed text would end up in that file. Then lets what
/// cannot be written fail with a message, not by a signal; and keeps what is printed in memory.
void prepare_streams();
/// Writes to stderr what it takes without waiting, as a stopped terminal or a full pipe would let
/// wait; returns how many bytes.
size_t write_at_once(std::string_view text);

/// All signals that end a program by default, except those of faults of its own. On Windows these
/// are Ctrl-C, Ctrl-Break, and SIGTERM for a window that is closed.
std::vector<int> all_stop_signals();
inline const std::vector<int> stop_signals = all_stop_signals();
/// Lets `handler` have them, except those that the program was started to ignore; and gives them
/// back to who had them.
void catch_stop_signals(void (*handler)(int signal));
void release_stop_signals();
/// In the handler: called for every signal that it takes.
void keep_catching(int signal, void (*handler)(int signal));
/// Ends the program as the signal does where nobody handles it.
void end_by_signal(int signal);
