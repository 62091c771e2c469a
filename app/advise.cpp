#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "bench/study/advice.h"
#include "bench/study/measure.h"
#include "bench/study/name_list.h"
#include "bench/study/startable_scene.h"
#include "core/expression.h"
#include "core/input_error.h"
#include "core/printable.h"
#include "integrators/settings_reader.h"

namespace poinsot::app {
using namespace study;
namespace {
using Json = nlohmann::ordered_json;

constexpr std::size_t kListed = 6;  // further methods that reach the accuracy, and that do not

struct AdviseOptions {
  std::string scene, end, of = "position", accuracy = "1e-6", cache = user_cache().string();
  std::vector<std::string> set;
  bool json = false, quiet = false;
};

Asked asked(const AdviseOptions& options) {
  Asked result;
  const auto refuse = [&](const std::string& why) {
    throw InputError(
        fmt::format("--accuracy: found \"{}\"{}, expected a number between 0 and {}", options.accuracy, why, kUseless));
  };
  try {
    result.accuracy = Expression::parse_constant(options.accuracy).at(0.0).f;
  } catch (const ExpressionError& error) {
    refuse(fmt::format(" ({})", error.what()));
  }
  if (!(result.accuracy > 0 && result.accuracy <= kUseless)) refuse("");
  const std::vector<std::string> known(kQuantities.begin(), kQuantities.end());
  for (const std::string& name : names_in("--of", options.of, known))
    result.quantities.push_back(static_cast<std::size_t>(std::find(known.begin(), known.end(), name) - known.begin()));
  return result;
}

void require_multipliers(const Asked& asked, const Scene& scene) {
  for (const std::size_t quantity : asked.quantities)
    if (kQuantities[quantity] == "multiplier" && compile(scene).rows.empty())
      throw InputError("--of: found \"multiplier\", but the scene has no constraints");
}

// As a shell takes it for one word.
std::string shell_word(const std::string& text) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/._-+,=").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string command_line(const AdviseOptions& options, const Case& one) {
  const Settings& s = one.settings;
  std::string line = fmt::format("poinsot run {}", shell_word(options.scene));
  for (const std::string& set : options.set) line += fmt::format(" --set {}", shell_word(set));
  line += fmt::format(" --formulation {}", s.formulation);
  line += s.analysis == Analysis::kinematics ? " --analysis kinematics" : fmt::format(" --integrator {}", s.integrator);
  line += fmt::format(" --linear-solver {}", s.linear_solver);
  if (one.parameter() == "rtol")
    line += fmt::format(" --rtol {}", s.rtol);
  else
    line += fmt::format(" --step {}/{} --tolerance {}", s.end, std::llround(s.end / s.step), s.tolerance);
  return line + fmt::format(" --end {} --every {}/{}", s.end, s.end, kOutputs);
}

std::string parameter_text(const Case& one) {
  return one.parameter() == "rtol" ? fmt::format("rtol {:g}", one.value()) : fmt::format("h = {:.3g} s", one.value());
}

std::string row(const Candidate& c) {
  std::string text =
      fmt::format("  {:<34} {:<16} {:>10.3g}", c.one.method(), parameter_text(c.one), 1e3 * c.measured.seconds);
  for (const double e : c.measured.error)
    text += std::isfinite(e) ? fmt::format(" {:>12.2g}", e) : fmt::format(" {:>12}", "-");
  return text + "\n";
}

void print_table(const std::string& title, std::span<const Candidate> candidates) {
  fmt::print("\n{:<52} {:>10}", title, "time, ms");
  for (const auto quantity : kQuantities) fmt::print(" {:>12}", quantity);
  fmt::print("\n");
  for (const Candidate& c : candidates.first(std::min(kListed, candidates.size()))) fmt::print("{}", row(c));
}

void print_advice(const AdviseOptions& options, const Scene& scene, const Asked& asked, const Advice& advice) {
  const Reference& r = advice.reference;
  const Calibration& found = advice.calibration;
  std::vector<std::string_view> of;
  for (const std::size_t quantity : asked.quantities) of.push_back(kQuantities[quantity]);
  const Candidate& best = found.reaching.empty() ? found.others.front() : found.reaching.front();
  const std::string wanted =
      fmt::format("{:g} in {} to t = {:g} s", asked.accuracy, fmt::join(of, ", "), best.one.settings.end);
  fmt::print("{}: ", printable(scene.name));
  if (found.reaching.empty())
    fmt::print("nothing reaches {}; the most accurate was {}, {}\n", wanted, best.one.method(),
               parameter_text(best.one));
  else
    fmt::print("{} costs least with {}, {}: {:.3g} ms\n", wanted, best.one.method(), parameter_text(best.one),
               1e3 * best.measured.seconds);
  fmt::print("\n  {}\n", command_line(options, best.one));

  if (!found.reaching.empty()) print_table("errors of what reaches it, the cheapest of each method", found.reaching);
  if (!found.others.empty()) print_table("not reached, or only at many times the cost", found.others);
  fmt::print("  {:<62}", "resolved by the reference");
  for (const double d : r.agreement) fmt::print(" {:>12.2g}", d);
  fmt::print(
      "\n\nerrors: largest over {} times, relative to the motion; reference: {} in {}, rtol {:g}; time: of the "
      "steps, {}\n",
      kOutputs, r.of().integrator, r.of().formulation, r.of().tight, "on this machine");
  for (const std::string& sentence : advice.waste) fmt::print("costs without mattering: {}\n", sentence);
}

Json named(const PerQuantity& errors) {
  Json object;
  for (std::size_t k = 0; k < kQuantities.size(); ++k) object[std::string(kQuantities[k])] = errors[k];
  return object;
}

Json listed(const AdviseOptions& options, std::span<const Candidate> candidates) {
  Json list = Json::array();
  for (const Candidate& c : candidates) {
    const Settings& s = c.one.settings;
    list.push_back({{"analysis", value_text(*find_setting("analysis"), s)},
                    {"formulation", s.formulation},
                    {"integrator", s.integrator},
                    {"linear_solver", s.linear_solver},
                    {c.one.parameter(), c.one.value()},
                    {"seconds", c.measured.seconds},
                    {"error", named(c.measured.error)},
                    {"command", command_line(options, c.one)}});
  }
  return list;
}

Json advice_json(const AdviseOptions& options, const Scene& scene, const Asked& asked, const Advice& advice,
                 double end) {
  const Reference& r = advice.reference;
  Json of = Json::array(), unresolved = Json::array();
  for (const std::size_t quantity : asked.quantities) of.push_back(kQuantities[quantity]);
  for (const std::size_t quantity : advice.unresolved) unresolved.push_back(kQuantities[quantity]);
  return {{"scene", scene.name},
          {"end", end},
          {"accuracy", asked.accuracy},
          {"of", of},
          {"reached", !advice.calibration.reaching.empty()},
          {"reaching", listed(options, advice.calibration.reaching)},
          {"others", listed(options, advice.calibration.others)},
          {"reference",
           {{"integrator", r.of().integrator},
            {"formulation", r.of().formulation},
            {"rtol", r.of().tight},
            {"resolves", named(r.agreement)},
            {"unresolved", unresolved}}},
          {"costs_without_mattering", advice.waste}};
}

int run_advise(const AdviseOptions& options) {
  const Asked what = asked(options);
  const Scene scene = read_startable_scene(options.scene, values_set(options.set));
  require_multipliers(what, scene);
  const double end = end_time(options.end, scene);
  pin_to_one_core();
  std::vector<std::string> notices = scene.notices;
  const Advice advice = advise(scene, end, what, Cache(options.cache), notices);
  if (!options.quiet)
    for (const std::string& notice : notices) print_notice(with_lines_of(options.scene, notice));
  if (advice.reference.given < 0) {
    print_error(fmt::format("nothing can be checked: {}", with_lines_of(options.scene, why_none(advice.reference))));
    return kNumericsFailed;
  }
  for (const std::size_t quantity : advice.unresolved)
    if (!options.quiet)
      print_notice(fmt::format("{:g} cannot be checked: in {} the reference resolves {:.2g}", what.accuracy,
                               kQuantities[quantity], advice.reference.agreement[quantity]));
  if (options.json)
    print_json(stdout, advice_json(options, scene, what, advice, end));
  else if (!options.quiet)
    print_advice(options, scene, what, advice);
  return advice.calibration.reaching.empty() ? kNumericsFailed : kDone;
}

}  // namespace

void add_advise(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "advise", "find the cheapest way to an accuracy on a scene, by trying", run_advise);
  add_scene(command, options.scene, options.set);
  command
      .add_option("--accuracy", options.accuracy,
                  fmt::format("largest error, relative to the motion (default {})", options.accuracy))
      ->type_name("X");
  command
      .add_option("--of", options.of,
                  fmt::format("what must be so accurate, with commas between: {} (default {})",
                              fmt::join(kQuantities, ", "), options.of))
      ->type_name("NAMES");
  add_end(command, options.end);
  add_cache(command, options.cache);
  add_json(command, options.json);
  add_quiet(command, options.quiet);
  command.footer("Everything named has been run on this scene and compared with a reference (`poinsot reference`).");
}

}  // namespace poinsot::app
