#include "core/expression_range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace poinsot {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();  // of a function, relative

struct Range {
  double least, most;
};
constexpr Range kAll{-kInfinity, kInfinity};

// Exact results are rounded; those of functions by more. What is not a number could be anything.
Range widened(double least, double most) {
  if (!(least <= most)) return kAll;
  return {least - kRounding * std::abs(least), most + kRounding * std::abs(most)};
}

template <class F>
Range rising(Range x, F f) {
  return widened(f(x.least), f(x.most));
}

Range product(Range x, Range y) {
  double least = kInfinity, most = -kInfinity;
  for (const double a : {x.least, x.most}) {
    for (const double b : {y.least, y.most}) {
      const double ab = a == 0 || b == 0 ? 0 : a * b;
      least = std::min(least, ab), most = std::max(most, ab);
    }
  }
  return widened(least, most);
}

Range reciprocal(Range x) {
  return x.least > 0 || x.most < 0 ? widened(1 / x.most, 1 / x.least) : kAll;
}

// sin, or cos as sin a quarter turn on.
Range sine(Range x) {
  constexpr double turn = 2 * std::numbers::pi;
  if (!(x.most - x.least < turn) || !(std::abs(x.least) < 1e8)) return {-1, 1};
  const auto passes = [&](double peak) {  // up to rounding
    const double slack = kRounding * (1 + std::abs(x.least) + std::abs(x.most));
    return peak + turn * std::ceil((x.least - slack - peak) / turn) <= x.most + slack;
  };
  const auto [least, most] = std::minmax({std::sin(x.least), std::sin(x.most)});
  const double slack = kRounding * (1 + std::abs(x.least) + std::abs(x.most));
  return {passes(-std::numbers::pi / 2) ? -1 : least - slack, passes(std::numbers::pi / 2) ? 1 : most + slack};
}

Range magnitude(Range x) {
  const double most = std::max(std::abs(x.least), std::abs(x.most));
  return {x.least <= 0 && x.most >= 0 ? 0 : std::min(std::abs(x.least), std::abs(x.most)), most};
}

Range constant_power(Range x, double n) {
  if (n < 0) return reciprocal(constant_power(x, -n));
  const auto power = [n](double a) { return std::pow(a, n); };
  if (n != std::floor(n)) return x.most < 0 ? kAll : rising({std::max(x.least, 0.0), x.most}, power);
  return std::fmod(n, 2) == 0 ? rising(magnitude(x), power) : rising(x, power);
}

Range power(Range x, Range y) {  // exp(y log x)
  if (!(x.least > 0)) return kAll;
  const Range exponent = product(y, rising(x, [](double a) { return std::log(a); }));
  return rising(exponent, [](double a) { return std::exp(a); });
}

// Taylor's formula about the middle.
Range of_table(const Spline& table, Range x) {
  const double middle = x.least + (x.most - x.least) / 2, r = (x.most - x.least) / 2;
  const Jet2<double> f = table.at(Jet2<double>{middle, 1, 0});
  const double off = std::abs(f.fd) * r + table.largest_second_derivative() * r * r / 2;
  return widened(f.f - off, f.f + off);
}

Range function(const TapeInstruction& instruction, Range x) {
  switch (instruction.op) {
    case TapeOp::negate:
      return {-x.most, -x.least};
    case TapeOp::sin:
      return sine(x);
    case TapeOp::cos:
      return sine({x.least + std::numbers::pi / 2, x.most + std::numbers::pi / 2});
    case TapeOp::asin:
      return rising({std::max(x.least, -1.0), std::min(x.most, 1.0)}, [](double a) { return std::asin(a); });
    case TapeOp::acos:
      return rising({-std::min(x.most, 1.0), -std::max(x.least, -1.0)}, [](double a) { return std::acos(-a); });
    case TapeOp::atan:
      return rising(x, [](double a) { return std::atan(a); });
    case TapeOp::sinh:
      return rising(x, [](double a) { return std::sinh(a); });
    case TapeOp::cosh:
      return rising(magnitude(x), [](double a) { return std::cosh(a); });
    case TapeOp::tanh:
      return rising(x, [](double a) { return std::tanh(a); });
    case TapeOp::exp:
      return rising(x, [](double a) { return std::exp(a); });
    case TapeOp::log:
      return x.least > 0 ? rising(x, [](double a) { return std::log(a); }) : kAll;
    case TapeOp::sqrt:
      return rising({std::max(x.least, 0.0), x.most}, [](double a) { return std::sqrt(a); });
    case TapeOp::abs:
      return magnitude(x);
    case TapeOp::sign:
      return {x.least < 0 ? -1.0 : x.least > 0 ? 1.0 : 0.0, x.most > 0 ? 1.0 : x.most < 0 ? -1.0 : 0.0};
    case TapeOp::step:
      return {x.least >= 0 ? 1.0 : 0.0, x.most >= 0 ? 1.0 : 0.0};
    case TapeOp::table:
      return of_table(*instruction.table, x);
    case TapeOp::power_constant:
      return constant_power(x, instruction.value);
    default:  // tan
      return kAll;
  }
}

Range operation(TapeOp op, Range x, Range y) {
  switch (op) {
    case TapeOp::add:
      return widened(x.least + y.least, x.most + y.most);
    case TapeOp::subtract:
      return widened(x.least - y.most, x.most - y.least);
    case TapeOp::multiply:
      return product(x, y);
    case TapeOp::divide:
      return product(x, reciprocal(y));
    case TapeOp::power:
      return power(x, y);
    case TapeOp::atan2:
      return widened(-std::numbers::pi, std::numbers::pi);
    case TapeOp::min:
      return {std::min(x.least, y.least), std::min(x.most, y.most)};
    default:
      return {std::max(x.least, y.least), std::max(x.most, y.most)};
  }
}

bool may_change_sign(Range x) {
  return x.least <= 0 && x.most >= 0 && !(x.least == 0 && x.most == 0);
}

}  // namespace

bool tape_may_switch(std::span<const TapeInstruction> tape, double from, double to) {
  Range stack[kTapeStack];
  Range* top = stack;  // one past the topmost value
  for (const TapeInstruction& instruction : tape) {
    if (instruction.op == TapeOp::constant) {
      *top++ = {instruction.value, instruction.value};
    } else if (arity(instruction.op) == 0) {
      *top++ = instruction.op == TapeOp::time ? Range{from, to} : kAll;
    } else if (arity(instruction.op) == 1) {
      if (has_switch(instruction.op) && may_change_sign(top[-1])) return true;
      top[-1] = function(instruction, top[-1]);
    } else {
      if (has_switch(instruction.op) && may_change_sign(operation(TapeOp::subtract, top[-2], top[-1]))) return true;
      top[-2] = operation(instruction.op, top[-2], top[-1]);
      --top;
    }
  }
  return false;
}

}  // namespace poinsot
