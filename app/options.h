// Options that mean the same in several commands: one wording and one check. What a variable holds is its default.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene_reader.h"

namespace poinsot::app {

// Of a command that mpirun or the like started several times, as of all but `study`: says so, by one of the processes.
void note_repetition(const std::string& command);

// A subcommand that is done by `run`, whose result is the exit status, and what its options are to fill in.
template <class Options>
std::pair<CLI::App&, Options&> add_command(CLI::App& app, int& status, const std::string& name,
                                           const std::string& about, int (*run)(const Options& options)) {
  CLI::App* const command = app.add_subcommand(name, about);
  const auto options = std::make_shared<Options>();
  command->callback([name, options, run, &status] {
    if (!options->quiet) note_repetition(name);
    status = run(*options);
  });
  return {*command, *options};
}

void add_scene(CLI::App& command, std::string& file, std::vector<std::string>& set);  // with --set
// --set NAME=VALUE, for every command that takes scenes; what it gave, for read_scene(). Throws InputError.
void add_set(CLI::App& command, std::vector<std::string>& given);
ParameterValues values_set(const std::vector<std::string>& given);
void add_end(CLI::App& command, std::string& end);
// The value of --end: natural_end() of bench/study where it is not given. Throws InputError.
double end_time(const std::string& given, const Scene& scene);
void add_cache(CLI::App& command, std::string& folder);  // of references
void add_models(CLI::App& command, std::string& folder);
// The value of --models: where it is not given, the folder of the paper's mechanisms beside an installed program, or in
// the source tree of one that is not. Throws InputError where the place holds no models.
std::filesystem::path models_directory(const std::string& given);
void add_out_folder(CLI::App& command, std::string& folder, std::string_view what);
void add_json(CLI::App& command, bool& json);
void add_quiet(CLI::App& command, bool& quiet);

// "timed runs of `what`"; require_positive() is due.
void add_repetitions(CLI::App& command, int& repetitions, std::string_view what);
// Throws InputError where the value of an option is less than 1.
void require_positive(std::string_view option, int value);

// Several names for a setting, with commas between: --linear-solvers for linear_solver.
std::string all_names(std::string_view setting);
void add_names(CLI::App& command, std::string_view setting, std::string& list);
std::vector<std::string> names_given(std::string_view setting, const std::string& list);

}  // namespace poinsot::app
