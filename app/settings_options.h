// The solver configuration on the command line: --config FILE and an option for every key, which wins over the file.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "integrators/settings_reader.h"

namespace poinsot::app {

class SettingsOptions {
 public:
  // The object must live as long as the command is parsed.
  void add_to(CLI::App& command);

  const std::string& config_file() const { return config_file_; }
  // The option given first, "--step"; empty where there is none.
  std::string first_given() const;
  // Defaults, then the file, then the command line, all of it checked; the time grid fitted. Throws InputError.
  Settings resolve(std::vector<std::string>& notices) const;

 private:
  bool on_command_line(std::string_view key) const;
  void tell_ignored_in_file(const Settings& settings, std::vector<std::string>& notices) const;
  void refuse_where_given(const SettingError& refused) const;
  void refuse_in_file(const std::string& key, const std::string& why) const;

  std::string config_file_;
  std::vector<std::pair<const SettingEntry*, std::string>> given_;
};

}  // namespace poinsot::app
