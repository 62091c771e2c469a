#include "bench/cases/study_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/study/cache.h"
#include "core/input_error.h"
#include "core/projected.h"
#include "integrators/settings_reader.h"

namespace poinsot::cases {
namespace {

// Whatever the scene: names, numbers, the grid of times.
std::string why_refused(Settings& settings, std::vector<std::string>& notices) {
  try {
    check_numbers(settings);
    check_formulation(settings);
    fit_time_grid(settings, notices);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

// The methods that do not look at it, where those of all cases do not.
std::string ignored_by_all(const SettingEntry& entry, const Study& study) {
  std::vector<std::string> methods;
  for (const SettingsChoice& choice : study.settings) {
    if (choice.refused) continue;
    const std::string by = ignored_by(entry, choice.settings);
    if (by.empty()) return "";
    if (std::ranges::find(methods, by) == methods.end()) methods.push_back(by);
  }
  return fmt::format("{}", fmt::join(methods, "; "));
}

// "/vary/2", where the file says that it varies; empty where it does not.
std::string place_of_variation(const SettingEntry& entry, const JsonValue& root) {
  const auto list = root.optional("vary");
  if (!list) return "";
  for (const JsonValue& item : items(*list, "an array of what varies"))
    if (const auto key = item.optional("setting"); key && key->string() == entry.key) return item.path();
  return "";
}

}  // namespace

void vary_setting(Study& study, const JsonValue& item) {
  item.keys("a setting that varies", {"setting", "values", "from", "to", "count", "spacing"});
  const JsonValue key = item.required("setting");
  const SettingEntry* entry = find_setting(key.string("the key of a solver configuration"));
  if (!entry) key.expected(fmt::format("one of {}", fmt::join(projected(setting_entries(), &SettingEntry::key), ", ")));
  if (std::ranges::find(study.settings_varied, entry->key) != study.settings_varied.end())
    key.fail(fmt::format("'{}' varies already, expected another setting", entry->key));
  std::vector<JsonValue> values;
  std::vector<nlohmann::json> range;
  const auto list = item.optional("values");
  if (list) {
    values = items(*list, "an array of values, at least one", 1);
  } else if (item.optional("from")) {
    std::ranges::copy(read_range(item), std::back_inserter(range));
    for (const nlohmann::json& value : range) values.push_back(item.holding(value));
  } else {
    item.expected("\"values\", or \"from\", \"to\" and \"count\"");
  }
  std::vector<SettingsChoice> all;
  for (const SettingsChoice& before : study.settings) {
    for (const JsonValue& value : values) {
      SettingsChoice choice = before;
      read_setting(*entry, value, choice.settings);
      choice.values.push_back(value_text(*entry, choice.settings));
      all.push_back(std::move(choice));
    }
  }
  study.settings_varied.emplace_back(entry->key);
  study.settings = std::move(all);
}

void settle_settings(Study& study, const JsonValue& root) {
  bool any = false;
  std::string first;
  for (SettingsChoice& choice : study.settings) {
    if (study.kept.errors && choice.settings.every == 0) choice.settings.every = choice.settings.end / kErrorTimes;
    std::vector<std::string> notices;
    const std::string why = why_refused(choice.settings, notices);
    choice.refused = !why.empty();
    any = any || why.empty();
    if (first.empty()) first = why;
    for (const std::string& notice : notices)
      if (std::ranges::find(study.notices, notice) == study.notices.end()) study.notices.push_back(notice);
    choice.hash = study::content_hash(to_json(choice.settings));
    for (const StudyScene& one : study.scenes)
      for (const Column& column : one.columns) {
        choice.settings.signals |= column.of == Column::signal;
        choice.settings.reactions |= column.of == Column::reaction;
      }
  }
  if (!any) root.fail(first);
}

std::vector<std::string> ignored_settings(const Study& study, const JsonValue& root) {
  std::map<std::string, std::vector<std::string>> places;  // by who ignores them
  const auto given = root.optional("settings");
  for (const SettingEntry& entry : setting_entries()) {
    const std::string by = ignored_by_all(entry, study), varied = place_of_variation(entry, root);
    if (given && given->optional(entry.key))
      if (const std::string own = varied.empty() ? by : fmt::format("the cases, as {} varies it", varied); !own.empty())
        places[own].push_back(fmt::format("/settings/{}", entry.key));
    if (!varied.empty() && !by.empty()) places[by].push_back(varied);
  }
  return ignored_sentences(places);
}

}  // namespace poinsot::cases
