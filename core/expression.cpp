#include "core/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/expression_parser.h"
#include "core/expression_terms.h"

namespace poinsot {

std::string Expression::text() const {
  return parsed_ ? parsed_->text : fmt::format("{}", value_);
}

Expression::Expression(std::string_view text, ParsedTape parsed) {
  auto kept = std::make_shared<Parsed>();
  kept->text = text;
  constant_ = parsed.tape.size() == 1 && parsed.tape[0].op == TapeOp::constant;
  if (constant_) {
    value_ = parsed.tape[0].value;
  } else {
    kept->tape = std::move(parsed.tape);
    kept->tables = std::move(parsed.tables);
    look_through(*kept);
  }
  parsed_ = std::move(kept);
}

void Expression::look_through(Parsed& parsed) {
  const auto& tape = parsed.tape;
  parsed.switches =
      static_cast<int>(std::ranges::count_if(tape, [](const TapeInstruction& i) { return has_switch(i.op); }));
  const auto has = [&](TapeOp op) { return std::ranges::find(tape, op, &TapeInstruction::op) != tape.end(); };
  parsed.with_elongation = has(TapeOp::elongation);
  parsed.with_rate = has(TapeOp::rate);
  parsed.with_time = has(TapeOp::time);
}

std::vector<Expression> Expression::hidden_terms() const {
  if (constant_ || is_function()) return {};
  std::vector<Tape> tapes = tape_terms(parsed_->tape);
  if (tapes.empty()) return {};
  if (tapes.size() > 1) tapes.insert(tapes.begin(), sum_of(tapes));
  std::vector<Expression> terms(tapes.size(), *this);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    auto kept = std::make_shared<Parsed>(*parsed_);
    kept->tape = std::move(tapes[k]);
    look_through(*kept);
    terms[k].parsed_ = std::move(kept);
  }
  return terms;
}

Expression Expression::parse(std::string_view text, ExpressionNames* names) {
  return {text, parse_expression(text, Variables::time, names)};
}

Expression Expression::parse_constant(std::string_view text, ExpressionNames* names) {
  return {text, parse_expression(text, Variables::none, names)};
}

Expression Expression::parse_law(std::string_view text, ExpressionNames* names) {
  return {text, parse_expression(text, Variables::law, names)};
}

Expression Expression::function(std::function<Jet2<double>(double t)> f) {
  auto kept = std::make_shared<Parsed>();
  kept->text = "a function of the program";
  kept->function = std::move(f);
  Expression result;
  result.constant_ = false;
  result.parsed_ = std::move(kept);
  return result;
}

// Central differences of order 4; the step balances what rounding and the next derivative leave of f̈.
Expression Expression::function(std::function<double(double t)> f) {
  return function([f = std::move(f)](double t) -> Jet2<double> {
    constexpr double h = 1.0 / 400;
    const double middle = f(t), near[] = {f(t - h), f(t + h)}, far[] = {f(t - 2 * h), f(t + 2 * h)};
    return {middle, (8 * (near[1] - near[0]) - (far[1] - far[0])) / (12 * h),
            (16 * (near[0] + near[1]) - (far[0] + far[1]) - 30 * middle) / (12 * h * h)};
  });
}

std::string Expression::fault(double t, int derivatives) const {
  const Jet2<double> f = at(t);
  const double values[] = {f.f, f.fd, f.fdd};
  constexpr const char* kWhich[] = {"", "the first derivative of ", "the second derivative of "};
  for (std::size_t k = 0; k <= static_cast<std::size_t>(derivatives); ++k)
    if (!std::isfinite(values[k])) return not_finite(kWhich[k], {t, 0, 0}, "");
  return {};
}

std::string Expression::law_fault(const Arguments<double>& at) const {
  const LawValue<double> value = law(at);
  const double values[] = {value.F, value.F_x, value.F_v};
  constexpr const char* kWhich[] = {"", "the derivative with x of ", "the derivative with v of "};
  for (std::size_t k = 0; k < 3; ++k)
    if (!std::isfinite(values[k]))
      return not_finite(kWhich[k], at, fmt::format(" at x = {:.9g}, v = {:.9g}", at.x, at.v));
  return {};
}

std::string Expression::not_finite(const char* which, const Arguments<double>& at, const std::string& where) const {
  const Uncovered found = constant_ || is_function() ? Uncovered{} : first_uncovered(parsed_->tape, at);
  if (found.table) return fmt::format("'{}': {}", text(), describe(found));
  return fmt::format("{}'{}' is not finite{}", which, text(), where);
}

}  // namespace poinsot
