#include "core/line_search.h"

#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/json_value.h"

namespace poinsot {
namespace {

using Json = nlohmann::json;

// The characters of a text, counting lines. The parser looks one character ahead behind numbers.
struct Reading {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  struct Lines {
    int now = 1, before = 1;  // the last character read
  };

  const char* at;
  Lines* lines;
  const char& operator*() const { return *at; }
  Reading& operator++() {
    lines->before = lines->now;
    lines->now += *at == '\n';
    ++at;
    return *this;
  }
  bool operator==(const Reading& other) const { return at == other.at; }
};

class Events final : public nlohmann::json_sax<Json> {
 public:
  Events(const Reading::Lines& at, const std::set<std::string>& wanted, std::map<std::string, int>& lines,
         std::map<std::string, std::string>& names)
      : at_(at), wanted_(wanted), lines_(lines), names_(names) {}

  // What is in a container that nothing is wanted of is passed over.
  bool null() override { return value(at_.now); }
  bool boolean(bool) override { return value(at_.now); }
  bool number_integer(number_integer_t) override { return value(at_.before); }
  bool number_unsigned(number_unsigned_t) override { return value(at_.before); }
  bool number_float(number_float_t, const string_t&) override { return value(at_.before); }
  bool string(string_t& text) override {
    constexpr std::string_view kName = "/name";
    value(at_.now);
    if (passed_over_ > 0) return true;
    if (path_.ends_with(kName)) {
      const std::string element = path_.substr(0, path_.size() - kName.size());
      if (wanted_.contains(element)) names_[element] = text;
    }
    return true;
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(-1); }
  bool start_array(std::size_t) override { return open(0); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  // Nothing more is wanted of the text: the elements of sections that hold what was asked for are gone through.
  void stop_after(std::set<std::string> elements) { left_ = std::move(elements); }
  bool key(string_t& key) override {
    if (passed_over_ > 0) return true;
    path_.resize(levels_.back().path);
    path_ += '/' + pointer_token(key);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  struct Level {
    std::size_t path;  // length of the container's own
    int items;         // read, of an array; −1: an object
  };

  bool value(int line) {
    if (passed_over_ > 0) return true;
    if (!levels_.empty() && levels_.back().items >= 0) {
      path_.resize(levels_.back().path);
      path_ += fmt::format("/{}", levels_.back().items++);
    }
    if (wanted_.contains(path_)) lines_[path_] = line;
    return true;
  }
  bool open(int items) {
    value(at_.now);
    if (passed_over_ > 0 || !(levels_.empty() || wanted_.contains(path_)))
      ++passed_over_;
    else
      levels_.push_back({path_.size(), items});
    return true;
  }
  bool close() {
    if (passed_over_ > 0) return --passed_over_ >= 0;
    path_.resize(levels_.back().path);
    levels_.pop_back();
    return !left_.erase(path_) || !left_.empty();
  }

  const Reading::Lines& at_;
  const std::set<std::string>& wanted_;
  std::map<std::string, int>& lines_;
  std::map<std::string, std::string>& names_;
  std::string path_;
  std::vector<Level> levels_;
  int passed_over_ = 0;  // containers that are open, of which nothing is wanted
  std::set<std::string> left_;
};

// "/joints/17" of "/joints/17/axis"; the path itself where it is no longer.
std::string element_around(const std::string& path) {
  const std::size_t second = path.find('/', 1);
  return second == path.npos ? path : path.substr(0, path.find('/', second + 1));
}

}  // namespace

bool has_lines(std::string_view text) {
  return text.find('\n') < text.find_last_not_of(" \t\r\n");
}

LineSearch::LineSearch(std::string_view text, const std::vector<std::string>& paths) {
  std::set<std::string> wanted;
  for (const std::string& path : paths)
    for (std::size_t end = path.size(); end != path.npos && end > 0; end = path.rfind('/', end - 1))
      wanted.insert(path.substr(0, end));
  Reading::Lines lines;
  Events events(lines, wanted, lines_, names_);
  std::set<std::string> elements;
  for (const std::string& path : paths) elements.insert(element_around(path));
  events.stop_after(std::move(elements));
  constexpr bool kWholeText = false, kComments = true;
  const Reading begin{text.data(), &lines}, end{text.data() + text.size(), &lines};
  Json::sax_parse(begin, end, &events, Json::input_format_t::json, kWholeText, kComments);
  if (!has_lines(text)) lines_.clear();
}

int LineSearch::line(std::string path) const {
  for (; !path.empty(); path.resize(path.rfind('/')))
    if (const auto found = lines_.find(path); found != lines_.end()) return found->second;
  return 0;
}

std::string LineSearch::name(const std::string& path) const {
  const auto found = names_.find(path);
  return found == names_.end() ? "" : found->second;
}

}  // namespace poinsot
