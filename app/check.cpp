#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "bench/study/scene_check_text.h"
#include "core/json_document.h"
#include "core/places.h"
#include "core/scene_reader.h"

namespace poinsot::app {
using namespace study;
namespace {
struct CheckOptions {
  std::string scene;
  std::vector<std::string> set;
  bool json = false, quiet = false;
};

int status_of(const SceneCheck& found) {
  if (!found.rank.conflicts.empty() || !found.refusal.empty()) return kWrongInput;
  return found.sound() ? kDone : kNumericsFailed;
}

int run_check(const CheckOptions& options) {
  const Scene scene = read_scene(options.scene, values_set(options.set));
  const SceneCheck found = check_scene(scene);
  const auto placed = [&](std::string_view sentence) { return with_lines_of(options.scene, sentence); };
  if (!options.quiet && !options.json)
    for (const std::string& notice : found.notices) print_notice(placed(notice));
  if (options.json)
    print_json(stdout, check_json(found));
  else if (!options.quiet)
    fmt::print("{}", placed(with_key_paths(check_text(found), scene)));
  if (const int status = status_of(found); status != kDone) {
    print_error(fmt::format("{}: {}", shown_input(options.scene), placed(verdict(found))));
    return status;
  }
  return kDone;
}

}  // namespace

void add_check(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "check",
                  "degrees of freedom, redundant and conflicting constraints, initial state, derivatives", run_check);
  add_scene(command, options.scene, options.set);
  add_json(command, options.json);
  add_quiet(command, options.quiet);
}

}  // namespace poinsot::app
