#include "core/expression_tape.h"

#include <cmath>

#include "core/wide.h"

namespace poinsot {
namespace {

using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp, std::hypot, std::log,
    std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;

template <class T>
bool is_number(const T& x) {
  return x == x;
}

// So large or small that its cube may be no number or nothing.
template <class T>
bool outside(const T& x) {
  return abs(x) > T(1e75) || (abs(x) < T(1e-75) && !(x == 0));
}

// A value that varies with nothing on either side of a jump; no number stays none.
template <class T>
Jet2<T> level(const Jet2<T>& x, T value) {
  return {is_number(x.f) ? value : x.f, T(0), T(0)};
}

// xⁿ with a constant exponent. A vanishing coefficient comes before a negative power of x = 0; and where n > 1 so does
// ẋ = 0, beside which x, and so xⁿ, is as flat on either side.
template <class T>
Jet2<T> power_constant(const Jet2<T>& x, T n) {
  if (n == 0) return level(x, T(1));
  if (n == 2) return compose(x, x.f * x.f, 2 * x.f, T(2));
  const T f = pow(x.f, n);
  if (n == 1) return x;
  if (outside(x.f)) {  // powers of it that n is lessened for may not be
    const T r = x.fd / x.f;
    return {f, f * n * r, f * n * ((n - 1) * r * r + x.fdd / x.f)};
  }
  const T first = n * pow(x.f, n - 1);
  if (n > 1 && x.fd == 0) return {f, first * x.fd, first * x.fdd};
  return compose(x, f, first, n * (n - 1) * pow(x.f, n - 2));
}

// ḟ = ẋ/x, where x² may be outside of all numbers.
template <class T>
Jet2<T> logarithm(const Jet2<T>& x) {
  const T fd = x.fd / x.f;
  return {log(x.f), fd, x.fdd / x.f - fd * fd};
}

template <class T>
Jet2<T> of_table(const Spline& table, const Jet2<T>& x) {
  return table.at(x);
}
template <class M>
Jet2<Wide<M>> of_table(const Spline& table, const Jet2<Wide<M>>& x) {
  const Jet2<M> f = table.at(Jet2<M>{M(x.f), M(x.fd), M(x.fdd)});
  return {f.f, f.fd, f.fdd};
}

template <class T>
Jet2<T> function(const TapeInstruction& instruction, const Jet2<T>& x) {
  switch (instruction.op) {
    case TapeOp::negate:
      return {-x.f, -x.fd, -x.fdd};
    case TapeOp::sin: {
      const T s = sin(x.f), c = cos(x.f);
      return compose(x, s, c, -s);
    }
    case TapeOp::cos: {
      const T s = sin(x.f), c = cos(x.f);
      return compose(x, c, -s, -c);
    }
    case TapeOp::tan: {
      const T f = tan(x.f), first = 1 + f * f;
      return compose(x, f, first, 2 * f * first);
    }
    case TapeOp::asin:
    case TapeOp::acos: {
      const T square = (1 - x.f) * (1 + x.f), first = 1 / sqrt(square), second = x.f * first / square;
      return instruction.op == TapeOp::asin ? compose(x, asin(x.f), first, second)
                                            : compose(x, acos(x.f), -first, -second);
    }
    case TapeOp::atan: {
      const T first = 1 / (1 + x.f * x.f);
      return compose(x, atan(x.f), first, -2 * x.f * first * first);
    }
    case TapeOp::sinh: {
      const T f = sinh(x.f);
      return compose(x, f, cosh(x.f), f);
    }
    case TapeOp::cosh: {
      const T f = cosh(x.f);
      return compose(x, f, sinh(x.f), f);
    }
    case TapeOp::tanh: {
      const T f = tanh(x.f), c = cosh(x.f), first = 1 / (c * c);  // 1 − f² would cancel
      return compose(x, f, first, -2 * f * first);
    }
    case TapeOp::exp: {
      const T f = exp(x.f);
      return compose(x, f, f, f);
    }
    case TapeOp::log:
      return logarithm(x);
    case TapeOp::sqrt: {
      const T f = sqrt(x.f), fd = x.fd / (2 * f);
      return {f, fd, (x.fdd / 2 - fd * fd) / f};
    }
    case TapeOp::abs:
      return x.f < 0 ? Jet2<T>{-x.f, -x.fd, -x.fdd} : x;
    case TapeOp::sign:
      return level(x, T(x.f > 0) - T(x.f < 0));
    case TapeOp::step:
      return level(x, T(x.f >= 0));
    case TapeOp::fold: {
      const T s = sin(x.f);
      return compose(x, atan2(abs(s), cos(x.f)), T(s < 0 ? -1 : 1), T(0));
    }
    case TapeOp::table:
      return of_table(*instruction.table, x);
    default:
      return power_constant(x, T(instruction.value));
  }
}

template <class T>
Jet2<T> operation(TapeOp op, const Jet2<T>& x, const Jet2<T>& y) {
  switch (op) {
    case TapeOp::add:
      return {x.f + y.f, x.fd + y.fd, x.fdd + y.fdd};
    case TapeOp::subtract:
      return {x.f - y.f, x.fd - y.fd, x.fdd - y.fdd};
    case TapeOp::multiply:
      return {x.f * y.f, x.fd * y.f + x.f * y.fd, x.fdd * y.f + 2 * x.fd * y.fd + x.f * y.fdd};
    case TapeOp::divide: {  // x = f y, differentiated and solved for the derivatives of f
      const T f = x.f / y.f, fd = (x.fd - f * y.fd) / y.f;
      return {f, fd, (x.fdd - 2 * fd * y.fd - f * y.fdd) / y.f};
    }
    case TapeOp::power: {  // f = exp(g), g = y log x
      const Jet2<T> g = operation(TapeOp::multiply, y, logarithm(x));
      const T f = is_number(x.f) && is_number(y.f) ? pow(x.f, y.f) : g.f;  // 1^y and x^0 are 1 whatever y and x
      return compose(g, f, f, f);
    }
    case TapeOp::atan2: {  // angle of the point (y, x): ḟ = (y ẋ − x ẏ) / (x² + y²)
      const T r = hypot(x.f, y.f), a = x.f / r, b = y.f / r, ad = x.fd / r, bd = y.fd / r;
      const T fd = b * ad - a * bd;
      return {atan2(x.f, y.f), fd, b * (x.fdd / r) - a * (y.fdd / r) - 2 * fd * (a * ad + b * bd)};
    }
    case TapeOp::min:
      return y.f < x.f || !is_number(y.f) ? y : x;
    default:
      return y.f > x.f || !is_number(y.f) ? y : x;
  }
}

// Runs the tape; watch(instruction, x, y) sees every function and operator with its arguments before it is applied, y
// only of those that have two.
template <class T, class Watch>
Jet2<T> run(std::span<const TapeInstruction> tape, const Arguments<Jet2<T>>& at, Watch watch) {
  struct Slot {  // a Jet2 that is not set to zero first
    T f, fd, fdd;
    void operator=(const Jet2<T>& x) { f = x.f, fd = x.fd, fdd = x.fdd; }
    operator Jet2<T>() const { return {f, fd, fdd}; }
  } stack[kTapeStack];
  Slot* top = stack;  // one past the topmost value
  for (const TapeInstruction& instruction : tape) {
    switch (instruction.op) {
      case TapeOp::constant:
        *top++ = Jet2<T>{T(instruction.value), T(0), T(0)};
        break;
      case TapeOp::time:
        *top++ = at.t;
        break;
      case TapeOp::elongation:
        *top++ = at.x;
        break;
      case TapeOp::rate:
        *top++ = at.v;
        break;
      default:
        if (arity(instruction.op) == 1) {
          watch(instruction, top[-1].f, T(0));
          top[-1] = function<T>(instruction, top[-1]);
        } else {
          watch(instruction, top[-2].f, top[-1].f);
          top[-2] = operation<T>(instruction.op, top[-2], top[-1]);
          --top;
        }
    }
  }
  return stack[0];
}

Arguments<Jet2<double>> constants(const Arguments<double>& at) {
  return {{at.t, 0, 0}, {at.x, 0, 0}, {at.v, 0, 0}};
}

}  // namespace

template <class T>
Jet2<T> run_tape(std::span<const TapeInstruction> tape, const Arguments<Jet2<T>>& at) {
  const auto nothing = [](const TapeInstruction&, const auto&, const auto&) {};
  const Jet2<T> f = run<T>(tape, at, nothing);
  if (std::isfinite(f.fd) && std::isfinite(f.fdd)) [[likely]]
    return f;
  const auto wide = [](const Jet2<T>& x) { return Jet2<Wide<T>>{x.f, x.fd, x.fdd}; };
  const Jet2<Wide<T>> again = run<Wide<T>>(tape, {wide(at.t), wide(at.x), wide(at.v)}, nothing);
  return {T(again.f), T(again.fd), T(again.fdd)};
}

template Jet2<double> run_tape(std::span<const TapeInstruction>, const Arguments<Jet2<double>>&);
template Jet2<long double> run_tape(std::span<const TapeInstruction>, const Arguments<Jet2<long double>>&);

void tape_switches(std::span<const TapeInstruction> tape, const Arguments<double>& at, std::span<double> out) {
  std::size_t k = 0;
  run<double>(tape, constants(at), [&](const TapeInstruction& instruction, double x, double y) {
    if (has_switch(instruction.op)) out[k++] = instruction.op == TapeOp::fold ? sin(x) : x - y;
  });
}

void tape_cubics(std::span<const TapeInstruction> tape, const Arguments<double>& at, std::span<int> out) {
  std::size_t k = 0;
  run<double>(tape, constants(at), [&](const TapeInstruction& instruction, double x, double) {
    if (instruction.op == TapeOp::table && k < out.size()) out[k++] = instruction.table->cubic(x);
  });
}

Uncovered first_uncovered(std::span<const TapeInstruction> tape, const Arguments<double>& at) {
  Uncovered found;
  run<double>(tape, constants(at), [&](const TapeInstruction& instruction, double x, double) {
    if (instruction.op == TapeOp::table && !found.table && !instruction.table->covers(x))
      found = {instruction.table, x};
  });
  return found;
}

}  // namespace poinsot
