#include "core/expression_kinks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace poinsot {
namespace {

using Tape = std::vector<TapeInstruction>;

// The instructions of a value.
struct Part {
  Tape::const_iterator first, last;

  TapeOp op() const { return (last - 1)->op; }
  // The last argument of its operation, and the one before that.
  Part argument() const { return ending_at(last - 1); }
  Part other() const { return {first, argument().first}; }
  static Part ending_at(Tape::const_iterator last) {
    Tape::const_iterator first = last;
    for (int open = 1; open > 0;) open += arity((--first)->op) - 1;
    return {first, last};
  }
  std::optional<double> constant() const {
    return op() == TapeOp::constant ? std::optional((last - 1)->value) : std::nullopt;
  }
};

bool is_wave(TapeOp op) {
  return op == TapeOp::sin || op == TapeOp::cos;
}
TapeOp other_wave(TapeOp op) {
  return op == TapeOp::sin ? TapeOp::cos : TapeOp::sin;
}

// factor · value
struct Scaled {
  double factor;
  Part value;
};
Scaled scaled(const Part& part) {
  if (part.op() == TapeOp::negate) {
    const Scaled inner = scaled(part.argument());
    return {-inner.factor, inner.value};
  }
  if (part.op() == TapeOp::multiply || part.op() == TapeOp::divide) {
    const bool divided = part.op() == TapeOp::divide;
    if (const auto c = part.argument().constant()) {
      const Scaled inner = scaled(part.other());
      return {divided ? inner.factor / *c : inner.factor * *c, inner.value};
    }
    if (const auto c = part.other().constant(); c && !divided) {
      const Scaled inner = scaled(part.argument());
      return {*c * inner.factor, inner.value};
    }
  }
  return {1, part};
}

// factor · g(x + shift)², or with x/2 in the place of x; g is a wave.
struct Square {
  double factor;
  TapeOp g;
  Part x;
  double shift;
  bool half;
};

// a ± a cos x, a ± a sin x, a − a cos² x or a − a sin² x.
std::optional<Square> as_square(const Part& part) {
  const Scaled whole = scaled(part);
  const TapeOp op = whole.value.op();
  if (op != TapeOp::add && op != TapeOp::subtract) return {};
  Scaled a = scaled(whole.value.other()), b = scaled(whole.value.argument());
  if (op == TapeOp::subtract) b.factor = -b.factor;
  if (!a.value.constant()) std::swap(a, b);
  if (!a.value.constant()) return {};
  const double constant = a.factor * *a.value.constant(), factor = whole.factor * constant;
  const Part& wave = b.value;
  if (is_wave(wave.op())) {
    if (std::abs(b.factor) != std::abs(constant)) return {};
    // sin x = cos(x − π/2)
    const TapeOp g = b.factor == constant ? TapeOp::cos : TapeOp::sin;
    const double shift = wave.op() == TapeOp::sin ? -std::numbers::pi / 2 : 0;
    return Square{2 * factor, g, wave.argument(), shift, true};
  }
  if (wave.op() == TapeOp::power_constant && (wave.last - 1)->value == 2 && b.factor == -constant) {
    const Part base = wave.argument();
    if (is_wave(base.op())) return Square{factor, other_wave(base.op()), base.argument(), 0, false};
  }
  return {};
}

void append(Tape& tape, TapeOp op, double value = 0) {
  tape.push_back({op, value});
}

bool fits_the_stack(const Tape& tape) {
  std::size_t depth = 0, most = 0;
  for (const TapeInstruction& instruction : tape) {
    depth = depth + 1 - static_cast<std::size_t>(arity(instruction.op));
    most = std::max(most, depth);
  }
  return most <= kTapeStack;
}

}  // namespace

bool take_root(Tape& tape, double exponent) {
  TapeInstruction& last = tape.back();
  if (last.op == TapeOp::power_constant && last.value > 0 && std::fmod(last.value, 2) == 0) {
    exponent *= last.value;
    tape.pop_back();
    if (std::fmod(exponent, 2) != 0) append(tape, TapeOp::abs);
    if (exponent != 1) append(tape, TapeOp::power_constant, exponent);
    return true;
  }
  const Part whole = Part::ending_at(tape.cend());
  const std::optional<Square> square = as_square(whole);
  if (!square || !(square->factor > 0)) return false;
  Tape by(square->x.first, square->x.last);
  if (square->shift != 0) append(by, TapeOp::constant, square->shift), append(by, TapeOp::add);
  if (square->half) append(by, TapeOp::constant, 0.5), append(by, TapeOp::multiply);
  append(by, square->g);
  append(by, TapeOp::abs);
  if (exponent != 0.5) append(by, TapeOp::power_constant, 2 * exponent);
  append(by, TapeOp::constant, std::pow(square->factor, exponent));
  append(by, TapeOp::multiply);
  tape.erase(whole.first, whole.last);
  tape.insert(tape.end(), by.begin(), by.end());
  return true;
}

bool take_arc(Tape& tape, TapeOp arc) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const TapeOp wave = tape.back().op;
  if (!is_wave(wave)) return false;
  Tape taken(tape.begin(), tape.end() - 1);
  if (wave == TapeOp::sin) append(taken, TapeOp::constant, kQuarter), append(taken, TapeOp::subtract);
  append(taken, TapeOp::fold);
  if (arc == TapeOp::asin) {
    append(taken, TapeOp::negate);
    append(taken, TapeOp::constant, kQuarter), append(taken, TapeOp::add);
  }
  if (!fits_the_stack(taken)) return false;
  tape = std::move(taken);
  return true;
}

}  // namespace poinsot
