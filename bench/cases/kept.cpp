#include "bench/cases/kept.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/cases/variation.h"
#include "bench/study/motion.h"
#include "core/input_error.h"
#include "core/printable.h"
#include "integrators/settings_reader.h"

namespace poinsot::cases {
namespace {

struct Whole {
  std::string_view name;
  bool Kept::*member;
};
constexpr std::array kWhole{Whole{"violation", &Kept::violation}, Whole{"energy_drift", &Kept::energy_drift},
                            Whole{"counts", &Kept::counts},       Whole{"errors", &Kept::errors},
                            Whole{"notices", &Kept::notices},     Whole{"seconds", &Kept::seconds}};

struct Taken {
  std::string_view name;
  bool Quantity::*member;
};
constexpr std::array kTaken{Taken{"final", &Quantity::final}, Taken{"min", &Quantity::least},
                            Taken{"max", &Quantity::greatest}, Taken{"range", &Quantity::range}};

template <class Table>
std::string listed(const Table& table) {
  std::string text;
  for (const auto& entry : table) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", entry.name);
  return text;
}

void take(Quantity& quantity, const JsonValue& value) {
  const std::string& name = value.string("one of " + listed(kTaken));
  const auto entry = std::ranges::find(kTaken, name, &Taken::name);
  if (entry == kTaken.end()) value.expected("one of " + listed(kTaken));
  if (quantity.*(entry->member)) value.fail(fmt::format("'{}' is taken already, expected it once", name));
  quantity.*(entry->member) = true;
}

Quantity read_quantity(const JsonValue& item) {
  item.keys("a quantity kept", {"column", "name", "take", "at"});
  Quantity quantity;
  const JsonValue column = item.required("column");
  quantity.column = quantity.name = column.string("the name of a column");
  if (const auto name = item.optional("name")) quantity.name = name->string();
  const auto taken = item.optional("take");
  if (taken && taken->is_array()) {
    for (const JsonValue& one : items(*taken, "")) take(quantity, one);
  } else if (taken) {
    take(quantity, *taken);
  }
  const auto at = item.optional("at");
  if (at && at->is_array()) {
    for (const JsonValue& t : items(*at, "an array of times, at least one", 1)) {
      const double time = t.number("a time, s");
      if (!quantity.at.empty() && !(time > quantity.at.back())) t.expected("a time after the one before it");
      quantity.at.push_back(time);
    }
  } else if (at) {
    at->keys("times", {"from", "to", "count"});
    quantity.at = read_range(*at);
    if (quantity.at.back() < quantity.at.front()) at->required("to").expected("a time after \"from\"");
  } else if (!taken) {
    quantity.final = true;
  }
  return quantity;
}

}  // namespace

std::string Kept::at_name(const std::string& quantity, double t) {
  return fmt::format("{}@{:.12g}", quantity, t);
}

std::vector<std::string> Kept::columns() const {
  std::vector<std::string> names;
  for (const Quantity& quantity : quantities) {
    for (const Taken& one : kTaken)
      if (quantity.*(one.member)) names.push_back(fmt::format("{}.{}", quantity.name, one.name));
    for (const double t : quantity.at) names.push_back(at_name(quantity.name, t));
  }
  if (errors)
    for (const std::string_view name : study::kQuantities) names.push_back(fmt::format("error_{}", name));
  if (violation) names.insert(names.end(), {"violation_position", "violation_velocity"});
  if (energy_drift) names.emplace_back("energy_drift");
  if (counts) names.insert(names.end(), {"steps", "newton_iterations", "factorizations"});
  if (seconds)
    names.insert(names.end(),
                 {"seconds", "spread", "seconds_assembly", "seconds_factor", "seconds_solve", "seconds_other"});
  return names;
}

std::string Kept::text() const {
  std::string text = fmt::format("{}{}", errors ? digits : 0, notices ? " notices" : "");
  for (const Quantity& quantity : quantities) text += fmt::format(" {}={}", quantity.name, quantity.column);
  return text;
}

Kept read_kept(const JsonValue& study, bool timed) {
  Kept kept;
  const auto list = study.optional("keep");
  std::size_t number = 0;
  for (const JsonValue& item : list ? items(*list, "an array of what is kept") : std::vector<JsonValue>()) {
    if (item.is_string()) {
      const auto entry = std::ranges::find(kWhole, item.string(), &Whole::name);
      if (entry == kWhole.end()) item.expected(fmt::format("one of {}, or an object with \"column\"", listed(kWhole)));
      kept.*(entry->member) = true;
    } else if (const auto errors = item.optional("errors")) {
      item.keys("errors kept", {"errors"});
      errors->keys("errors", {"digits"});
      const JsonValue digits = errors->required("digits");
      kept.digits = static_cast<int>(read_count(digits, 4, 12));
      kept.errors = true;
    } else {
      kept.quantities.push_back(read_quantity(item));
      kept.quantities.back().item = number;
    }
    ++number;
  }
  if (kept.seconds && !timed)
    list->fail("\"seconds\" are kept, expected \"repetitions\", how many timed runs a case makes");
  if (timed && !kept.seconds) study.fail("\"repetitions\" are for timing, expected \"seconds\" among what is kept");
  return kept;
}

Column require_column(const JsonValue& study, const Quantity& quantity, const Model& model, std::string_view scene) {
  const JsonValue list = study.required("keep"), item = list.at(quantity.item), place = item.required("column");
  try {
    if (const std::optional<Column> column = find_column(model, quantity.column)) return *column;
  } catch (const InputError& error) {
    place.fail(error.what());
  }
  place.fail(fmt::format(
      "scene '{}' has no column '{}', expected one of the trajectory, the reactions or the signals of a run",
      printable(scene), printable(quantity.column)));
}

void require_output_times(const JsonValue& study, const Kept& kept, const Settings& settings) {
  constexpr double kRounding = 1e-9;
  const double spacing = settings.every > 0 ? settings.every : chooses_steps(settings) ? 0 : settings.step;
  for (const Quantity& quantity : kept.quantities) {
    for (const double t : quantity.at) {
      const double n = spacing > 0 ? t / spacing : 0.5;
      if (t == 0 || t == settings.end ||
          (t > 0 && t <= settings.end * (1 + kRounding) && std::abs(n - std::round(n)) <= kRounding * std::max(1.0, n)))
        continue;
      study.required("keep").fail(fmt::format(
          "{} s of '{}' is no output time{}", t, printable(quantity.name),
          spacing > 0 ? fmt::format(", expected a multiple of {} s up to the end, {} s", spacing, settings.end)
                      : ": the integrator chooses its steps, expected \"every\" in \"settings\""));
    }
  }
}

}  // namespace poinsot::cases
