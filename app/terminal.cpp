#include "app/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace poinsot::app {
namespace {

bool coloured() {
  const char* no_color = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (!no_color || !*no_color);
}

}  // namespace

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

void print_error(std::string_view sentence) {
  fmt::print(stderr, "{} {}\n", coloured() ? "\x1b[1;31mpoinsot:\x1b[0m" : "poinsot:", sentence);
}

void print_notice(std::string_view sentence) {
  fmt::print(stderr, "{} {}\n", coloured() ? "poinsot: \x1b[1;33mnote:\x1b[0m" : "poinsot: note:", sentence);
}

}  // namespace poinsot::app
