// The commands with their options, values and files, read off the command line's own tables: what completions and the
// manual are made from.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace poinsot::app {

enum class Takes { nothing, word, file, folder };  // `word`: one of `words` where there are any

struct Argument {
  std::vector<std::string> names;  // "--end"; of a positional one its own, "SCENE"
  std::string value;               // as the help calls it: "X", "FILE.csv"; empty where there is none
  std::string about;
  Takes takes = Takes::nothing;
  std::vector<std::string> words;
};

struct Command {
  std::string name, about, footer;
  std::vector<Argument> positionals, options;
};

struct CommandTree {
  Command program;
  std::vector<Command> commands;
};
CommandTree command_tree(const CLI::App& app);

}  // namespace poinsot::app
