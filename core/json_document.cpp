#include "core/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "core/input_error.h"

namespace poinsot {
namespace {

using Json = nlohmann::json;

// What other languages write and JSON has not.
bool is_no_finite_number(std::string word) {
  if (word.starts_with('-') || word.starts_with('+')) word.erase(0, 1);
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return word == "nan" || word == "inf" || word == "infinity";
}

// Builds the document from the parser's events. The library's own builder keeps the last of two equal keys silently.
class Builder final : public nlohmann::json_sax<Json> {
 public:
  Builder(std::string_view text, std::string_view file, Json& root) : text_(text), file_(file), root_(root) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // does not occur in text

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    Level& level = levels_.back();
    if (level.container->contains(key)) {
      const std::string twice = fmt::format("{}/{}", path(), pointer_token(key));
      throw ElementError(fmt::format("{}: {}: found the key twice, expected it once", file_, twice), twice);
    }
    level.key = std::move(key);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) override {
    // `position` counts the characters read, the offending one included.
    const std::string_view before = text_.substr(0, std::min(position == 0 ? 0 : position - 1, text_.size()));
    const auto line = std::ranges::count(before, '\n') + 1;
    const std::size_t newline = before.rfind('\n');
    const std::size_t column = newline == before.npos ? before.size() + 1 : before.size() - newline;
    constexpr int kOutOfRange = 406;
    const std::string word = error.id == kOutOfRange ? token : word_at(before.size());
    if (error.id == kOutOfRange || is_no_finite_number(word))
      throw InputError(
          fmt::format("{}: {}: found {}, expected a finite number (line {})", file_, place_path(), word, line));
    // "[json.exception.parse_error.101] parse error at line 1, column 2: what" or "[...out_of_range.406] what".
    std::string_view what = error.what();
    for (const std::string_view prefix : {std::string_view("] "), std::string_view(": ")}) {
      const std::size_t end = what.find(prefix);
      const bool preamble = prefix == "] " || what.starts_with("parse error at");
      if (preamble && end != what.npos) what.remove_prefix(end + prefix.size());
    }
    throw InputError(fmt::format("{}: line {}, column {}: {}", file_, line, column, what));
  }

 private:
  struct Level {
    Json* container;
    std::string key;  // of the value being read, in an object
  };

  Json* place(Json&& value) {
    if (levels_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& container = *levels_.back().container;
    if (container.is_array()) {
      container.push_back(std::move(value));
      return &container.back();
    }
    return &(container[levels_.back().key] = std::move(value));
  }

  template <class T>
  bool add(T&& value) {
    place(Json(std::forward<T>(value)));
    return true;
  }

  bool open(Json&& container) {
    Json* const placed = place(std::move(container));
    levels_.push_back({placed, {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  // Of letters, about this place; with its sign.
  std::string word_at(std::size_t place) const {
    const auto is_letter = [this](std::size_t k) { return std::isalpha(static_cast<unsigned char>(text_[k])) != 0; };
    std::size_t from = place, to = place;
    while (from > 0 && is_letter(from - 1)) --from;
    while (to < text_.size() && is_letter(to)) ++to;
    if (from > 0 && (text_[from - 1] == '-' || text_[from - 1] == '+')) --from;
    return std::string(text_.substr(from, to - from));
  }

  // Of the value that comes next.
  std::string place_path() const {
    if (levels_.empty()) return "/";
    const Level& level = levels_.back();
    return fmt::format(
        "{}/{}", path(),
        level.container->is_array() ? fmt::format("{}", level.container->size()) : pointer_token(level.key));
  }

  // Of the innermost container; empty for the document itself.
  std::string path() const {
    std::string path;
    for (std::size_t k = 0; k + 1 < levels_.size(); ++k) {
      const Level& level = levels_[k];
      path += '/';
      path += level.container->is_array() ? fmt::format("{}", level.container->size() - 1) : pointer_token(level.key);
    }
    return path;
  }

  std::string_view text_, file_;
  Json& root_;
  std::vector<Level> levels_;  // an open container does not move: nothing is added beside it before it is closed
};

std::string content_of(const std::string& file) {
  std::ifstream in = open_input(file);
  errno = 0;
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in || in.bad()) throw InputError(fmt::format("{}: cannot be read: {}", file, std::strerror(errno)));
  return text;
}

// As editors and shells write it, with a mark before the text or without: JSON begins with an ASCII character, of whose
// two bytes one is 0.
bool is_utf16(std::string_view text) {
  if (text.size() < 2) return false;
  const std::string_view begin = text.substr(0, 2);
  return begin == "\xff\xfe" || begin == "\xfe\xff" || (begin[0] == '\0') != (begin[1] == '\0');
}

}  // namespace

JsonDocument::JsonDocument(std::string_view text, std::string_view file)
    : file_(file), json_(std::make_unique<Json>()) {
  if (text.find_first_not_of(" \t\r\n") == text.npos) throw InputError(fmt::format("{}: the file is empty", file));
  if (is_utf16(text))
    throw InputError(fmt::format("{}: found a text in UTF-16, expected UTF-8; save it as that", file));
  Builder builder(text, file_, *json_);
  constexpr bool kWholeText = true, kComments = true;
  Json::sax_parse(text.begin(), text.end(), &builder, Json::input_format_t::json, kWholeText, kComments);
}

JsonDocument::~JsonDocument() = default;

void JsonDocument::replace(const std::string& pointer, Json value) {
  (*json_)[Json::json_pointer(pointer)] = std::move(value);
}

std::string JsonDocument::text() const {
  return json_->dump();
}

std::string shown_input(const std::string& file) {
  return file == "-" ? "standard input" : file;
}

std::ifstream open_input(const std::string& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw InputError(fmt::format("{}: found a directory, expected a file", file));
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read: {}", file, std::strerror(errno)));
  return in;
}

std::string read_text(const std::string& file) {
  namespace fs = std::filesystem;
  if (file == "-") return read_text("/dev/stdin");
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status) || fs::is_regular_file(status)) return content_of(file);
  static std::mutex access;
  static std::map<std::string, std::string> kept;
  const std::lock_guard lock(access);
  const auto found = kept.find(file);
  return found != kept.end() ? found->second : kept.emplace(file, content_of(file)).first->second;
}

}  // namespace poinsot
