// The tape an expression is parsed into, and its evaluation on second-order Taylor numbers (f, ḟ, f̈).
//
// The tape is a program for a stack machine: `constant` and `time` push a value, a function replaces the topmost value,
// an operator the topmost two. With x the argument and φ the function,
//   f = φ(x),   ḟ = φ'(x) ẋ,   f̈ = φ''(x) ẋ² + φ'(x) ẍ,
// and correspondingly for two arguments. Where φ has a kink (abs, min, max) the derivatives are those of one side.
#pragma once

#include <cstddef>
#include <span>

namespace poinsot {

// Value and time derivatives of a function of time at one instant.
template <class T>
struct Jet2 {
  T f{};    // value
  T fd{};   // first derivative, 1/s
  T fdd{};  // second derivative, 1/s²
};

enum class TapeOp : unsigned char {
  constant,
  time,
  negate,
  // clang-format off
  sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, sqrt, abs,
  power_constant,  // of one argument; the exponent stands in the instruction
  add, subtract, multiply, divide, power, atan2, min, max,
  // clang-format on
};

inline int arity(TapeOp op) {
  return op <= TapeOp::time ? 0 : op < TapeOp::add ? 1 : 2;
}

struct TapeInstruction {
  TapeOp op = TapeOp::constant;
  double value = 0;  // of a constant, or the constant exponent
};

inline constexpr std::size_t kTapeStack = 32;  // values; the parser refuses what needs more

// Constants are doubles whatever T is, so that every T evaluates the same function. T: double, long double.
template <class T>
Jet2<T> run_tape(std::span<const TapeInstruction> tape, T t);

}  // namespace poinsot
