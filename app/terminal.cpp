#include "app/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/printable.h"

namespace poinsot::app {
namespace {

bool coloured() {
  const char* no_color = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (!no_color || !*no_color);
}

// Line by line: what comes from files and names may hold anything.
std::string shown(std::string_view sentence) {
  std::string text;
  for (std::size_t begin = 0; begin <= sentence.size();) {
    const std::size_t end = std::min(sentence.find('\n', begin), sentence.size());
    text += (begin > 0 ? "\n" : "") + printable(sentence.substr(begin, end - begin));
    begin = end + 1;
  }
  return text;
}

}  // namespace

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

void print_error(std::string_view sentence) {
  fmt::print(stderr, "{} {}\n", coloured() ? "\x1b[1;31mpoinsot:\x1b[0m" : "poinsot:", shown(sentence));
}

void print_notice(std::string_view sentence) {
  fmt::print(stderr, "{} {}\n", coloured() ? "poinsot: \x1b[1;33mnote:\x1b[0m" : "poinsot: note:", shown(sentence));
}

}  // namespace poinsot::app
