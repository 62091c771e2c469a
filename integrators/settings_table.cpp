#include "integrators/settings_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "formulations/registry.h"
#include "integrators/jacobian_policy.h"
#include "integrators/stopping_test.h"
#include "linsolve/registry.h"

namespace poinsot {
namespace {

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const IntegratorEntry& entry : integrators())
    if (entry.analysis == Analysis::dynamics) names.emplace_back(entry.name);
  return names;
}

using For = SettingEntry::For;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::array kEntries{
    SettingEntry{"analysis", "what is computed", &Settings::analysis,
                 [] {
                   return std::vector<std::string>{"kinematics", "dynamics"};
                 },
                 false},  // as in the enumeration
    SettingEntry{"formulation", "orientation coordinates", &Settings::formulation,
                 [] { return formulations().names(); }, false},
    SettingEntry{"integrator", "time stepping of dynamics", &Settings::integrator, integrator_names, false, 0,
                 kInfinity, For::dynamics},
    SettingEntry{"linear_solver", "solver of the linear systems", &Settings::linear_solver,
                 [] { return linear_solvers().names(); }, false},
    SettingEntry{"linear_system", "matrix that is factored", &Settings::linear_system,
                 [] { return linear_systems().names(); }, false},
    SettingEntry{"jacobian", "matrix of Newton's method", &Settings::jacobian, [] { return jacobians().names(); },
                 false, 0, kInfinity, For::fixed_steps},
    SettingEntry{"stopping", "stopping test of Newton's method in dynamics", &Settings::stopping,
                 [] { return stopping_tests().names(); }, false, 0, kInfinity, For::fixed_steps_of_dynamics},
    SettingEntry{"step", "step size h, s, of integrators with fixed steps", &Settings::step, nullptr, false, 0,
                 kInfinity, For::fixed_steps},
    SettingEntry{"end", "end time, s; the last step lands on it", &Settings::end, nullptr, false, kLeastEnd},
    SettingEntry{"tolerance", "Newton: size of the correction, see stopping; in kinematics its 2-norm",
                 &Settings::tolerance, nullptr, false, 0, kInfinity, For::fixed_steps},
    SettingEntry{"rtol", "relative tolerance of integrators with error control", &Settings::rtol, nullptr, false,
                 kLeastRtol, 1, For::error_control},
    SettingEntry{"atol", "absolute tolerance of integrators with error control", &Settings::atol, nullptr, false, 0,
                 kInfinity, For::error_control},
    SettingEntry{"max_iterations", "Newton: iterations allowed in a step", &Settings::max_iterations, nullptr, false, 0,
                 kInfinity, For::fixed_steps},
    SettingEntry{"retry", "do a step of fixed size that fails in halves of it, and halves of those", &Settings::retry,
                 nullptr, false, 0, kInfinity, For::fixed_steps_of_dynamics, "end the run there"},
    SettingEntry{"every", "time between output rows, s; 0: every step", &Settings::every, nullptr, true},
    SettingEntry{"assemble", "project an initial state that violates the constraints", &Settings::assembly, nullptr,
                 false, 0, kInfinity, For::all, "refuse such a state"},
};

std::vector<SettingEntry> make_entries() {
  std::vector<SettingEntry> entries(std::begin(kEntries), std::end(kEntries));
  for (const IntegratorEntry& integrator : integrators()) {
    for (const MethodParameter& parameter : integrator.parameters) {
      if (std::ranges::find(entries, parameter.name, &SettingEntry::key) != entries.end()) continue;
      entries.push_back({parameter.name,
                         fmt::format("{}: {}", fmt::join(integrators_with(parameter.name), ", "), parameter.about),
                         &parameter, nullptr, true, parameter.least, parameter.most});
    }
  }
  return entries;
}

}  // namespace

std::vector<std::string_view> integrators_with(std::string_view parameter) {
  std::vector<std::string_view> names;
  for (const IntegratorEntry& entry : integrators())
    if (std::ranges::find(entry.parameters, parameter, &MethodParameter::name) != entry.parameters.end())
      names.push_back(entry.name);
  return names;
}

bool chooses_steps(const Settings& settings) {
  const IntegratorEntry* integrator = integrators().find(settings.integrator);
  return settings.analysis == Analysis::dynamics && integrator && integrator->controls_error;
}

std::string ignored_by(const SettingEntry& entry, const Settings& settings) {
  if (entry.meant_for == For::all) return "";
  const bool controls_error = chooses_steps(settings);
  if (settings.analysis == Analysis::kinematics) {
    if (entry.meant_for == For::fixed_steps) return "";
    return entry.meant_for == For::error_control ? "kinematics, whose accuracy is the tolerance of Newton's method"
                                                 : "kinematics, which finds positions and integrates nothing";
  }
  if (entry.meant_for == For::dynamics || (entry.meant_for == For::error_control) == controls_error) return "";
  return fmt::format(
      "integrator {}, {}", settings.integrator,
      controls_error ? "which controls its error by rtol and atol" : "whose accuracy follows from its step");
}

std::vector<std::string> ignored_sentences(const std::map<std::string, std::vector<std::string>>& places_by_method) {
  std::vector<std::string> sentences;
  for (const auto& [by, places] : places_by_method)
    sentences.push_back(
        fmt::format("{} {} nothing to {}", fmt::join(places, ", "), places.size() == 1 ? "means" : "mean", by));
  return sentences;
}

std::span<const SettingEntry> setting_entries() {
  static const std::vector<SettingEntry> entries = make_entries();
  return entries;
}

const SettingEntry* find_setting(std::string_view key) {
  const auto entry = std::ranges::find(setting_entries(), key, &SettingEntry::key);
  return entry == setting_entries().end() ? nullptr : &*entry;
}

bool is_switch(const SettingEntry& entry) {
  return std::holds_alternative<bool Settings::*>(entry.member) ||
         std::holds_alternative<Assembly Settings::*>(entry.member);
}

std::string option_name(const SettingEntry& entry) {
  std::string name = "--" + std::string(entry.key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::optional<double> number_of(const SettingEntry& entry, const Settings& settings) {
  if (const auto* number = std::get_if<double Settings::*>(&entry.member)) return settings.*(*number);
  if (const auto* count = std::get_if<int Settings::*>(&entry.member)) return settings.*(*count);
  if (const auto* parameter = std::get_if<const MethodParameter*>(&entry.member)) return (*parameter)->of(settings);
  if (std::holds_alternative<std::optional<double> Settings::*>(entry.member)) return settings.absolute_tolerance();
  return {};
}

std::string value_text(const SettingEntry& entry, const Settings& settings) {
  if (const auto* text = std::get_if<std::string Settings::*>(&entry.member)) return settings.*(*text);
  if (const auto* flag = std::get_if<bool Settings::*>(&entry.member)) return fmt::format("{}", settings.*(*flag));
  if (std::holds_alternative<std::optional<double> Settings::*>(entry.member) && !settings.atol) return "rtol/100";
  if (const std::optional<double> number = number_of(entry, settings)) return fmt::format("{}", *number);
  if (entry.names) return entry.names()[static_cast<std::size_t>(settings.analysis)];
  if (settings.assembly == Assembly::small) return "where the violation is small";
  return settings.assembly == Assembly::always ? "true" : "false";
}

}  // namespace poinsot
