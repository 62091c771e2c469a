// Reads the solver configuration: a strict JSON file with comments, or single values as the command line gives them.
// Numbers may be written as constant expressions ("1/1000", "2*pi").
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/input_error.h"
#include "integrators/settings_table.h"

namespace poinsot {

class JsonValue;

// A value that is allowed by itself and not beside the others. It begins with the key.
class SettingError : public InputError {
 public:
  // `beside`: the other of two that do not go together; where the first was not given, it is the one that was.
  SettingError(std::string_view key, const std::string& why, std::string_view beside = "")
      : InputError(std::string(key) + ": " + why), keys_{std::string(key)}, why_(why) {
    if (!beside.empty()) keys_.emplace_back(beside);
  }
  const std::vector<std::string>& keys() const { return keys_; }
  const std::string& why() const { return why_; }

 private:
  std::vector<std::string> keys_;
  std::string why_;
};

// Throws SettingError: the first number that is not allowed, or is a parameter of other integrators.
void check_numbers(const Settings& settings);
// The part of it that is about step, end and every together: no more steps and output times than can be counted.
void check_counts(const Settings& settings);
// Throws SettingError where the integrator takes no such formulation.
void check_formulation(const Settings& settings);

// Sets one key from text, as after an option on the command line. Throws InputError that begins with the option's name.
void set_setting(const SettingEntry& entry, std::string_view text, Settings& settings);

// Sets what the file says, keeps the rest. Throws InputError: file, key path, what was found, what is allowed.
void read_settings(const std::filesystem::path& file, Settings& settings);
void parse_settings(std::string_view text, std::string_view file, Settings& settings);
// The same of an object within a document, and of the value of one key.
void read_settings(const JsonValue& object, Settings& settings);
void read_setting(const SettingEntry& entry, const JsonValue& value, Settings& settings);

// The settings as a configuration file, every key of it that means something to the integrator.
std::string to_json(const Settings& settings);

// Makes t_n = n step, n = 0..N, land on `end` exactly: where `end` is no multiple of `step`, the step is shortened to
// end/N with the next larger N, and a sentence that says so is added to `notices`. Throws SettingError where `every` is
// no multiple of the step. Integrators that control their error choose their own steps and are left alone.
void fit_time_grid(Settings& settings, std::vector<std::string>& notices);

}  // namespace poinsot
