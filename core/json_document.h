// JSON text, parsed strictly: comments are allowed (// and /* */), a key that comes twice in an object is not.
#pragma once

#include <fstream>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "core/json_value.h"

namespace poinsot {

class JsonDocument {
 public:
  // `file` names the text in messages. Throws InputError: a syntax error with line and column (in bytes, from 1), a
  // duplicate key with its path.
  JsonDocument(std::string_view text, std::string_view file);
  ~JsonDocument();

  JsonValue root(ExpressionNames* names = nullptr) const { return JsonValue(*json_, file_, names); }

  // Puts `value` in the place of what the pointer leads to, in an object that is there.
  void replace(const std::string& pointer, nlohmann::json value);
  std::string text() const;  // of the document as it is now, without comments

 private:
  std::string file_;
  std::unique_ptr<nlohmann::json> json_;
};

// To be read from its beginning. Throws InputError: a directory, or why it cannot be read.
std::ifstream open_input(const std::string& file);
// The file's whole content; "-" is the standard input. What can be read but once, as that and pipes, is kept for
// whoever asks again. Throws InputError.
std::string read_text(const std::string& file);
// As messages call it.
std::string shown_input(const std::string& file);

}  // namespace poinsot
