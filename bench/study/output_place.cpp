#include "bench/study/output_place.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>

#include "core/input_error.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

std::string why_not_made(const fs::path& folder, const std::error_code& error) {
  std::error_code none;
  for (fs::path part = folder; part.has_relative_path(); part = part.parent_path())
    if (fs::exists(part, none) && !fs::is_directory(part, none))
      return fmt::format("{} is a file; choose another name", part == folder ? "it" : part.string());
  return error.message();
}

}  // namespace

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

std::vector<fs::path> make_folders(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path part = folder; !part.empty() && !fs::exists(part, error); part = part.parent_path())
    missing.push_back(part);
  fs::create_directories(folder, error);
  if (error)
    throw InputError(fmt::format("{}: the folder cannot be made: {}", folder.string(), why_not_made(folder, error)));
  return missing;
}

void remove_folders(const std::vector<fs::path>& folders) {
  std::error_code error;
  for (const fs::path& folder : folders) fs::remove(folder, error);
}

int open_device(const fs::path& file) {
  sockaddr_un address{};
  if (!fs::is_socket(file) || file.native().size() >= sizeof address.sun_path)
    return open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, file.c_str());
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0 || connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
    return descriptor;
  const int why = errno;
  close(descriptor);
  errno = why;
  return -1;
}

}  // namespace poinsot::study
