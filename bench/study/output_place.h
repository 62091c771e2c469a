// What stands behind the name of an output: through symbolic links, to a file that may not be there yet, or to a
// descriptor of this process (/dev/stdout, /proc/self/fd/3, "-").
#pragma once

#include <filesystem>

namespace poinsot::study {

struct OutputPlace {
  std::filesystem::path path;
  int descriptor = -1;  // that stands open; then there is no path
  int error = 0;        // of the system, where the name leads nowhere (a loop of links)
};

OutputPlace output_place(const std::filesystem::path& file);

}  // namespace poinsot::study
