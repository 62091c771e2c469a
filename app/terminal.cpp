#include "app/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <new>

#include "bench/study/output_file.h"

namespace poinsot::app {
namespace {

bool coloured() {
  const char* no_color = std::getenv("NO_COLOR");
  return stderr_is_terminal() && (!no_color || !*no_color);
}

void say(std::string_view who, std::string_view sentence) noexcept {
  try {
    const std::string line = fmt::format("{} {}\n", who, printable(sentence));
    std::fwrite(line.data(), 1, line.size(), stderr);
  } catch (const std::bad_alloc&) {  // as it is, then
    std::fwrite(sentence.data(), 1, sentence.size(), stderr);
    std::fputc('\n', stderr);
  }
}

}  // namespace

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

void print_error(std::string_view sentence) noexcept {
  say(coloured() ? "\x1b[1;31mpoinsot:\x1b[0m" : "poinsot:", sentence);
}

void print_notice(std::string_view sentence) noexcept {
  say(coloured() ? "poinsot: \x1b[1;33mnote:\x1b[0m" : "poinsot: note:", sentence);
}

std::string printable(std::string_view text) {
  std::string shown;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    // In UTF-8, 0xc2 0x80 to 0xc2 0x9f are control characters, too.
    const bool second = c == 0xc2 && k + 1 < text.size() && (static_cast<unsigned char>(text[k + 1]) & 0xe0) == 0x80;
    if (c < 0x20 || c == 0x7f)
      shown += fmt::format("\\x{:02x}", c);
    else if (second)
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[++k]));
    else
      shown += text[k];
  }
  return shown;
}

std::FILE* text_stream(std::initializer_list<std::filesystem::path> outputs) {
  for (const std::filesystem::path& output : outputs)
    if (!output.empty() && study::open_descriptor(output) == STDOUT_FILENO) return stderr;
  return stdout;
}

}  // namespace poinsot::app
