// A function of time f(t), as scenes write it ("cos(pi*t + pi/2)"), with its exact first and second derivatives.
//
// The text is parsed once into a tape (core/expression_tape.h), parts without `t` already evaluated; the tape is
// evaluated on second-order Taylor numbers (f, ḟ, f̈), so the derivatives are exact to rounding and there is nothing to
// differentiate by hand and nothing to step. Evaluation allocates nothing and changes nothing.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/expression_tape.h"

namespace poinsot {

// The text is not an expression: what was found, and at which character (counted from 1).
class ExpressionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Expression {
 public:
  Expression() = default;  // the constant 0
  explicit Expression(double constant);
  Expression(const Expression&) = default;  // and no moves: what was moved from would be no function
  Expression& operator=(const Expression&) = default;

  // Grammar: + - * / ^ and unary signs, parentheses, numbers, `pi`, `e`, the variable `t`, and the functions listed by
  // function_names(). `^` binds to the right and tighter than a sign on its left: -t^2 = -(t^2).
  // A constant part that is not finite ("1/0") is an error. Throws ExpressionError.
  static Expression parse(std::string_view text);
  // As parse, but `t` is an unknown name: for numbers written as constant expressions.
  static Expression parse_constant(std::string_view text);
  static std::vector<std::string_view> function_names();

  bool is_constant() const { return constant_; }
  std::string text() const;

  template <class T>  // double, long double
  Jet2<T> at(T t) const {
    return constant_ ? Jet2<T>{T(value_), T(0), T(0)} : run_tape<T>(parsed_->tape, t);
  }

 private:
  static Expression parse(std::string_view text, bool with_time);

  struct Parsed {
    std::string text;
    std::vector<TapeInstruction> tape;  // empty for a constant
  };
  bool constant_ = true;
  double value_ = 0;                      // of a constant
  std::shared_ptr<const Parsed> parsed_;  // copies share it; none where there was no text
};

}  // namespace poinsot
