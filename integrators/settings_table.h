// The table of settings: every key with what it means and what it may be. The configuration file, the command line, the
// help texts, the messages and the run record are made from it; parameters of methods are in it as the integrators
// declare them.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "integrators/integrator.h"

namespace poinsot {

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
  enum class For { all, dynamics, fixed_steps, fixed_steps_of_dynamics, error_control } meant_for = For::all;
  std::string_view otherwise = {};  // switches: what is done instead, one line
};

std::span<const SettingEntry> setting_entries();
// Whether it is true or false: on the command line an option and its opposite, "--assemble", "--no-assemble".
bool is_switch(const SettingEntry& entry);
const SettingEntry* find_setting(std::string_view key);  // nullptr where no entry has the key
std::string option_name(const SettingEntry& entry);      // "--linear-solver"
// The value of what is a number; nothing for names and switches.
std::optional<double> number_of(const SettingEntry& entry, const Settings& settings);
// "rA", "0.001": a setting as it would be written in the file, without quotes.
std::string value_text(const SettingEntry& entry, const Settings& settings);

// Whether the method chooses its steps, by its error.
bool chooses_steps(const Settings& settings);
// The method that does not look at a setting, and why: "kinematics, which ..."; empty where it does.
std::string ignored_by(const SettingEntry& entry, const Settings& settings);
// A sentence for all places in a file that the same methods do not look at: "/step, /retry mean nothing to ...".
std::vector<std::string> ignored_sentences(const std::map<std::string, std::vector<std::string>>& places_by_method);
// Names of the integrators that declare a parameter of this name.
std::vector<std::string_view> integrators_with(std::string_view parameter);

}  // namespace poinsot
