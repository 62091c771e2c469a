#include "bench/cases/ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "core/input_error.h"

namespace poinsot::cases {
namespace fs = std::filesystem;

bool started_by_launcher() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (const char* value = std::getenv(variable); value && *value) return true;
  return false;
}

Launched launched() {
  // Of Open MPI, of MPICH and its kin, of srun with PMIx.
  constexpr std::pair<const char*, const char*> kVariables[] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                                                {"PMI_RANK", "PMI_SIZE"},
                                                                {"PMIX_RANK", "SLURM_STEP_NUM_TASKS"}};
  const auto number = [](const char* variable) {
    const char* const value = std::getenv(variable);
    return value ? std::atoi(value) : 0;
  };
  for (const auto& [rank, processes] : kVariables)
    if (number(processes) > 1) return {number(rank), number(processes)};
  return {};
}

std::unique_ptr<Ranks> join_ranks() {
  const std::string module = POINSOT_MPI_MODULE;
  if (module.empty())
    throw InputError(
        "several processes were started together, but the program was built without MPI; expected a build with it "
        "(Debian: libopenmpi-dev), or --shard I/N");
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  const fs::path installed = program.parent_path() / POINSOT_INSTALLED_MODULES / fs::path(module).filename();
  const fs::path file = fs::exists(installed, none) ? installed : fs::path(module);
  // Open MPI's own modules look for its symbols among the global ones.
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (!library) throw InputError(fmt::format("MPI cannot be used: {}", dlerror()));
  const auto join = reinterpret_cast<Ranks* (*)()>(dlsym(library, "poinsot_join_ranks"));
  if (!join) throw InputError(fmt::format("MPI cannot be used: {}", dlerror()));
  return std::unique_ptr<Ranks>(join());
}

}  // namespace poinsot::cases
