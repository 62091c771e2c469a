#include "app/settings_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "core/json_document.h"
#include "core/places.h"

namespace poinsot::app {
namespace {

std::string help_text(const SettingEntry& entry) {
  std::string names;
  if (entry.names) names = fmt::format(": {}", fmt::join(entry.names(), ", "));
  return fmt::format("{}{} (default {})", entry.about, names, value_text(entry, Settings{}));
}

// "--no-retry"
std::string as_given(const SettingEntry& entry, const std::string& text) {
  return is_switch(entry) && text == "false" ? fmt::format("--no-{}", entry.key) : option_name(entry);
}

}  // namespace

void SettingsOptions::add_to(CLI::App& command) {
  command.add_option("--config", config_file_, "solver configuration, JSON with the keys below")->type_name("FILE");
  for (const SettingEntry& entry : setting_entries()) {
    if (is_switch(entry)) {
      const std::string key(entry.key);
      const auto give = [this, &entry](const char* value) {
        return [this, &entry, value] { given_.emplace_back(&entry, value); };
      };
      CLI::Option* on = command.add_flag_callback("--" + key, give("true"), help_text(entry));
      command.add_flag_callback("--no-" + key, give("false"), std::string(entry.otherwise))->excludes(on);
      continue;
    }
    const auto give = [this, &entry](const std::string& text) { given_.emplace_back(&entry, text); };
    command.add_option_function<std::string>(option_name(entry), give, help_text(entry))
        ->type_name(entry.names ? "NAME" : "X");
  }
}

std::string SettingsOptions::first_given() const {
  if (!config_file_.empty()) return "--config";
  return given_.empty() ? "" : option_name(*given_.front().first);
}

bool SettingsOptions::on_command_line(std::string_view key) const {
  return std::ranges::any_of(given_, [&](const auto& one) { return one.first->key == key; });
}

// A file may serve several methods, so one sentence names all its keys that this one does not look at.
void SettingsOptions::tell_ignored_in_file(const Settings& settings, std::vector<std::string>& notices) const {
  const JsonDocument document(read_text(config_file_), shown_input(config_file_));
  const JsonValue root = document.root();
  std::map<std::string, std::vector<std::string>> keys;  // by who ignores them
  for (const SettingEntry& entry : setting_entries())
    if (const std::string by = ignored_by(entry, settings);
        !by.empty() && root.optional(entry.key) && !on_command_line(entry.key))
      keys[by].push_back(fmt::format("/{}", entry.key));
  for (const std::string& sentence : ignored_sentences(keys))
    notices.push_back(fmt::format("{}: {}", shown_input(config_file_), sentence));
}

// Names the option or the place in the configuration file that the value is from; of two that do not go together the
// first that was given.
void SettingsOptions::refuse_where_given(const SettingError& refused) const {
  for (const std::string& key : refused.keys()) {
    if (on_command_line(key)) throw InputError(fmt::format("{}: {}", option_name(*find_setting(key)), refused.why()));
    if (!config_file_.empty()) refuse_in_file(key, refused.why());
  }
}

// Where it stands there.
void SettingsOptions::refuse_in_file(const std::string& key, const std::string& why) const {
  const std::string text = read_text(config_file_);
  with_lines_of_errors(text, [&] {
    const JsonDocument document(text, shown_input(config_file_));
    const JsonValue root = document.root();
    if (const auto value = root.optional(key)) value->fail(why);
  });
}

Settings SettingsOptions::resolve(std::vector<std::string>& notices) const {
  Settings settings;
  if (!config_file_.empty()) read_settings(config_file_, settings);
  for (const auto& [entry, text] : given_) set_setting(*entry, text, settings);
  for (const auto& [entry, text] : given_)
    if (const std::string by = ignored_by(*entry, settings); !by.empty())
      notices.push_back(fmt::format("{} means nothing to {}", as_given(*entry, text), by));
  if (!config_file_.empty()) tell_ignored_in_file(settings, notices);
  try {
    check_numbers(settings);
    check_formulation(settings);
    fit_time_grid(settings, notices);
  } catch (const SettingError& refused) {
    refuse_where_given(refused);
    throw;
  }
  return settings;
}

}  // namespace poinsot::app
