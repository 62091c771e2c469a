#include "core/expression_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>

#include "core/expression.h"
#include "core/expression_kinks.h"

namespace poinsot {
namespace {

template <class Value>
struct Named {
  std::string_view name;
  Value value;
};
constexpr Named<TapeOp> kFunctions[] = {
    {"sin", TapeOp::sin},   {"cos", TapeOp::cos},   {"tan", TapeOp::tan},     {"asin", TapeOp::asin},
    {"acos", TapeOp::acos}, {"atan", TapeOp::atan}, {"atan2", TapeOp::atan2}, {"sinh", TapeOp::sinh},
    {"cosh", TapeOp::cosh}, {"tanh", TapeOp::tanh}, {"exp", TapeOp::exp},     {"log", TapeOp::log},
    {"sqrt", TapeOp::sqrt}, {"abs", TapeOp::abs},   {"pow", TapeOp::power},   {"min", TapeOp::min},
    {"max", TapeOp::max},   {"sign", TapeOp::sign}, {"step", TapeOp::step},
};

constexpr Named<double> kConstants[] = {{"pi", std::numbers::pi}, {"e", std::numbers::e}};

template <class Value>
const Value* value_of(std::span<const Named<Value>> table, std::string_view name) {
  const auto found = std::ranges::find(table, name, &Named<Value>::name);
  return found == table.end() ? nullptr : &found->value;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Recursive descent; every rule appends its value's instructions to the tape.
class Parser {
 public:
  Parser(std::string_view text, Variables variables, ExpressionNames* names)
      : text_(text), variables_(variables), names_(names) {}

  ParsedTape parse() {
    sum();
    if (position_ != text_.size()) fail("expected an operator");
    return std::move(parsed_);
  }

 private:
  static constexpr int kNesting = 64;

  void sum() {
    product();
    while (const char sign = accept_one_of("+-")) {
      product();
      emit({sign == '+' ? TapeOp::add : TapeOp::subtract, 0});
    }
  }

  void product() {
    factor();
    while (const char sign = accept_one_of("*/")) {
      factor();
      emit({sign == '*' ? TapeOp::multiply : TapeOp::divide, 0});
    }
  }

  void factor() {  // a sign, or a power; every recursion passes here
    if (++nesting_ > kNesting) too_deep();
    if (accept('-')) {
      factor();
      emit({TapeOp::negate, 0});
    } else if (accept('+')) {
      factor();
    } else {
      primary();
      if (accept('^')) {
        factor();
        emit({TapeOp::power, 0});
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
    if (const std::optional<TapeOp> variable = this->variable(found)) {
      if (*variable != TapeOp::time && names_ && names_->parameter(found)) {
        throw ExpressionError(
            fmt::format("'{}' at character {} is a parameter, and in a law {}; give the parameter another name", found,
                        start + 1, *variable == TapeOp::rate ? "the rate" : "the elongation or angle"));
      }
      push({*variable, 0});
    } else if (const double* constant = value_of<double>(kConstants, found)) {
      push({TapeOp::constant, *constant});
    } else if (const TapeOp* function = value_of<TapeOp>(kFunctions, found)) {
      expect('(');
      sum();
      if (arity(*function) == 2) {
        expect(',');
        sum();
      }
      expect(')');
      emit({*function, 0});
    } else if (!of_the_scene(found)) {
      throw ExpressionError(fmt::format("unknown name '{}' at character {}; known are {}pi, e{} and the functions {}",
                                        found, start + 1, listed(variables_), names_ ? names_->listed() : "",
                                        fmt::join(Expression::function_names(), ", ")));
    }
  }

  std::optional<TapeOp> variable(std::string_view name) const {
    if (name == "t" && variables_ != Variables::none) return TapeOp::time;
    if (name == "x" && variables_ == Variables::law) return TapeOp::elongation;
    if (name == "v" && variables_ == Variables::law) return TapeOp::rate;
    return {};
  }

  bool of_the_scene(std::string_view name) {
    if (!names_) return false;
    if (const std::optional<double> value = names_->parameter(name)) {
      push({TapeOp::constant, *value});
      return true;
    }
    std::shared_ptr<const Spline> table = names_->table(name);
    if (!table) return false;
    expect('(');
    sum();
    expect(')');
    TapeInstruction look_up{TapeOp::table, 0};
    look_up.table = table.get();
    parsed_.tables.push_back(std::move(table));
    emit(look_up);
    return true;
  }

  static std::string_view listed(Variables variables) {
    return variables == Variables::none ? "" : variables == Variables::time ? "t, " : "x, v, t, ";
  }

  // Appends an operation, or evaluates it at once where its arguments are constants. Each of those is one instruction.
  void emit(const TapeInstruction& instruction) {
    std::vector<TapeInstruction>& tape = parsed_.tape;
    const TapeOp op = instruction.op;
    const auto constant = [&](std::size_t from_end) { return tape[tape.size() - from_end].op == TapeOp::constant; };
    const int arguments = arity(op);
    depth_ -= static_cast<std::size_t>(arguments - 1);
    if (constant(1) && (arguments == 1 || constant(2))) {
      if (op == TapeOp::table && !instruction.table->covers(tape.back().value)) {
        throw ExpressionError(describe({instruction.table, tape.back().value}));
      }
      tape.push_back(instruction);
      const std::size_t first = tape.size() - 1 - static_cast<std::size_t>(arguments);
      const double value = run_tape<double>(std::span(tape).subspan(first), {}).f;
      if (!std::isfinite(value)) {
        throw ExpressionError(fmt::format("the constant part that ends at character {} is not finite", end_of_part()));
      }
      tape.resize(first);
      tape.push_back({TapeOp::constant, value});
    } else if (op == TapeOp::power && constant(1)) {
      const double exponent = tape.back().value;
      tape.pop_back();
      if (std::trunc(exponent) == exponent || !take_root(tape, exponent))
        tape.push_back({TapeOp::power_constant, exponent});
    } else if ((op == TapeOp::sqrt && take_root(tape, 0.5)) ||
               ((op == TapeOp::asin || op == TapeOp::acos) && take_arc(tape, op))) {
      return;
    } else {
      tape.push_back(instruction);
    }
  }

  void push(const TapeInstruction& instruction) {
    if (++depth_ > kTapeStack) too_deep();
    parsed_.tape.push_back(instruction);
  }

  bool accept(char c) { return accept_one_of({&c, 1}) != 0; }

  // The character that was taken; 0 where none of them comes next.
  char accept_one_of(std::string_view characters) {
    skip_blanks();
    if (position_ >= text_.size() || characters.find(text_[position_]) == characters.npos) return 0;
    const char found = text_[position_++];
    skip_blanks();
    return found;
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
    std::string found = "the end";
    if (position_ < text_.size()) {
      const char c = text_[position_];
      const bool printable = c >= ' ' && c <= '~';
      found = printable ? fmt::format("'{}'", c) : fmt::format("byte 0x{:02X}", static_cast<unsigned char>(c));
    }
    throw ExpressionError(fmt::format("{} at character {}, found {}", expected, position_ + 1, found));
  }

  [[noreturn]] void too_deep() const {
    throw ExpressionError(fmt::format("nested too deeply at character {}", position_ + 1));
  }

  std::string_view text_;
  Variables variables_;
  ExpressionNames* names_;
  std::size_t position_ = 0;
  int nesting_ = 0;
  std::size_t depth_ = 0;  // values on the stack
  ParsedTape parsed_;
};

}  // namespace

ParsedTape parse_expression(std::string_view text, Variables variables, ExpressionNames* names) {
  return Parser(text, variables, names).parse();
}

std::string describe(const Uncovered& found) {
  const double first = found.table->first(), last = found.table->last();
  const std::string least = fmt::format("{:.9g}", first), most = fmt::format("{:.9g}", last);
  std::string at = fmt::format("{:.9g}", found.argument);
  if (at == least || at == most) at = fmt::format("{:.17g}", found.argument);  // that it is beyond is to be seen
  return fmt::format("table '{}' has no value at {}: its points go from {} to {}", found.table->name(), at, least,
                     most);
}

std::vector<std::string_view> Expression::function_names() {
  std::vector<std::string_view> names;
  for (const auto& function : kFunctions) names.push_back(function.name);
  return names;
}

std::string_view Expression::why_no_name(std::string_view name) {
  const bool begins = !name.empty() && is_letter(name.front());
  if (!begins || !std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c); }))
    return "no name that expressions can hold (letters, digits and _, a letter first)";
  if (name == "t") return "the time in expressions";
  if (value_of<double>(kConstants, name)) return "a constant of expressions";
  if (value_of<TapeOp>(kFunctions, name)) return "a function of expressions";
  return {};
}

}  // namespace poinsot
