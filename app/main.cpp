#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands.h"
#include "app/large_pages.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/study/output_file.h"
#include "bench/study/temporary_file.h"
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

// But for names of one letter.
std::string in_small_letters(std::string word) {
  if (word.size() > 1)
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  return word;
}

// " SCENE --out FILE.html": what a command cannot do without.
std::string required_arguments(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->get_required(); })) {
    std::string name =
        option->get_positional() ? option->get_name(true) : option->get_name() + " " + option->get_type_name();
    if (option->get_positional())
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    text += " " + name;
  }
  return text;
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
    const std::size_t option = what.find(": ") + 2, at = what.find(" = ");
    const std::string value = what.substr(at + 3);
    const bool whole = value.find_first_not_of("0123456789", value.starts_with('-') ? 1 : 0) == value.npos;
    what = fmt::format("{}: found \"{}\", expected a {}whole number", what.substr(option, at - option), value,
                       whole ? "smaller " : "");
  } else if (!unknown.empty()) {
    const auto option = std::find_if(unknown.begin(), unknown.end(), [](const auto& word) { return word[0] == '-'; });
    what = option != unknown.end() ? fmt::format("{}: unknown option", *option)
                                   : fmt::format("found \"{}\", expected nothing more", unknown.front());
  } else if (dynamic_cast<const CLI::RequiredError*>(&error)) {
    what = fmt::format("found no {}, expected {}{}", in_small_letters(what.substr(0, what.find(' '))), command,
                       required_arguments(*used.front()));
  }
  return fmt::format("{}; see {} --help", what, command);
}

// Files, folders and lists whose name is empty, as of a variable of the shell that is not set, are not those that were
// left out.
void refuse_nothing(CLI::Option& option) {
  const std::string type = option.get_type_name();
  const char* expected = type == "DIR"                                                    ? "a folder"
                         : type == "NAMES"                                                ? "names"
                         : type.starts_with("FILE") || type == "SCENE" || type == "STUDY" ? "a file"
                                                                                          : nullptr;
  if (!expected) return;
  option.check([expected](const std::string& value) {
    return value.empty() ? fmt::format("found \"\", expected {}", expected) : std::string();
  });
}

// A descriptor that was closed would become that of the next file opened. What is put in its place takes nothing and
// gives nothing, so that text that is lost is noticed.
void hold_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0) (void)!open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

constexpr const char* kNoMemory = "the memory does not suffice";

// Where an exception can be handed on to nobody, memory that ran out included.
[[noreturn]] void end_at_once() {
  study::remove_unfinished();
  const char* what = "an internal error";
  try {
    if (const std::exception_ptr now = std::current_exception()) std::rethrow_exception(now);
  } catch (const std::bad_alloc&) {
    what = kNoMemory;
  } catch (...) {
  }
  for (const char* text : {"poinsot: ", what, "\n"})
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  _exit(app::kNumericsFailed);
}

int parse_and_run(CLI::App& app, int argc, char** argv, const int& status) {
  using namespace poinsot::app;
  try {
    hold_blas_to_one_thread();
    app.parse(argc, argv);
  } catch (const CLI::Success& asked_for_help) {
    return app.exit(asked_for_help);
  } catch (const CLI::ParseError& error) {
    print_error(usage_error(app, error));
    return kWrongInput;
  }
  return status;
}

// The exit status, whatever happens.
int run_program(CLI::App& app, int argc, char** argv, const int& status) {
  using namespace poinsot::app;
  try {
    const int ended = parse_and_run(app, argc, argv, status);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return ended;
    print_error(fmt::format("standard output: cannot be written: {}", std::strerror(errno)));
    return ended == kDone ? kNumericsFailed : ended;
  } catch (const InputError& error) {
    print_error(error.what());
    return kWrongInput;
  } catch (const std::filesystem::filesystem_error& error) {  // a folder that may not be read, a loop of links
    print_error(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    return kWrongInput;
  } catch (const std::system_error& error) {  // of fmt::print
    print_error(fmt::format("standard output: cannot be written: {}", error.code().message()));
  } catch (const study::OutputError& error) {
    print_error(error.what());
  } catch (const std::bad_alloc&) {
    print_error(kNoMemory);
  } catch (const std::length_error&) {  // of a container
    print_error(kNoMemory);
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return kNumericsFailed;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace poinsot::app;
  begin_in_large_pages(argv);
  hold_standard_descriptors();
  catch_signals();
  std::set_terminate(end_at_once);
  int status = kDone;
  CLI::App app("Poinsot: constrained rigid multibody dynamics in three formulations", "poinsot");
  app.footer(
      "Exit status: 0 done; 2 the input is wrong and nothing was written; 3 the numerics failed and what was computed\n"
      "up to there is kept, marked incomplete; 128 + n ended by signal n (Ctrl-C 130), which run,\n"
      "chart, study, stability, figures, tables and scale do likewise.");
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  for (const auto add :
       {add_run, add_check, add_view, add_report, add_compare, add_list, add_tables, add_make, add_scale, add_reference,
        add_chart, add_advise, add_study, add_stability, add_figures, add_completion, add_manual})
    add(app, status);
  for (CLI::App* command : app.get_subcommands({}))
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() == 0) option->disable_flag_override();
      refuse_nothing(*option);
    }

  return run_program(app, argc, argv, status);
}
