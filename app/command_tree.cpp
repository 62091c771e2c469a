#include "app/command_tree.h"

#include <algorithm>
#include <cctype>

#include "bench/paper/figure.h"
#include "bench/stability/family.h"
#include "bench/study/motion.h"
#include "core/scene_generator.h"
#include "integrators/settings_reader.h"

namespace poinsot::app {
namespace {

template <class Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.emplace_back(entry.name);
  return names;
}

// What a setting's option may be, or what --linear-solvers lists, and what commands choose among by name.
std::vector<std::string> words_of(const std::string& command, const std::string& option) {
  if (command == "make" && option == "STRUCTURE") return names_of(scene_generators());
  if (command == "figures" && option == "NAME") return names_of(paper::figures());
  if (command == "completion") return {"bash", "zsh", "fish"};
  if (option == "--family") return names_of(stability::families());
  if (option == "--of") return {study::kQuantities.begin(), study::kQuantities.end()};
  for (const SettingEntry& entry : setting_entries()) {
    const std::string name = option_name(entry);
    if (entry.names && (option == name || option == name + "s")) return entry.names();
  }
  return {};
}

Takes takes(const CLI::Option& option, const std::string& value) {
  if (option.get_items_expected_max() == 0) return Takes::nothing;
  if (value == "DIR") return Takes::folder;
  return value.starts_with("FILE") || value == "SCENE" ? Takes::file : Takes::word;
}

Argument argument(const std::string& command, const CLI::Option& option) {
  Argument result;
  result.about = option.get_description();
  result.value = option.get_items_expected_max() == 0 ? "" : option.get_type_name();
  result.takes = takes(option, result.value);
  if (option.get_positional()) {
    std::string name = option.get_name();
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
    result.names = {result.value.empty() ? name : result.value};
    result.words = words_of(command, name);
  } else {
    for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
    result.words = words_of(command, result.names.back());
  }
  return result;
}

Command command(const CLI::App& app) {
  Command result{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options())
    (option->get_positional() ? result.positionals : result.options).push_back(argument(result.name, *option));
  return result;
}

}  // namespace

CommandTree command_tree(const CLI::App& app) {
  CommandTree tree{command(app), {}};
  for (const CLI::App* one : app.get_subcommands([](const CLI::App*) { return true; }))
    tree.commands.push_back(command(*one));
  return tree;
}

}  // namespace poinsot::app
