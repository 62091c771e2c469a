// `poinsot completion SHELL`: a script for the shell, from the command tree.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/command_tree.h"
#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "core/input_error.h"
#include "core/projected.h"

namespace poinsot::app {
namespace {

struct CompletionOptions {
  const CLI::App* app = nullptr;
  std::string shell;
  bool quiet = false;
};

// One line, for a shell's single quotes, without what zsh takes for its own.
std::string summary(const std::string& about) {
  std::string text = about.substr(0, about.find('\n'));
  std::erase_if(text, [](char c) { return c == '\'' || c == '[' || c == ']' || c == '\\'; });
  std::replace(text.begin(), text.end(), ':', ',');
  return text;
}

std::vector<std::string> option_names(const Command& command) {
  std::vector<std::string> names;
  for (const Argument& option : command.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::string bash(const CommandTree& tree) {
  const auto generate = [](const Argument& a) -> std::string {
    if (a.takes == Takes::file) return "compgen -f -- \"$word\"";
    if (a.takes == Takes::folder) return "compgen -d -- \"$word\"";
    return fmt::format("compgen -W '{}' -- \"$word\"", fmt::join(a.words, " "));
  };
  std::string text =
      "# bash completion of poinsot; made by `poinsot completion bash`\n"
      "_poinsot() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  local IFS=$'\\n'\n"
      "  COMPREPLY=()\n";
  text += fmt::format(
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then COMPREPLY=($(IFS=' '; compgen -W '{} {}' -- \"$word\")); return; fi\n"
      "  case ${{COMP_WORDS[1]}} in\n",
      fmt::join(projected(tree.commands, &Command::name), " "), fmt::join(option_names(tree.program), " "));
  for (const Command& command : tree.commands) {
    text += fmt::format("    {})\n      case $before in\n", command.name);
    for (const Argument& option : command.options)
      if (option.takes != Takes::nothing)
        text += fmt::format("        {}) COMPREPLY=($(IFS=' '; {})); return ;;\n", fmt::join(option.names, "|"),
                            generate(option));
    text += fmt::format(
        "      esac\n"
        "      case $word in -*) COMPREPLY=($(IFS=' '; compgen -W '{}' -- \"$word\")); return ;; esac\n",
        fmt::join(option_names(command), " "));
    if (!command.positionals.empty())
      text += fmt::format("      COMPREPLY=($(IFS=' '; {}))\n", generate(command.positionals.front()));
    text += "      ;;\n";
  }
  return text + "  esac\n}\ncomplete -o filenames -F _poinsot poinsot\n";
}

std::string zsh(const CommandTree& tree) {
  const auto action = [](const Argument& a) -> std::string {
    if (a.takes == Takes::file) return "_files";
    if (a.takes == Takes::folder) return "_files -/";
    return a.words.empty() ? " " : fmt::format("({})", fmt::join(a.words, " "));
  };
  std::string text =
      "#compdef poinsot\n"
      "# zsh completion of poinsot; made by `poinsot completion zsh`\n"
      "_poinsot() {\n"
      "  local -a commands\n"
      "  commands=(\n";
  for (const Command& command : tree.commands)
    text += fmt::format("    '{}:{}'\n", command.name, summary(command.about));
  text +=
      "  )\n"
      "  if (( CURRENT == 2 )); then _describe command commands; return; fi\n"
      "  case $words[2] in\n";
  for (const Command& command : tree.commands) {
    text += fmt::format("    {}) shift words; (( CURRENT-- )); _arguments", command.name);
    for (const Argument& option : command.options)
      for (const std::string& name : option.names)
        text += fmt::format(
            " \\\n      '{}[{}]{}'", name, summary(option.about),
            option.takes == Takes::nothing ? "" : fmt::format(":{}:{}", summary(option.value), action(option)));
    for (const Argument& positional : command.positionals)
      text += fmt::format(" \\\n      '*:{}:{}'", summary(positional.names.front()), action(positional));
    text += " ;;\n";
  }
  return text + "  esac\n}\nif [ \"$funcstack[1]\" = _poinsot ]; then _poinsot; else compdef _poinsot poinsot; fi\n";
}

std::string fish(const CommandTree& tree) {
  std::string text =
      "# fish completion of poinsot; made by `poinsot completion fish`\n"
      "complete -c poinsot -f\n";
  for (const Command& command : tree.commands)
    text += fmt::format("complete -c poinsot -n __fish_use_subcommand -a {} -d '{}'\n", command.name,
                        summary(command.about));
  for (const Command& command : tree.commands) {
    const std::string seen = fmt::format("complete -c poinsot -n '__fish_seen_subcommand_from {}'", command.name);
    const auto values = [](const Argument& a) -> std::string {
      if (a.takes == Takes::file) return " -F";
      if (a.takes == Takes::folder) return " -a '(__fish_complete_directories)'";
      return a.words.empty() ? "" : fmt::format(" -a '{}'", fmt::join(a.words, " "));
    };
    for (const Argument& option : command.options)
      for (const std::string& name : option.names)
        text += fmt::format("{} {} {}{} -d '{}'\n", seen, name.starts_with("--") ? "-l" : "-s",
                            name.substr(name.find_first_not_of('-')),
                            option.takes == Takes::nothing ? "" : " -x" + values(option), summary(option.about));
    for (const Argument& positional : command.positionals)
      if (const std::string of = values(positional); !of.empty()) text += seen + of + "\n";
  }
  return text;
}

int complete(const CompletionOptions& options) {
  const CommandTree tree = command_tree(*options.app);
  if (options.shell == "bash")
    fmt::print("{}", bash(tree));
  else if (options.shell == "zsh")
    fmt::print("{}", zsh(tree));
  else if (options.shell == "fish")
    fmt::print("{}", fish(tree));
  else
    throw InputError(fmt::format("SHELL: found \"{}\", expected one of bash, zsh, fish", options.shell));
  return kDone;
}

}  // namespace

void add_completion(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "completion", "a script that completes commands, for bash, zsh or fish", complete);
  options.app = &app;
  command.add_option("SHELL", options.shell, "bash, zsh or fish")->required()->type_name("");
  add_quiet(command, options.quiet);
  command.footer("For a shell that runs: source <(poinsot completion bash). Installed with the program.");
}

}  // namespace poinsot::app
