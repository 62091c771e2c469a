#include "core/definitions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

#include "core/projected.h"

namespace poinsot {
namespace {

constexpr std::string_view kPoints = "an array of at least 2 points [x, y]";

std::shared_ptr<const Spline> read_table(const std::string& name, const JsonValue& item) {
  item.keys("a table", {"points"});  // that of a file holds its points by now
  const JsonValue points = item.required("points");
  const std::size_t size = points.size(kPoints);
  if (size < 2) points.expected(kPoints);
  std::vector<double> x, y;
  for (std::size_t k = 0; k < size; ++k) {
    const JsonValue point = points.at(k);
    if (point.size("a point [x, y]") != 2) point.expected("a point [x, y]");
    x.push_back(point.at(0).number());
    y.push_back(point.at(1).number());
    if (k > 0 && !(x[k] > x[k - 1]))
      point.at(0).fail(fmt::format("found {}, expected more than {}, the x before it", x[k], x[k - 1]));
  }
  return std::make_shared<const Spline>(name, std::move(x), y);
}

// ", the parameters l, w"; empty where there are none.
template <class Entries>
std::string names_of(const Entries& entries, std::string_view what) {
  if (entries.empty()) return "";
  return fmt::format(", the {}{} {}", what, entries.size() == 1 ? "" : "s",
                     fmt::join(projected(entries, [](const auto& entry) { return entry.first; }), ", "));
}

}  // namespace

Definitions::Definitions(const JsonDocument& document) : root_(document.root(this)) {
  declare("parameters", "parameter", parameters_);
  declare("tables", "table", tables_);
  for (auto& [name, entry] : parameters_) resolve(name, entry);
  for (auto& [name, entry] : tables_) resolve(name, entry);
}

template <class Value>
void Definitions::declare(const char* section, const char* what, Entries<Value>& entries) {
  const std::optional<JsonValue> object = root_.optional(section);
  if (!object) return;
  for (const std::string& name : object->names(fmt::format("an object of {}s by name", what))) {
    const JsonValue item = object->required(name);
    if (const std::string_view taken = Expression::why_no_name(name); !taken.empty())
      item.fail(fmt::format("'{}' is {}, expected another name", name, taken));
    if (parameters_.contains(name)) item.fail(fmt::format("'{}' is a parameter, expected another name", name));
    entries.try_emplace(name);
  }
}

template <class Value, class Read>
void Definitions::resolve(const char* section, const std::string& name, Entry<Value>& entry, Read read) {
  using State = decltype(entry.state);
  if (entry.state == State::read) return;
  const JsonValue object = root_.required(section), item = object.required(name);
  being_read_.push_back(name);
  if (entry.state == State::being_read) {
    const std::span circle(std::ranges::find(being_read_, name), being_read_.end());
    item.fail(
        fmt::format("found a circle, {}; expected a value that does not need itself", fmt::join(circle, " needs ")));
  }
  entry.state = State::being_read;
  entry.value = read(item);
  entry.state = State::read;
  being_read_.pop_back();
}

void Definitions::resolve(const std::string& name, Entry<double>& entry) {
  resolve("parameters", name, entry,
          [](const JsonValue& item) { return item.number("a number or a string holding a constant expression"); });
}

void Definitions::resolve(const std::string& name, Entry<std::shared_ptr<const Spline>>& entry) {
  resolve("tables", name, entry, [&](const JsonValue& item) { return read_table(name, item); });
}

std::optional<double> Definitions::parameter(std::string_view name) {
  ++asked_;
  const auto found = parameters_.find(name);
  if (found == parameters_.end()) return {};
  found->second.used = true;
  resolve(found->first, found->second);
  return found->second.value;
}

std::shared_ptr<const Spline> Definitions::table(std::string_view name) {
  ++asked_;
  const auto found = tables_.find(name);
  if (found == tables_.end()) return {};
  found->second.used = true;
  resolve(found->first, found->second);
  return found->second.value;
}

std::string Definitions::listed() const {
  return names_of(parameters_, "parameter") + names_of(tables_, "table");
}

std::map<std::string, double> Definitions::values() const {
  std::map<std::string, double> values;
  for (const auto& [name, entry] : parameters_) values.emplace(name, entry.value);
  return values;
}

std::vector<std::string> Definitions::unused() const {
  std::vector<std::string> sentences;
  for (const auto& [name, entry] : parameters_)
    if (!entry.used) sentences.push_back(fmt::format("parameter '{}' is used nowhere", name));
  for (const auto& [name, entry] : tables_)
    if (!entry.used) sentences.push_back(fmt::format("table '{}' is used nowhere", name));
  return sentences;
}

}  // namespace poinsot
