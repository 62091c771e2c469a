#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/named_files.h"
#include "app/options.h"
#include "app/terminal.h"
#include "bench/records/run_record.h"
#include "bench/records/trajectory_writer.h"
#include "bench/study/reference.h"
#include "bench/study/startable_scene.h"
#include "core/input_error.h"
#include "core/printable.h"
#include "integrators/settings_reader.h"

namespace poinsot::app {
using namespace study;
using namespace records;
namespace {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kRows = 100;  // of the trajectory, where --every does not say

struct ReferenceOptions {
  std::string scene, out, end, every, cache = user_cache().string();
  std::vector<std::string> set;
  int digits = ReferenceSettings{}.digits;
  bool json = false, quiet = false;
};

std::string row(const std::string& name, const PerQuantity& difference) {
  std::string text = fmt::format("  {:<46}", name);
  for (const double d : difference) text += fmt::format("{:>14.2g}", d);
  return text + "\n";
}

void print_agreement(std::FILE* out, const Scene& scene, const Reference& r, const ReferenceSettings& settings) {
  fmt::print(out, "{}: reference at {} times to t = {:g} s\n", printable(scene.name), r.motion.t.size(), settings.end);
  fmt::print(out, "  {:<46}", "largest difference, relative to the motion");
  for (const auto quantity : kQuantities) fmt::print(out, "{:>14}", quantity);
  fmt::print(out, "\n");
  for (const Reference::Method& m : r.methods)
    if (m.failure.empty())
      fmt::print(out, "{}",
                 row(fmt::format("{} in {}, rtol {:.0e} against {:.0e}", m.integrator, m.formulation, m.loose, m.tight),
                     m.apart));
  const auto others = [&](const auto& print) {
    for (const Reference::Method& m : r.methods)
      if (m.failure.empty() && &m != &r.of()) print(m);
  };
  others([&](const Reference::Method& m) {
    fmt::print(out, "{}",
               row(fmt::format("{} in {} against {} in {}", m.integrator, m.formulation, r.of().integrator,
                               r.of().formulation),
                   m.from_given));
  });
  const std::size_t quantities = kQuantities.size() - r.motion.lambda.front().empty();  // no multipliers, no digits
  others([&](const Reference::Method& m) {
    fmt::print(out, "  {:<46}", fmt::format("digits that agree with {} in {}", m.integrator, m.formulation));
    for (std::size_t k = 0; k < quantities; ++k) fmt::print(out, "{:>14.1f}", digits(m.from_given[k]));
    fmt::print(out, "\n");
  });
  fmt::print(out, "  given is {} in {} with rtol {:.0e}: {}\n", r.of().integrator, r.of().formulation, r.of().tight,
             r.nearest < 0 ? "no other method confirms it" : "its two tolerances are least apart");
}

Json record(const Scene& scene, const Reference& r, const ReferenceSettings& settings, const ColumnsByOption& columns) {
  Json json;
  const auto named = [](const PerQuantity& difference) {
    Json object;
    for (std::size_t k = 0; k < kQuantities.size(); ++k) object[std::string(kQuantities[k])] = difference[k];
    return object;
  };
  json["end"] = settings.end;
  json["every"] = settings.every;
  json["given"] = {{"integrator", r.of().integrator}, {"formulation", r.of().formulation}, {"rtol", r.of().tight}};
  json["confirmed_by_another_method"] = r.nearest >= 0;
  json["agreement"] = named(r.agreement);
  for (const Reference::Method& m : r.methods)
    json["methods"].push_back({{"integrator", m.integrator},
                               {"formulation", m.formulation},
                               {"rtol", {m.loose, m.tight}},
                               {"failure", m.failure},
                               {"difference_of_tolerances", named(m.apart)},
                               {"difference_from_given", named(m.from_given)}});
  for (const auto& [option, names] : columns) json["columns"][option] = names;
  add_origin(json);
  json["scene"] = Json::parse(scene.source, nullptr, true, true);
  return json;
}

int find_motion(const ReferenceOptions& options) {
  ReferenceSettings settings;
  if (options.digits < 4 || options.digits > 12)
    throw InputError(fmt::format("--digits: found {}, expected a whole number from 4 to 12", options.digits));
  settings.digits = options.digits;
  const Scene scene = read_startable_scene(options.scene, values_set(options.set));
  settings.end = end_time(options.end, scene);
  Settings every;
  if (!options.every.empty()) set_setting(*find_setting("every"), options.every, every);
  settings.every = every.every > 0 ? every.every : settings.end / kRows;
  std::optional<TrajectoryWriter> trajectory;
  std::optional<OutputFile> beside;
  const fs::path record_file = record_beside(options.out);
  refuse_overwriting({{"the scene", options.scene}}, {{"--out", options.out}, {"the record", record_file}});
  if (!options.out.empty()) trajectory.emplace(options.out, scene, TrajectoryContent(scene));
  if (!record_file.empty()) beside.emplace(record_file);

  std::vector<std::string> notices = scene.notices;
  const Reference r = reference(scene, settings, Cache(options.cache), notices);
  for (const Reference::Method& m : r.methods)
    if (!m.failure.empty() && r.given >= 0)
      notices.push_back(fmt::format("{} in {} gives no reference: {}", m.integrator, m.formulation, m.failure));
  if (!options.quiet)
    for (const std::string& notice : notices) print_notice(with_lines_of(options.scene, notice));
  if (r.given < 0) {
    print_error(with_lines_of(options.scene, why_none(r)));
    return kNumericsFailed;
  }
  if (trajectory) {
    for (std::size_t k = 0; k < r.motion.t.size(); ++k) trajectory->write(r.motion.t[k], r.motion.bodies[k]);
    trajectory->file().complete();
  }
  ColumnsByOption columns;
  if (trajectory && is_npy(options.out)) columns.emplace_back("--out", trajectory->columns());
  const Json told = record(scene, r, settings, columns);
  if (beside) {
    beside->write(told.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    beside->complete();
  }
  if (trajectory) trajectory->file().commit();
  if (beside) beside->commit();
  std::FILE* const out = text_stream({options.out});
  if (options.json)
    print_json(out, told);
  else if (!options.quiet)
    print_agreement(out, scene, r, settings);
  return kDone;
}

}  // namespace

void add_reference(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "reference", "compute a motion as exactly as can be, and how exact it is", find_motion);
  add_scene(command, options.scene, options.set);
  add_end(command, options.end);
  command.add_option("--every", options.every, fmt::format("time between output rows, s (default: end/{})", kRows))
      ->type_name("X");
  command
      .add_option("--digits", options.digits,
                  fmt::format("decimal digits to aim at, 4 to 12 (default {})", options.digits))
      ->type_name("N");
  command
      .add_option("--out", options.out,
                  "the motion, as `poinsot run` writes it: CSV, or .npy; beside it .run.json with the evidence")
      ->type_name("FILE.csv");
  add_cache(command, options.cache);
  add_json(command, options.json);
  add_quiet(command, options.quiet);
  command.footer(
      "Several methods, each at two tolerances: what they differ by is stated for positions, velocities, accelerations "
      "and\n"
      "multipliers. Kept by the content of scene, settings and program, and not computed twice.");
}

}  // namespace poinsot::app
