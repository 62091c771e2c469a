#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "bench/study/output_file.h"
#include "core/input_error.h"
#include "core/projected.h"
#include "core/scene_generator.h"
#include "core/scene_writer.h"

namespace poinsot::app {
using namespace study;
namespace {

struct MakeOptions {
  std::string structure, out;
  int bodies = 100;
  bool quiet = false;
};

std::string structures() {
  return fmt::format("{}", fmt::join(projected(scene_generators(), &SceneGenerator::name), ", "));
}

int make(const MakeOptions& options) {
  const SceneGenerator* generator = find_scene_generator(options.structure);
  if (!generator) {
    throw InputError(fmt::format("STRUCTURE: found \"{}\", expected one of {}", options.structure, structures()));
  }
  constexpr int kMost = 10'000'000;
  if (options.bodies < 1 || options.bodies > kMost) {
    throw InputError(fmt::format("--bodies: found {}, expected a whole number from 1 to {}", options.bodies, kMost));
  }
  OutputFile file(options.out);
  file.write(to_json(generator->make(options.bodies)));
  file.commit();
  return kDone;
}

}  // namespace

void add_make(CLI::App& app, int& status) {
  const auto [command, options] = add_command(app, status, "make", "write a scene of any size: " + structures(), make);
  std::string about;
  for (const SceneGenerator& generator : scene_generators()) {
    about += fmt::format("\n  {}: {}", generator.name, generator.about);
  }
  command.add_option("STRUCTURE", options.structure, "one of:" + about)->required()->type_name("");
  command.add_option("--bodies", options.bodies, fmt::format("at least so many (default {})", options.bodies))
      ->type_name("N");
  command.add_option("--out", options.out, "the scene file (default: -, the standard output)")->type_name("FILE");
  options.out = "-";
  add_quiet(command, options.quiet);
}

}  // namespace poinsot::app
