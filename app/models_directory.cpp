#include "app/models_directory.h"

#include <fmt/format.h>

#include "bench/paper/mechanisms.h"
#include "bench/study/program_data.h"
#include "core/input_error.h"

namespace poinsot::app {
using namespace study;
using namespace paper;
namespace fs = std::filesystem;
namespace {

bool holds_models(const fs::path& directory) {
  std::error_code none;  // one that may not be looked into holds none
  return fs::exists(directory / fmt::format("{}.json", kMechanisms.front().file), none);
}

}  // namespace

fs::path models_directory(const std::string& given) {
  if (!given.empty()) {
    if (holds_models(given)) return given;
    throw InputError(fmt::format("--models: found no {}.json in {}, expected a folder with the paper's mechanisms",
                                 kMechanisms.front().file, given));
  }
  const auto places = program_data("models", "models");
  for (const fs::path& place : places)
    if (holds_models(place)) return place;
  throw InputError(fmt::format("the models are neither in {} nor in {}; give their folder with --models DIR",
                               places[0].string(), places[1].string()));
}

}  // namespace poinsot::app
