// What stands behind the name of an output: through symbolic links, to a file that may not be there yet, or to a
// descriptor of this process (/dev/stdout, /proc/self/fd/3, "-").
#pragma once

#include <filesystem>
#include <vector>

namespace poinsot::study {

struct OutputPlace {
  std::filesystem::path path;
  int descriptor = -1;  // that stands open; then there is no path
  int error = 0;        // of the system, where the name leads nowhere (a loop of links)
};

OutputPlace output_place(const std::filesystem::path& file);

// The descriptor, or -1 with errno. A socket in the file system is not opened but connected to.
int open_device(const std::filesystem::path& file);

// Makes what is missing of a folder; returns what was made, the innermost first. Throws InputError.
std::vector<std::filesystem::path> make_folders(const std::filesystem::path& folder);
// Those that nobody has put anything into.
void remove_folders(const std::vector<std::filesystem::path>& folders);

}  // namespace poinsot::study
