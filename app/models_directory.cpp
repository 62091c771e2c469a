#include "app/models_directory.h"

#include <fmt/format.h>

#include "app/paper_figures.h"
#include "core/input_error.h"

namespace poinsot::app {
namespace fs = std::filesystem;
namespace {

bool holds_models(const fs::path& directory) {
  return fs::exists(directory / fmt::format("{}.json", kMechanisms.front().file));
}

}  // namespace

fs::path models_directory(const std::string& given) {
  if (!given.empty()) {
    if (holds_models(given)) return given;
    throw InputError(fmt::format("--models: found no {}.json in {}, expected a folder with the paper's mechanisms",
                                 kMechanisms.front().file, given));
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = (program.parent_path() / POINSOT_INSTALLED_MODELS).lexically_normal();
  if (!error && holds_models(installed)) return installed;
  if (holds_models(POINSOT_SOURCE_MODELS)) return POINSOT_SOURCE_MODELS;
  throw InputError(fmt::format("the models are neither in {} nor in {}; give their folder with --models DIR",
                               installed.string(), POINSOT_SOURCE_MODELS));
}

}  // namespace poinsot::app
