#include "bench/study/output_place.h"

#include <unistd.h>

#include <cerrno>
#include <charconv>

namespace poinsot::study {
namespace fs = std::filesystem;

OutputPlace output_place(const fs::path& file) {
  if (file == "-") return {{}, STDOUT_FILENO, 0};
  constexpr int kMostLinks = 40;  // as the system's
  std::error_code error;
  const fs::path descriptors = fs::canonical("/proc/self/fd", error);
  fs::path path = file;
  for (int links = 0; links < kMostLinks; ++links) {
    const fs::path folder = fs::weakly_canonical(path.has_parent_path() ? path.parent_path() : fs::path("."), error);
    if (error) return {path, -1, error.value()};
    const std::string name = path.filename().string();
    if (!descriptors.empty() && folder == descriptors) {
      int number = -1;
      const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), number);
      if (wrong == std::errc() && end == name.data() + name.size()) return {{}, number, 0};
    }
    path = folder / name;
    const fs::path next = fs::read_symlink(path, error);
    if (error) return {path, -1, 0};  // no link, or nothing there
    path = next.is_absolute() ? next : folder / next;
  }
  return {path, -1, ELOOP};
}

}  // namespace poinsot::study
