// The tape an expression is parsed into, and its evaluation on second-order Taylor numbers (f, ḟ, f̈).
//
// The tape is a program for a stack machine: a constant or a variable pushes a value, a function replaces the topmost
// value, an operator the topmost two. With x the argument and φ the function,
//   f = φ(x),   ḟ = φ'(x) ẋ,   f̈ = φ''(x) ẋ² + φ'(x) ẍ,
// and correspondingly for two arguments. Where φ has a kink or a jump (abs, sign, step, fold, min, max) the derivatives
// are those of one side, and the value whose sign tells the sides apart is a switch of the tape. What is not a number
// stays so, whatever it is combined with; what overflows on the way to a derivative is evaluated again in wide.h.
#pragma once

#include <cstddef>
#include <span>

#include "core/jet.h"
#include "core/table.h"

namespace poinsot {

enum class TapeOp : unsigned char {
  constant,
  time,
  elongation,  // x of a law
  rate,        // v of a law
  negate,
  // clang-format off
  sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, exp, log, sqrt, abs, sign, step,
  fold,            // acos(cos x)
  power_constant,  // of one argument; the exponent stands in the instruction
  table,           // of one argument; the table stands in the instruction
  add, subtract, multiply, divide, power, atan2, min, max,
  // clang-format on
};

inline int arity(TapeOp op) {
  return op <= TapeOp::rate ? 0 : op < TapeOp::add ? 1 : 2;
}

inline bool has_switch(TapeOp op) {
  return op == TapeOp::abs || op == TapeOp::sign || op == TapeOp::step || op == TapeOp::fold || op == TapeOp::min ||
         op == TapeOp::max;
}

struct TapeInstruction {
  TapeOp op = TapeOp::constant;
  union {
    double value = 0;  // of a constant, or the constant exponent
    const Spline* table;
  };
};

inline constexpr std::size_t kTapeStack = 32;  // values; the parser refuses what needs more

// What the variables of an expression stand at: time, and in the law of a spring its elongation x and rate v.
template <class T>
struct Arguments {
  T t{}, x{}, v{};
};

// Constants are doubles whatever T is, so that every T evaluates the same function. T: double, long double.
template <class T>
Jet2<T> run_tape(std::span<const TapeInstruction> tape, const Arguments<Jet2<T>>& at);

// The switches, in the order of the tape: x of abs(x), sign(x) and step(x), x − y of min(x, y) and max(x, y), sin(x) of
// acos(cos(x)).
void tape_switches(std::span<const TapeInstruction> tape, const Arguments<double>& at, std::span<double> out);

// Which cubic each table is asked for, in the order of the tape; those beyond the room given are left out.
void tape_cubics(std::span<const TapeInstruction> tape, const Arguments<double>& at, std::span<int> out);

// A table asked for a value that it does not have.
struct Uncovered {
  const Spline* table = nullptr;  // none where all arguments were covered
  double argument = 0;
};
Uncovered first_uncovered(std::span<const TapeInstruction> tape, const Arguments<double>& at);

}  // namespace poinsot
