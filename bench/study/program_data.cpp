#include "bench/study/program_data.h"

namespace poinsot::study {
namespace fs = std::filesystem;

std::array<fs::path, 2> program_data(std::string_view name, std::string_view in_source) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return {(program.parent_path() / POINSOT_INSTALLED_DATA / name).lexically_normal(),
          fs::path(POINSOT_SOURCE_DIR) / in_source};
}

}  // namespace poinsot::study
