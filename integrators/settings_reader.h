// Reads the solver configuration: a strict JSON file with comments, or single values as the command line gives them.
//
// One table holds every key with what it means and what it may be; the file, the command line, the help texts, the
// messages and the run record are made from it. Parameters of methods are in it as the integrators declare them.
// Numbers may be written as constant expressions ("1/1000", "2*pi").
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "integrators/integrator.h"

namespace poinsot {

class JsonValue;

struct SettingEntry {
  std::string_view key;  // in the file; on the command line with dashes, "--linear-solver"
  std::string about;     // one line, with the unit
  std::variant<Analysis Settings::*, std::string Settings::*, double Settings::*, std::optional<double> Settings::*,
               int Settings::*, bool Settings::*, Assembly Settings::*, const MethodParameter*>
      member;
  std::vector<std::string> (*names)();  // what a key with a name may be; nullptr for numbers and switches
  bool zero_allowed;                    // numbers: at least 0 instead of greater than 0
  double least = 0;                     // numbers: at least this, where it is not 0
  double most = std::numeric_limits<double>::infinity();
  enum class For { all, fixed_steps, error_control } meant_for = For::all;
  std::string_view otherwise = {};  // switches: what is done instead, one line
};

std::span<const SettingEntry> setting_entries();
// Whether it is true or false: on the command line an option and its opposite, "--assemble", "--no-assemble".
bool is_switch(const SettingEntry& entry);
const SettingEntry* find_setting(std::string_view key);  // nullptr where no entry has the key
std::string option_name(const SettingEntry& entry);      // "--linear-solver"
// "rA", "0.001": a setting as it would be written in the file, without quotes.
std::string value_text(const SettingEntry& entry, const Settings& settings);

// Whether the method chooses its steps, by its error.
bool chooses_steps(const Settings& settings);
// Why the method does not look at a setting, as a sentence; empty where it does.
std::string why_ignored(const SettingEntry& entry, const Settings& settings);

// Throws InputError that begins with the key of the first number that is not allowed, or is a parameter of other
// integrators.
void check_numbers(const Settings& settings);
// The part of it that is about step, end and every together: no more steps and output times than can be counted.
void check_counts(const Settings& settings);

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
// end/N with the next larger N, and a sentence that says so is added to `notices`. Throws InputError where `every` is
// no multiple of the step. Integrators that control their error choose their own steps and are left alone.
void fit_time_grid(Settings& settings, std::vector<std::string>& notices);

}  // namespace poinsot
