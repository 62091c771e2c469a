#include "app/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/terminal.h"
#include "bench/cases/ranks.h"
#include "bench/paper/mechanisms.h"
#include "bench/study/name_list.h"
#include "bench/study/natural_end.h"
#include "bench/study/program_data.h"
#include "core/input_error.h"
#include "integrators/settings_reader.h"

namespace poinsot::app {
namespace fs = std::filesystem;
namespace {

std::string option_of(std::string_view setting) {
  return option_name(*find_setting(setting)) + "s";
}

bool holds_models(const fs::path& directory) {
  std::error_code none;  // one that may not be looked into holds none
  return fs::exists(directory / fmt::format("{}.json", paper::kMechanisms.front().file), none);
}

}  // namespace

void note_repetition(const std::string& command) {
  const cases::Launched here = cases::launched();
  if (command != "study" && here.processes > 1 && here.rank == 0)
    print_notice(
        fmt::format("{} processes were started and each of them does all of `poinsot {}`: `poinsot study` alone "
                    "divides its work among processes; start one",
                    here.processes, command));
}

void add_scene(CLI::App& command, std::string& file, std::vector<std::string>& set) {
  command.add_option("scene", file, "scene file; -: the standard input")->required()->type_name("SCENE");
  add_set(command, set);
}

void add_set(CLI::App& command, std::vector<std::string>& given) {
  command.add_option("--set", given, "another value of a parameter of the scene; may come several times")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

ParameterValues values_set(const std::vector<std::string>& given) {
  ParameterValues values;
  for (const std::string& one : given) {
    const std::size_t equals = one.find('=');
    if (equals == one.npos || equals == 0 || equals + 1 == one.size())
      throw InputError(fmt::format("--set: found '{}', expected NAME=VALUE", one));
    const std::string name = one.substr(0, equals);
    if (!values.emplace(name, one.substr(equals + 1)).second)
      throw InputError(fmt::format("--set: found '{}' twice, expected it once", name));
  }
  return values;
}

void add_end(CLI::App& command, std::string& end) {
  command.add_option("--end", end, "end time, s (default: until the quickest body has turned through some 15 rad)")
      ->type_name("X");
}

double end_time(const std::string& given, const Scene& scene) {
  if (given.empty()) return study::natural_end(scene);
  Settings settings;
  set_setting(*find_setting("end"), given, settings);
  return settings.end;
}

void add_cache(CLI::App& command, std::string& folder) {
  command.add_option("--cache", folder, "folder where references are kept (default $XDG_CACHE_HOME/poinsot)")
      ->type_name("DIR");
}

void add_models(CLI::App& command, std::string& folder) {
  command.add_option("--models", folder, "folder with the mechanisms (default: those that came with the program)")
      ->type_name("DIR");
}

fs::path models_directory(const std::string& given) {
  if (!given.empty()) {
    if (holds_models(given)) return given;
    throw InputError(fmt::format("--models: found no {}.json in {}, expected a folder with the paper's mechanisms",
                                 paper::kMechanisms.front().file, given));
  }
  const auto places = study::program_data("models", "models");
  for (const fs::path& place : places)
    if (holds_models(place)) return place;
  throw InputError(fmt::format("the models are neither in {} nor in {}; give their folder with --models DIR",
                               places[0].string(), places[1].string()));
}

void add_out_folder(CLI::App& command, std::string& folder, std::string_view what) {
  command.add_option("--out", folder, fmt::format("folder for {} (default {})", what, folder))->type_name("DIR");
}

void add_json(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "say it as JSON");
}

void add_quiet(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet", quiet, "nothing but errors");
}

void add_repetitions(CLI::App& command, int& repetitions, std::string_view what) {
  command.add_option("--repetitions", repetitions, fmt::format("timed runs of {} (default {})", what, repetitions))
      ->type_name("N");
}

void require_positive(std::string_view option, int value) {
  if (value < 1) throw InputError(fmt::format("{}: found {}, expected a whole number, at least 1", option, value));
}

std::string all_names(std::string_view setting) {
  return fmt::format("{}", fmt::join(find_setting(setting)->names(), ","));
}

void add_names(CLI::App& command, std::string_view setting, std::string& list) {
  command
      .add_option(option_of(setting), list,
                  fmt::format("with commas between: {} (default {})", fmt::join(find_setting(setting)->names(), ", "),
                              list == all_names(setting) ? "all" : list))
      ->type_name("NAMES");
}

std::vector<std::string> names_given(std::string_view setting, const std::string& list) {
  return study::names_in(option_of(setting), list, find_setting(setting)->names());
}

}  // namespace poinsot::app
