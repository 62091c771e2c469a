// The subcommands. Each adds itself to the command line and stores its exit status where it is asked to.
//
// A command that finds the input wrong throws InputError; main prints it and ends with status 2.
#pragma once

#include <CLI/CLI.hpp>

namespace poinsot::app {

void add_run(CLI::App& app, int& status);
void add_check(CLI::App& app, int& status);
void add_view(CLI::App& app, int& status);
void add_report(CLI::App& app, int& status);
void add_compare(CLI::App& app, int& status);
void add_list(CLI::App& app, int& status);
void add_tables(CLI::App& app, int& status);
void add_make(CLI::App& app, int& status);
void add_scale(CLI::App& app, int& status);
void add_reference(CLI::App& app, int& status);
void add_chart(CLI::App& app, int& status);
void add_advise(CLI::App& app, int& status);
void add_study(CLI::App& app, int& status);
void add_stability(CLI::App& app, int& status);
void add_figures(CLI::App& app, int& status);
void add_completion(CLI::App& app, int& status);
void add_manual(CLI::App& app, int& status);

}  // namespace poinsot::app
