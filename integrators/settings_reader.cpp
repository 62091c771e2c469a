#include "integrators/settings_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/expression.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/places.h"
#include "integrators/integrator.h"

namespace poinsot {
namespace {

// Where a setting was found, and how to speak of it when it is wrong.
struct Source {
  const JsonValue* place = nullptr;      // in a file, or
  const SettingEntry* option = nullptr;  // on the command line, with
  std::string_view text;                 // its value

  [[noreturn]] void expected(std::string_view allowed) const {
    if (place) place->expected(allowed);
    throw InputError(fmt::format("{}: found \"{}\", expected {}", option_name(*option), text, allowed));
  }
};

std::string one_of(const SettingEntry& entry) {
  return fmt::format("one of {}", fmt::join(entry.names(), ", "));
}

std::string allowed_number(const SettingEntry& entry) {
  if (std::holds_alternative<int Settings::*>(entry.member)) return "a whole number, at least 1";
  if (std::isfinite(entry.most)) return fmt::format("a number from {:.2g} to {:g}", entry.least, entry.most);
  if (entry.least > 0) return fmt::format("a number, at least {:.2g}", entry.least);
  return entry.zero_allowed ? "a number, at least 0" : "a number greater than 0";
}

void set_switch(const SettingEntry& entry, bool value, Settings& settings) {
  if (const auto* flag = std::get_if<bool Settings::*>(&entry.member))
    settings.*(*flag) = value;
  else
    settings.assembly = value ? Assembly::always : Assembly::never;
}

bool in_range(const SettingEntry& entry, double value) {
  return std::isfinite(value) && value >= entry.least && value <= entry.most && (value != 0 || entry.zero_allowed);
}

void set_number(const SettingEntry& entry, double value, const Source& source, Settings& settings) {
  constexpr double kBeyondMeasure = 1e-100;  // a bound that says nothing to one who gives 0
  const bool positive = value <= 0 && entry.least > 0 && entry.least < kBeyondMeasure;
  if (!in_range(entry, value)) source.expected(positive ? "a number greater than 0" : allowed_number(entry));
  if (const auto* number = std::get_if<double Settings::*>(&entry.member)) {
    settings.*(*number) = value;
  } else if (const auto* optional = std::get_if<std::optional<double> Settings::*>(&entry.member)) {
    settings.*(*optional) = value;
  } else if (std::holds_alternative<const MethodParameter*>(entry.member)) {
    settings.parameters.insert_or_assign(std::string(entry.key), value);
  } else {
    if (value != std::floor(value) || value > 1e9) source.expected(allowed_number(entry));
    settings.*std::get<int Settings::*>(entry.member) = static_cast<int>(value);
  }
}

void set_name(const SettingEntry& entry, std::string_view name, const Source& source, Settings& settings) {
  const std::vector<std::string> names = entry.names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) source.expected(one_of(entry));
  if (const auto* text = std::get_if<std::string Settings::*>(&entry.member)) settings.*(*text) = name;
  if (const auto* analysis = std::get_if<Analysis Settings::*>(&entry.member))
    settings.*(*analysis) = static_cast<Analysis>(found - names.begin());
}

bool is_parameter(std::string_view name, const Settings& settings) {
  const std::vector<std::string_view> of = integrators_with(name);
  return settings.analysis == Analysis::dynamics && std::ranges::find(of, settings.integrator) != of.end();
}

void refuse_parameters_of_others(const Settings& settings) {
  for (const auto& [name, value] : settings.parameters) {
    if (is_parameter(name, settings)) continue;
    const std::vector<std::string_view> of = integrators_with(name);
    if (of.empty()) throw SettingError(name, "no integrator has a parameter of this name");
    const std::string subject =
        settings.analysis == Analysis::kinematics ? "kinematics" : fmt::format("integrator '{}'", settings.integrator);
    throw SettingError(name, fmt::format("no parameter of {}; it is one of {}", subject, fmt::join(of, ", ")));
  }
}

}  // namespace

void check_numbers(const Settings& settings) {
  refuse_parameters_of_others(settings);
  for (const SettingEntry& entry : setting_entries()) {
    const std::optional<double> value = number_of(entry, settings);
    if (value && !in_range(entry, *value))
      throw SettingError(entry.key, fmt::format("found {}, expected {}", *value, allowed_number(entry)));
  }
  check_counts(settings);
}

