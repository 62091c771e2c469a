#include "core/blas.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <cstdint>
#include <filesystem>

namespace poinsot {
namespace {

// Looked up at run time: which BLAS is there is the system's choice (update-alternatives), not this build's.
template <class Function>
Function* loaded(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

void hold_blas_to_one_thread() {
  if (auto* set = loaded<void(int)>("openblas_set_num_threads")) set(1);
  if (auto* set = loaded<void(int)>("MKL_Set_Num_Threads")) set(1);
  if (auto* set = loaded<void(int)>("omp_set_num_threads")) set(1);
  if (auto* set = loaded<void(std::int64_t)>("bli_thread_set_num_threads")) set(1);
}

std::string blas() {
  Dl_info info{};
  void* const routine = dlsym(RTLD_DEFAULT, "dgemm_");
  if (routine == nullptr || dladdr(routine, &info) == 0 || info.dli_fname == nullptr) return "none";
  std::error_code unresolved;
  std::filesystem::path file = std::filesystem::canonical(info.dli_fname, unresolved);
  if (unresolved) file = info.dli_fname;
  std::string text = file.filename().string();
  std::int64_t threads = 0;  // 0: it has none
  if (auto* get = loaded<int()>("openblas_get_num_threads")) threads = get();
  if (auto* get = loaded<int()>("MKL_Get_Max_Threads")) threads = get();
  if (auto* get = loaded<std::int64_t()>("bli_thread_get_num_threads")) threads = get();
  if (threads > 0) text += fmt::format(", {} {}", threads, threads == 1 ? "thread" : "threads");
  return text;
}

}  // namespace poinsot
