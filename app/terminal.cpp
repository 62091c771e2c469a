#include "app/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <nlohmann/json.hpp>

#include "bench/study/output_file.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/places.h"
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

void say(std::string_view who, std::string_view sentence) noexcept {
  try {
    const std::string line = fmt::format("{} {}\n", who, shown(sentence));
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

std::string with_lines_of(const std::string& scene_file, std::string_view message) {
  if (message.find(" (/") == message.npos) return std::string(message);
  try {
    return with_lines(message, read_text(scene_file));
  } catch (const InputError&) {  // it is gone
    return std::string(message);
  }
}

void print_json(std::FILE* out, const nlohmann::ordered_json& json) {
  fmt::print(out, "{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::FILE* text_stream(std::initializer_list<std::filesystem::path> outputs) {
  for (const std::filesystem::path& output : outputs)
    if (!output.empty() && study::open_descriptor(output) == STDOUT_FILENO) return stderr;
  return stdout;
}

}  // namespace poinsot::app
