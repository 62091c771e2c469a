#include "core/expression_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace poinsot {
namespace {

using Jet = Jet2<Bounds>;

// φ, φ' and φ'' of a function of one argument.
struct Taylor {
  Bounds value, first, second;
};

constexpr Taylor kUnbounded{Bounds::all(), Bounds::all(), Bounds::all()};
constexpr Taylor kUnknown{Bounds::unknown(), Bounds::unknown(), Bounds::unknown()};

Taylor of_table(const Spline& table, Bounds x) {
  if (!table.covers(std::clamp(0.5 * (table.first() + table.last()), x.least, x.most))) return kUnknown;
  const Jet2<Bounds> f = table.range(std::max(x.least, table.first()), std::min(x.most, table.last()));
  return {widened(f.f.least, f.f.most), widened(f.fd.least, f.fd.most), widened(f.fdd.least, f.fdd.most)};
}

Taylor of_arc(Bounds x, bool sine) {
  const Bounds inside{std::clamp(x.least, -1.0, 1.0), std::clamp(x.most, -1.0, 1.0)};
  const Bounds rest = (Bounds{1, 1} - inside) * (Bounds{1, 1} + inside);
  const Bounds first =
      reciprocal(rising({std::max(rest.least, 0.0), rest.most}, [](double a) { return std::sqrt(a); }));
  const Bounds second = inside * first * reciprocal(rest);
  if (sine) return {rising(inside, [](double a) { return std::asin(a); }), first, second};
  return {rising(-inside, [](double a) { return std::acos(-a); }), -first, -second};
}

Taylor function(const TapeInstruction& instruction, Bounds x) {
  constexpr Bounds one{1, 1}, level{0, 0};
  switch (instruction.op) {
    case TapeOp::negate:
      return {-x, -one, level};
    case TapeOp::sin:
      return {sine(x), cosine(x), -sine(x)};
    case TapeOp::cos:
      return {cosine(x), -sine(x), -cosine(x)};
    case TapeOp::tan: {
      const Bounds c = cosine(x);
      if (c.least <= 0 && c.most >= 0) return kUnbounded;
      const Bounds f = rising(x, [](double a) { return std::tan(a); }), first = one + square(f);
      return {f, first, 2 * (f * first)};
    }
    case TapeOp::asin:
    case TapeOp::acos:
      return of_arc(x, instruction.op == TapeOp::asin);
    case TapeOp::atan: {
      const Bounds first = reciprocal(one + square(x));
      return {rising(x, [](double a) { return std::atan(a); }), first, -2 * (x * square(first))};
    }
    case TapeOp::sinh:
    case TapeOp::cosh: {
      const Bounds s = rising(x, [](double a) { return std::sinh(a); });
      const Bounds c = rising(magnitude(x), [](double a) { return std::cosh(a); });
      return instruction.op == TapeOp::sinh ? Taylor{s, c, s} : Taylor{c, s, c};
    }
    case TapeOp::tanh: {
      const Bounds f = rising(x, [](double a) { return std::tanh(a); });
      const Bounds first = reciprocal(square(rising(magnitude(x), [](double a) { return std::cosh(a); })));
      return {f, first, -2 * (f * first)};
    }
    case TapeOp::exp: {
      const Bounds f = rising(x, [](double a) { return std::exp(a); });
      return {f, f, f};
    }
    case TapeOp::log: {
      const Bounds first = reciprocal(x);
      return x.least > 0 ? Taylor{rising(x, [](double a) { return std::log(a); }), first, -square(first)} : kUnbounded;
    }
    case TapeOp::sqrt: {
      const Bounds f = rising({std::max(x.least, 0.0), x.most}, [](double a) { return std::sqrt(a); });
      const Bounds first = reciprocal(2 * f);
      return {f, first, -(first * reciprocal(2 * x))};
    }
    case TapeOp::abs:
      return {magnitude(x), x.least >= 0 ? one : x.most <= 0 ? -one : Bounds{-1, 1}, level};
    case TapeOp::fold: {
      const Bounds c = cosine(x), s = sine(x);
      const Bounds f =
          rising(-Bounds{std::max(c.least, -1.0), std::min(c.most, 1.0)}, [](double a) { return std::acos(-a); });
      return {f, s.least >= 0 ? one : s.most <= 0 ? -one : Bounds{-1, 1}, level};
    }
    case TapeOp::sign:
      return {{x.least < 0 ? -1.0 : x.least > 0 ? 1.0 : 0.0, x.most > 0 ? 1.0 : x.most < 0 ? -1.0 : 0.0}, level, level};
    case TapeOp::step:
      return {{x.least >= 0 ? 1.0 : 0.0, x.most >= 0 ? 1.0 : 0.0}, level, level};
    case TapeOp::table:
      return of_table(*instruction.table, x);
    default: {  // a constant exponent
      const double n = instruction.value;
      const Bounds second = n == 1 ? level : (n * (n - 1)) * power(x, n - 2);
      return {power(x, n), n == 0 ? level : n * power(x, n - 1), n == 0 ? level : second};
    }
  }
}

Jet after(const Jet& x, const Taylor& f) {
  return {f.value, f.first * x.fd, f.second * square(x.fd) + f.first * x.fdd};
}

Jet operator*(const Jet& x, const Jet& y) {
  return {x.f * y.f, x.fd * y.f + x.f * y.fd, x.fdd * y.f + 2 * (x.fd * y.fd) + x.f * y.fdd};
}

// f = atan2(y, x): ḟ (x² + y²) = ẏ x − y ẋ, and that differentiated.
Jet angle(const Jet& y, const Jet& x) {
  const Bounds per_square = reciprocal(square(x.f) + square(y.f));
  const Bounds first = (x.f * y.fd - y.f * x.fd) * per_square, half = x.f * x.fd + y.f * y.fd;
  return {{-std::numbers::pi, std::numbers::pi}, first, (x.f * y.fdd - y.f * x.fdd - 2 * (first * half)) * per_square};
}

Bounds lesser(Bounds x, Bounds y) {
  return {std::min(x.least, y.least), std::min(x.most, y.most)};
}

Jet operation(TapeOp op, const Jet& x, const Jet& y) {
  switch (op) {
    case TapeOp::add:
      return {x.f + y.f, x.fd + y.fd, x.fdd + y.fdd};
    case TapeOp::subtract:
      return {x.f - y.f, x.fd - y.fd, x.fdd - y.fdd};
    case TapeOp::multiply:
      return x * y;
    case TapeOp::divide: {
      const Bounds per = reciprocal(y.f);
      return x * after(y, {per, -square(per), 2 * (per * square(per))});
    }
    case TapeOp::power: {  // exp(y log x)
      if (!(x.f.least > 0)) return {Bounds::all(), Bounds::all(), Bounds::all()};
      const Jet g = y * after(x, function({TapeOp::log, 0}, x.f));
      const Bounds f = power(x.f, y.f);
      return after(g, {f, f, f});
    }
    case TapeOp::atan2:
      return angle(x, y);
    default: {  // min, max
      const bool least = op == TapeOp::min;
      if (x.f.most < y.f.least) return least ? x : y;
      if (y.f.most < x.f.least) return least ? y : x;
      return {least ? lesser(x.f, y.f) : -lesser(-x.f, -y.f), hull(x.fd, y.fd), hull(x.fdd, y.fdd)};
    }
  }
}

// The derivatives are those by `by`. watch(instruction, x, y) sees every function and operator before it
// is applied, until it returns true.
template <class Watch>
Jet run(std::span<const TapeInstruction> tape, const Arguments<Bounds>& at, TapeOp by, Watch watch) {
  constexpr Jet unknown{Bounds::unknown(), Bounds::unknown(), Bounds::unknown()};
  Jet stack[kTapeStack];
  Jet* top = stack;  // one past the topmost value
  for (const TapeInstruction& instruction : tape) {
    if (instruction.op == TapeOp::constant) {
      *top++ = {{instruction.value, instruction.value}, {}, {}};
    } else if (arity(instruction.op) == 0) {
      const TapeOp op = instruction.op;
      *top++ = {op == TapeOp::time ? at.t : op == TapeOp::rate ? at.v : at.x, op == by ? Bounds{1, 1} : Bounds{}, {}};
    } else if (arity(instruction.op) == 1) {
      if (watch(instruction, top[-1].f, Bounds{})) break;
      top[-1] = top[-1].f.is_unknown() ? unknown : after(top[-1], function(instruction, top[-1].f));
    } else {
      if (watch(instruction, top[-2].f, top[-1].f)) break;
      const bool known = !top[-2].f.is_unknown() && !top[-1].f.is_unknown();
      top[-2] = known ? operation(instruction.op, top[-2], top[-1]) : unknown;
      --top;
    }
  }
  return stack[0];
}

}  // namespace

Jet2<Bounds> tape_range(std::span<const TapeInstruction> tape, const Arguments<Bounds>& at, TapeOp by) {
  return run(tape, at, by, [](const TapeInstruction&, Bounds, Bounds) { return false; });
}

Bounds tape_switch_range(std::span<const TapeInstruction> tape, const Arguments<Bounds>& at, int k) {
  Bounds found = Bounds::unknown();
  run(tape, at, TapeOp::time, [&](const TapeInstruction& instruction, Bounds x, Bounds y) {
    if (!has_switch(instruction.op) || k-- > 0) return false;
    const bool known = !x.is_unknown() && !y.is_unknown();
    if (!known) return true;
    found = instruction.op == TapeOp::fold ? sine(x) : arity(instruction.op) == 1 ? x : x - y;
    return true;
  });
  return found;
}

bool tape_switch_jumps(std::span<const TapeInstruction> tape, int k) {
  for (const TapeInstruction& instruction : tape)
    if (has_switch(instruction.op) && k-- == 0) return instruction.op == TapeOp::sign || instruction.op == TapeOp::step;
  return false;
}

}  // namespace poinsot
