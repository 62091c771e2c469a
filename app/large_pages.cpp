#include "app/large_pages.h"

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace poinsot::app {
namespace {

constexpr std::uintmax_t kLarge = 4u << 20;  // bytes of a scene file: some 10 000 bodies
constexpr const char* kInLargePages = "glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=4194304";

bool is_large(const char* argument) {
  std::error_code none;
  return std::filesystem::is_regular_file(argument, none) && std::filesystem::file_size(argument, none) >= kLarge;
}

}  // namespace

void begin_in_large_pages(char** arguments) {
  constexpr const char* kTunables = "GLIBC_TUNABLES";
  if (std::getenv(kTunables)) return;
  if (!*arguments) return;
  char** argument = arguments + 1;
  const bool grows = *argument && std::string_view(*argument) == "scale";  // up to scenes as large
  while (!grows && *argument && !is_large(*argument)) ++argument;
  if (!*argument) return;
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (failed || setenv(kTunables, kInLargePages, 1) != 0) return;
  execv(program.c_str(), arguments);
}

}  // namespace poinsot::app
