#include "core/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace poinsot {
namespace {

struct Function {
  std::string_view name;
  TapeOp op;
};
constexpr Function kFunctions[] = {
    {"sin", TapeOp::sin},   {"cos", TapeOp::cos},   {"tan", TapeOp::tan},     {"asin", TapeOp::asin},
    {"acos", TapeOp::acos}, {"atan", TapeOp::atan}, {"atan2", TapeOp::atan2}, {"sinh", TapeOp::sinh},
    {"cosh", TapeOp::cosh}, {"tanh", TapeOp::tanh}, {"exp", TapeOp::exp},     {"log", TapeOp::log},
    {"sqrt", TapeOp::sqrt}, {"abs", TapeOp::abs},   {"pow", TapeOp::power},   {"min", TapeOp::min},
    {"max", TapeOp::max},
};

// Recursive descent; every rule appends its value's instructions to the tape.
class Parser {
 public:
  Parser(std::string_view text, bool with_time) : text_(text), with_time_(with_time) {}

  std::vector<TapeInstruction> parse() {
    sum();
    if (position_ != text_.size()) fail("expected an operator");
    return std::move(tape_);
  }

 private:
  static constexpr int kNesting = 64;

  void sum() {
    product();
    for (;;) {
      if (accept('+')) {
        product();
        emit(TapeOp::add);
      } else if (accept('-')) {
        product();
        emit(TapeOp::subtract);
      } else {
        return;
      }
    }
  }

  void product() {
    factor();
    for (;;) {
      if (accept('*')) {
        factor();
        emit(TapeOp::multiply);
      } else if (accept('/')) {
        factor();
        emit(TapeOp::divide);
      } else {
        return;
      }
    }
  }

  void factor() {  // a sign, or a power; every recursion passes here
    if (++nesting_ > kNesting) too_deep();
    if (accept('-')) {
      factor();
      emit(TapeOp::negate);
    } else if (accept('+')) {
      factor();
    } else {
      primary();
      if (accept('^')) {
        factor();
        emit(TapeOp::power);
      }
    }
    --nesting_;
  }

  void primary() {
    skip_blanks();
    const char c = position_ < text_.size() ? text_[position_] : '\0';
    if (accept('(')) {
      sum();
      expect(')');
    } else if (is_digit(c) || c == '.') {
      number();
    } else if (is_letter(c)) {
      name();
    } else {
      fail("expected a number, a name or '('");
    }
  }

  void number() {
    double value = 0;
    const char* first = text_.data() + position_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range) {
      throw ExpressionError(fmt::format("the number at character {} is out of the range of a double", position_ + 1));
    }
    if (error != std::errc()) fail("expected a number, a name or '('");
    position_ += static_cast<std::size_t>(end - first);
    skip_blanks();
    push({TapeOp::constant, value});
  }

  void name() {
    const std::size_t start = position_;
    while (position_ < text_.size() && (is_letter(text_[position_]) || is_digit(text_[position_]))) ++position_;
    const std::string_view found = text_.substr(start, position_ - start);
    skip_blanks();
    if (found == "pi") {
      push({TapeOp::constant, std::numbers::pi});
    } else if (found == "e") {
      push({TapeOp::constant, std::numbers::e});
    } else if (found == "t" && with_time_) {
      push({TapeOp::time, 0});
    } else if (const auto* f = std::ranges::find(kFunctions, found, &Function::name); f != std::end(kFunctions)) {
      expect('(');
      sum();
      if (arity(f->op) == 2) {
        expect(',');
        sum();
      }
      expect(')');
      emit(f->op);
    } else {
      throw ExpressionError(fmt::format("unknown name '{}' at character {}; known are {}pi, e and the functions {}",
                                        found, start + 1, with_time_ ? "t, " : "",
                                        fmt::join(Expression::function_names(), ", ")));
    }
  }

  // Appends an operation, or evaluates it at once where its arguments are constants. Each of those is one instruction.
  void emit(TapeOp op) {
    const auto constant = [&](std::size_t from_end) { return tape_[tape_.size() - from_end].op == TapeOp::constant; };
    const int arguments = arity(op);
    depth_ -= static_cast<std::size_t>(arguments - 1);
    if (constant(1) && (arguments == 1 || constant(2))) {
      tape_.push_back({op, 0});
      const std::size_t first = tape_.size() - 1 - static_cast<std::size_t>(arguments);
      const double value = run_tape<double>(std::span(tape_).subspan(first), 0.0).f;
      if (!std::isfinite(value)) {
        throw ExpressionError(fmt::format("the constant part that ends at character {} is not finite", end_of_part()));
      }
      tape_.resize(first);
      tape_.push_back({TapeOp::constant, value});
    } else if (op == TapeOp::power && constant(1)) {
      tape_.back().op = TapeOp::power_constant;
    } else {
      tape_.push_back({op, 0});
    }
  }

  void push(const TapeInstruction& instruction) {
    if (++depth_ > kTapeStack) too_deep();
    tape_.push_back(instruction);
  }

  bool accept(char c) {
    skip_blanks();
    if (position_ >= text_.size() || text_[position_] != c) return false;
    ++position_;
    skip_blanks();
    return true;
  }

  void expect(char c) {
    if (!accept(c)) fail(fmt::format("expected '{}'", c));
  }

  void skip_blanks() {
    while (position_ < text_.size() && (text_[position_] == ' ' || text_[position_] == '\t')) ++position_;
  }

  std::size_t end_of_part() const {
    const std::size_t last = text_.find_last_not_of(" \t", position_ == 0 ? 0 : position_ - 1);
    return last + 1;
  }

  [[noreturn]] void fail(std::string_view expected) const {
    std::string found = "found the end";
    if (position_ < text_.size()) {
      const char c = text_[position_];
      const bool printable = c >= ' ' && c <= '~';
      found =
          printable ? fmt::format("found '{}'", c) : fmt::format("found byte 0x{:02X}", static_cast<unsigned char>(c));
    }
    throw ExpressionError(fmt::format("{} at character {}, {}", expected, position_ + 1, found));
  }

  [[noreturn]] void too_deep() const {
    throw ExpressionError(fmt::format("nested too deeply at character {}", position_ + 1));
  }

  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

  std::string_view text_;
  bool with_time_;
  std::size_t position_ = 0;
  int nesting_ = 0;
  std::size_t depth_ = 0;  // values on the stack
  std::vector<TapeInstruction> tape_;
};

}  // namespace

Expression::Expression(double constant) : value_(constant) {}

std::string Expression::text() const {
  return parsed_ ? parsed_->text : fmt::format("{}", value_);
}

Expression Expression::parse(std::string_view text, bool with_time) {
  Parsed parsed{std::string(text), Parser(text, with_time).parse()};
  Expression expression;
  expression.constant_ = parsed.tape.size() == 1 && parsed.tape[0].op == TapeOp::constant;
  if (expression.constant_) {
    expression.value_ = parsed.tape[0].value;
    parsed.tape.clear();
  }
  expression.parsed_ = std::make_shared<const Parsed>(std::move(parsed));
  return expression;
}

Expression Expression::parse(std::string_view text) {
  return parse(text, true);
}

Expression Expression::parse_constant(std::string_view text) {
  return parse(text, false);
}

std::vector<std::string_view> Expression::function_names() {
  std::vector<std::string_view> names;
  for (const Function& function : kFunctions) names.push_back(function.name);
  return names;
}

}  // namespace poinsot
