// From the text of an expression to its tape.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/expression_tape.h"

namespace poinsot {

class ExpressionNames;

enum class Variables { none, time, law };  // t; x, v and t

// Of names in expressions.
inline bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

struct ParsedTape {
  std::vector<TapeInstruction> tape;
  std::vector<std::shared_ptr<const Spline>> tables;  // those that the tape asks
};

// Grammar and errors: core/expression.h.
ParsedTape parse_expression(std::string_view text, Variables variables, ExpressionNames* names);

// "table 'road' has no value at 2.5: its points go from 0 to 2"
std::string describe(const Uncovered& found);

}  // namespace poinsot