void check_counts(const Settings& settings) {
  constexpr double kMost = 1e15;  // what a double counts without a gap, and more than any run comes to
  const auto check = [&](std::string_view key, double length, std::string_view of) {
    if (const double count = settings.end / length; !(count < kMost)) {
      throw SettingError(
          key, fmt::format("found {:g} s with end {:g} s, which are {:g} {}, expected at most 1e15; try a larger {}",
                           length, settings.end, count, of, key == "step" ? key : "one"));
    }
  };
  if (!chooses_steps(settings)) check("step", settings.step, "steps");
  if (settings.every > 0) check("every", settings.every, "output times");
}

void check_formulation(const Settings& settings) {
  if (settings.analysis == Analysis::kinematics) return;
  if (const auto refusal = refusal_of(integrators().require(settings.integrator), settings.formulation))
    throw SettingError("formulation",
                       fmt::format("integrator '{}' refuses formulation '{}': {}", settings.integrator,
                                   refusal->formulation, refusal->why),
                       "integrator");
}

void set_setting(const SettingEntry& entry, std::string_view text, Settings& settings) {
  const Source source{nullptr, &entry, text};
  if (is_switch(entry)) {
    if (text != "true" && text != "false") source.expected("true or false");
    return set_switch(entry, text == "true", settings);
  }
  if (entry.names) return set_name(entry, text, source, settings);
  double value = 0;
  try {
    value = Expression::parse_constant(text).at(0.0).f;
  } catch (const ExpressionError& error) {
    throw InputError(fmt::format("{}: found \"{}\" ({}), expected {}", option_name(entry), text, error.what(),
                                 allowed_number(entry)));
  }
  set_number(entry, value, source, settings);
}

void read_settings(const std::filesystem::path& file, Settings& settings) {
  parse_settings(read_text(file.string()), shown_input(file.string()), settings);
}

void parse_settings(std::string_view text, std::string_view file, Settings& settings) {
  with_lines_of_errors(text, [&] {
    const JsonDocument document(text, file);
    read_settings(document.root(), settings);
  });
}

void read_settings(const JsonValue& object, Settings& settings) {
  std::vector<std::string_view> keys;
  for (const SettingEntry& entry : setting_entries()) keys.push_back(entry.key);
  object.keys("a solver configuration", keys);
  for (const SettingEntry& entry : setting_entries())
    if (const std::optional<JsonValue> value = object.optional(entry.key)) read_setting(entry, *value, settings);
}

void read_setting(const SettingEntry& entry, const JsonValue& value, Settings& settings) {
  const Source source{&value, nullptr, {}};
  if (is_switch(entry))
    set_switch(entry, value.boolean(), settings);
  else if (entry.names)
    set_name(entry, value.string(one_of(entry)), source, settings);
  else
    set_number(entry, value.number(allowed_number(entry)), source, settings);
}

std::string to_json(const Settings& settings) {
  nlohmann::ordered_json json;
  for (const SettingEntry& entry : setting_entries()) {
    const bool of_others =
        std::holds_alternative<const MethodParameter*>(entry.member) && !is_parameter(entry.key, settings);
    if (of_others) continue;
    if (const auto* count = std::get_if<int Settings::*>(&entry.member))
      json[entry.key] = settings.*(*count);
    else if (const auto* flag = std::get_if<bool Settings::*>(&entry.member))
      json[entry.key] = settings.*(*flag);
    else if (entry.names)
      json[entry.key] = value_text(entry, settings);
    else if (const std::optional<double> number = number_of(entry, settings))
      json[entry.key] = *number;
    else if (settings.assembly != Assembly::small)  // the default is what is done where the key is left out
      json[entry.key] = settings.assembly == Assembly::always;
  }
  return json.dump(2);
}

void fit_time_grid(Settings& settings, std::vector<std::string>& notices) {
  check_counts(settings);
  if (chooses_steps(settings)) return;
  // of the ratio, relative: far above the error of decimal fractions, far below a step
  constexpr double rounding = 1e-9;
  const double ratio = settings.end / settings.step;
  double steps = std::max(1.0, std::round(ratio));
  if (std::abs(ratio - steps) > rounding * steps) {
    steps = std::ceil(ratio);
    const double shortened = settings.end / steps;
    notices.push_back(
        fmt::format("end {} s is not a multiple of step {} s: the step is shortened to {} s, so that step {} "
                    "lands on the end exactly",
                    settings.end, settings.step, shortened, static_cast<std::int64_t>(steps)));
    settings.step = shortened;
  }
  if (settings.every == 0) return;
  const double rows = settings.every / settings.step;
  const double nearest = std::max(1.0, std::round(rows));
  if (std::abs(rows - nearest) > rounding * nearest)
    throw SettingError("every", fmt::format("found {} s, expected a multiple of the step {} s; try {}", settings.every,
                                            settings.step, nearest * settings.step));
}

}  // namespace poinsot
