#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/terminal.h"
#include "bench/study/output_file.h"
#include "core/blas.h"
#include "core/input_error.h"
#include "core/provenance.h"

namespace {

using namespace poinsot;

std::string version_text() {
  const Provenance& origin = provenance();
  return fmt::format("poinsot {} (commit {}{}, {})", origin.version, origin.commit.substr(0, 12),
                     origin.dirty ? ", modified" : "", origin.compiler);
}

// What is wrong with the command line, in the words of all other messages.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const auto used = app.get_subcommands();
  const std::string command = used.empty() ? "poinsot" : "poinsot " + used.front()->get_name();
  const std::vector<std::string> unknown = app.remaining(true);
  std::string what = error.what();
  if (used.empty()) {
    std::vector<std::string> names;
    for (const CLI::App* subcommand : app.get_subcommands({})) names.push_back(subcommand->get_name());
    what = fmt::format("found {}, expected one of {}", unknown.empty() ? "no command" : '"' + unknown.front() + '"',
                       fmt::join(names, ", "));
  } else if (const std::size_t flag = what.find(" was given"); flag != std::string::npos) {
    what = fmt::format("--{}: expected no value", what.substr(0, flag));
  } else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) {
    what = fmt::format("{}: expected one value, once", what.substr(0, what.find(':')));
  } else if (dynamic_cast<const CLI::ConversionError*>(&error)) {  // "Could not convert: --bodies = x"
    const std::size_t option = what.find(": ") + 2, value = what.find(" = ");
    what = fmt::format("{}: found \"{}\", expected a whole number", what.substr(option, value - option),
                       what.substr(value + 3));
  } else if (!unknown.empty()) {
    const auto option = std::find_if(unknown.begin(), unknown.end(), [](const auto& word) { return word[0] == '-'; });
    what = option != unknown.end() ? fmt::format("{}: unknown option", *option)
                                   : fmt::format("found \"{}\", expected nothing more", unknown.front());
  } else if (dynamic_cast<const CLI::RequiredError*>(&error)) {
    std::string word = what.substr(0, what.find(' ')), place = word;
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    std::transform(place.begin(), place.end(), place.begin(), [](unsigned char c) { return std::toupper(c); });
    what = fmt::format("found no {}, expected {} {}", word, command, place);
  }
  return fmt::format("{}; see {} --help", what, command);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace poinsot::app;
  int status = kDone;
  CLI::App app("Poinsot: constrained rigid multibody dynamics in three formulations", "poinsot");
  app.footer(
      "Exit status: 0 done; 2 the input is wrong and nothing was written; 3 the numerics failed and what was computed\n"
      "up to there is kept, marked incomplete.");
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  add_run(app, status);
  add_check(app, status);
  add_view(app, status);
  add_list(app, status);
  add_tables(app, status);
  add_make(app, status);
  add_scale(app, status);
  add_reference(app, status);
  add_chart(app, status);
  add_advise(app, status);
  add_figures(app, status);
  for (CLI::App* command : app.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() == 0) option->disable_flag_override();

  study::remove_unfinished_when_interrupted();
  try {
    hold_blas_to_one_thread();
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    return app.exit(asked_for_help);
  } catch (const CLI::ParseError& error) {
    print_error(usage_error(app, error));
    return kWrongInput;
  } catch (const InputError& error) {
    print_error(error.what());
    return kWrongInput;
  } catch (const std::bad_alloc&) {
    print_error("the memory does not suffice for this scene");
    return kNumericsFailed;
  } catch (const std::exception& error) {
    print_error(error.what());
    return kInternalError;
  }
  return status;
}
