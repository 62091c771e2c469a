#include "core/provenance.h"

#include <fmt/core.h>
#include <klu.h>
#include <sundials/sundials_config.h>
#ifdef POINSOT_UMFPACK
#include <umfpack.h>
#endif

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/blas.h"
#include "poinsot_build.h"   // written by cmake/provenance.cmake when configuring
#include "poinsot_commit.h"  // written by cmake/commit.cmake at every build

namespace poinsot {
namespace {

std::string dotted(int major, int minor, int patch) {
  return fmt::format("{}.{}.{}", major, minor, patch);
}

std::vector<Library> libraries() {
  return {
      {"Eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"SuiteSparse", dotted(SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION, SUITESPARSE_SUBSUB_VERSION)},
      {"KLU", dotted(KLU_MAIN_VERSION, KLU_SUB_VERSION, KLU_SUBSUB_VERSION)},
      {"BTF", dotted(BTF_MAIN_VERSION, BTF_SUB_VERSION, BTF_SUBSUB_VERSION)},
      {"AMD", dotted(AMD_MAIN_VERSION, AMD_SUB_VERSION, AMD_SUBSUB_VERSION)},
      {"COLAMD", dotted(COLAMD_MAIN_VERSION, COLAMD_SUB_VERSION, COLAMD_SUBSUB_VERSION)},
#ifdef POINSOT_UMFPACK
      {"UMFPACK", dotted(UMFPACK_MAIN_VERSION, UMFPACK_SUB_VERSION, UMFPACK_SUBSUB_VERSION)},
#endif
      {"SUNDIALS", SUNDIALS_VERSION},
      {"nlohmann-json", dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"fmt", dotted(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"CLI11", build::cli11},
      {"BLAS", blas()},
  };
}

}  // namespace

const Provenance& provenance() {
  static const Provenance the{build::version, build::commit, build::dirty, build::compiler,
                              build::flags,   build::type,   libraries()};
  return the;
}

std::string processor() {
  // x86 calls it "model name", POWER "cpu", some ARM kernels "Processor" or "Hardware"; others name no model at all.
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    for (const std::string key : {"model name", "cpu\t", "Processor", "Hardware"}) {
      const auto colon = line.find(": ");
      if (line.starts_with(key) && colon != std::string::npos) return line.substr(colon + 2);
    }
  }
  return "unknown";
}

}  // namespace poinsot
