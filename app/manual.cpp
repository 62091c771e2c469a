// `poinsot manual`: the manual page, from the command tree.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "app/command_tree.h"
#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "core/projected.h"
#include "core/provenance.h"

namespace poinsot::app {
namespace {

// As troff takes it for plain text.
std::string plain(const std::string& text) {
  std::string result;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\' || c == '-') result += '\\';
    result += c == '\\' ? 'e' : c;
    line_start = c == '\n';
  }
  return result;
}

std::string arguments(const std::vector<Argument>& all) {
  std::string text;
  for (const Argument& one : all) {
    text += fmt::format(".TP\n\\fB{}\\fR", plain(fmt::format("{}", fmt::join(one.names, ", "))));
    if (one.names.front().starts_with("-") && !one.value.empty()) text += fmt::format(" \\fI{}\\fR", plain(one.value));
    text += "\n" + plain(one.about) + "\n";
  }
  return text;
}

std::string synopsis(const Command& command) {
  std::string text = fmt::format(".B poinsot {}\n", command.name);
  for (const Argument& one : command.positionals) text += fmt::format(".I {}\n", plain(one.names.front()));
  return text + "[options]\n";
}

std::string page(const CommandTree& tree) {
  const auto& [program, commands] = tree;
  std::string text = fmt::format(".TH POINSOT 1 \"\" \"poinsot {}\"\n.SH NAME\npoinsot \\- {}\n.SH SYNOPSIS\n",
                                 provenance().version, plain(program.about.substr(program.about.find(": ") + 2)));
  text += fmt::format("{}", fmt::join(projected(commands, synopsis), ".br\n"));
  text += ".SH OPTIONS\n" + arguments(program.options) + ".SH COMMANDS\n";
  for (const Command& one : commands) {
    text += fmt::format(".SS {}\n{}\n{}{}", synopsis(one).substr(3, synopsis(one).find('\n') - 3), plain(one.about),
                        arguments(one.positionals), arguments(one.options));
    if (!one.footer.empty()) text += fmt::format(".PP\n.nf\n{}\n.fi\n", plain(one.footer));
  }
  return text + fmt::format(".SH EXIT STATUS\n.nf\n{}\n.fi\n", plain(program.footer)) +
         ".SH ENVIRONMENT\n"
         ".TP\n.B NO_COLOR\nwhere it is set and not empty, messages have no colours\n"
         ".TP\n.B XDG_CACHE_HOME\nreferences are kept in its folder poinsot, or in ~/.cache/poinsot\n";
}

}  // namespace

void add_manual(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("manual", "the manual page, for man: poinsot manual | man -l -");
  const auto quiet = std::make_shared<bool>(false);
  add_quiet(*command, *quiet);
  command->callback([&app, quiet, &status] {
    fmt::print("{}", page(command_tree(app)));
    status = kDone;
  });
}

}  // namespace poinsot::app
