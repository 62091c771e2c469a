// A function of time f(t), as scenes write it ("cos(pi*t + pi/2)"), with its exact first and second derivatives; and
// the law F(x, v, t) of a spring, with its partial derivatives.
//
// The text is parsed once into a tape (core/expression_tape.h), parts without variables already evaluated; the tape is
// evaluated on second-order Taylor numbers (f, ḟ, f̈), so the derivatives are exact to rounding and there is nothing to
// differentiate by hand and nothing to step. Evaluation allocates nothing and changes nothing.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/expression_range.h"
#include "core/expression_tape.h"

namespace poinsot {

// The text is not an expression: what was found, and at which character (counted from 1).
class ExpressionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ParsedTape;  // core/expression_parser.h

// The names that a scene adds to those of the language.
class ExpressionNames {
 public:
  virtual ~ExpressionNames() = default;
  virtual std::optional<double> parameter(std::string_view name) = 0;
  virtual std::shared_ptr<const Spline> table(std::string_view name) = 0;  // null where there is none
  // ", the parameters l, w and the tables road": what there is, for messages.
  virtual std::string listed() const = 0;
};

// F and its partial derivatives with x and v.
template <class T>
struct LawValue {
  T F{}, F_x{}, F_v{};
};

class Expression {
 public:
  Expression() = default;  // the constant 0
  explicit Expression(double constant) : value_(constant) {}
  Expression(const Expression&) = default;  // and no moves: what was moved from would be no function
  Expression& operator=(const Expression&) = default;

  // Grammar: + - * / ^ and unary signs, parentheses, numbers, `pi`, `e`, the variable `t`, the functions listed by
  // function_names(), and the names given. `^` binds to the right and tighter than a sign on its left: -t^2 = -(t^2).
  // A constant part that is not finite ("1/0") is an error. Throws ExpressionError.
  static Expression parse(std::string_view text, ExpressionNames* names = nullptr);
  // As parse, but `t` is an unknown name: for numbers written as constant expressions.
  static Expression parse_constant(std::string_view text, ExpressionNames* names = nullptr);
  // As parse, with the variables x, v and t.
  static Expression parse_law(std::string_view text, ExpressionNames* names = nullptr);
  static std::vector<std::string_view> function_names();
  // Computed by the program, no text of a scene: f with ḟ and f̈; or f alone, which is then differenced: to 1e-10 of
  // what f comes to where it changes over a second, less where it changes faster, and asked for up to 5e-3 s to either
  // side of t, before the start as well. As with all functions, ones that are not smooth cost error control its order.
  static Expression function(std::function<Jet2<double>(double t)> f);
  static Expression function(std::function<double(double t)> f);
  // What keeps a scene from calling something by it: "a function of expressions"; empty where nothing does. x and v are
  // free: they are variables in laws alone.
  static std::string_view why_no_name(std::string_view name);

  bool is_constant() const { return constant_; }
  bool is_function() const { return !constant_ && parsed_->function != nullptr; }  // of the program
  std::string text() const;

  template <class T>  // double, long double
  Jet2<T> at(T t) const {
    if (constant_) return {T(value_), T(0), T(0)};
    if (parsed_->function) return jet_of<T>(parsed_->function(static_cast<double>(t)));
    return run_tape<T>(parsed_->tape, {{t, T(1), T(0)}, {}, {}});
  }

  template <class T>  // double, long double
  Jet2<T> along(const Arguments<Jet2<T>>& at) const {
    return constant_ ? Jet2<T>{T(value_), T(0), T(0)} : run_tape<T>(parsed_->tape, at);
  }

  template <class T>  // double, long double
  LawValue<T> law(const Arguments<T>& at) const {
    if (constant_) return {T(value_), T(0), T(0)};
    const Jet2<T> t{at.t, T(0), T(0)}, x{at.x, T(1), T(0)}, v{at.v, T(0), T(0)};
    const Jet2<T> F = run_tape<T>(parsed_->tape, {t, x, v});
    if (!parsed_->with_rate) return {F.f, F.fd, T(0)};
    return {F.f, F.fd, run_tape<T>(parsed_->tape, {t, {at.x, T(0), T(0)}, {at.v, T(1), T(0)}}).fd};
  }
  // What a smooth background of polynomials may hide (core/expression_terms.h), each with the text of the whole: the
  // sum of all terms that are none, and where these are more than one, each of them. None where there is no background
  // and one term, or nothing else.
  std::vector<Expression> hidden_terms() const;
  bool depends_on_elongation() const { return !constant_ && parsed_->with_elongation; }
  bool depends_on_rate() const { return !constant_ && parsed_->with_rate; }
  bool depends_on_time() const { return !constant_ && parsed_->with_time; }

  // The values whose change of sign marks a kink or a jump of f: x of abs(x), sign(x) and step(x), x − y of min(x, y)
  // and max(x, y), in the order they are computed; and those of core/expression_kinks.h. Constant parts have none, and
  // neither have tables.
  int switch_count() const { return constant_ ? 0 : parsed_->switches; }
  void switches(const Arguments<double>& at, std::span<double> values) const {  // of size switch_count()
    if (!constant_) tape_switches(parsed_->tape, at, values);
  }
  void switches(double t, std::span<double> values) const { switches({t, 0, 0}, values); }

  // Whether it asks tables, and for which of their cubics: where these change f‴ jumps.
  bool asks_tables() const { return !constant_ && !parsed_->tables.empty(); }
  void cubics(const Arguments<double>& at, std::span<int> out) const {
    if (!constant_) tape_cubics(parsed_->tape, at, out);
  }

  // Whether f jumps at the switch k, or has a kink.
  bool switch_jumps(int k) const { return !constant_ && tape_switch_jumps(parsed_->tape, k); }
  // Bounds of the switch k over a stretch of time; see core/expression_range.h.
  Bounds switch_range(int k, const Arguments<Bounds>& at) const {
    return constant_ ? Bounds::unknown() : tape_switch_range(parsed_->tape, at, k);
  }
  // Bounds of f, ḟ and f̈ likewise. Of a function of the program nothing is known.
  Jet2<Bounds> range(const Arguments<Bounds>& at) const {
    if (constant_) return {{value_, value_}, {}, {}};
    if (parsed_->function) return {Bounds::unknown(), Bounds::unknown(), Bounds::unknown()};
    return tape_range(parsed_->tape, at);
  }
  // Of a law, by x, or by v, in the place of time.
  Jet2<Bounds> law_range(const Arguments<Bounds>& at, TapeOp by = TapeOp::elongation) const {
    return parsed_ ? tape_range(parsed_->tape, at, by) : range(at);
  }

  // Why f, or one of its first `derivatives` derivatives with time, is not finite at t, as a sentence's part:
  // "'1/(t - 1)' is not finite", "'road(t)': table 'road' has no value at 2.5: its points go from 0 to 2"; empty where
  // all are finite.
  std::string fault(double t, int derivatives) const;
  // Likewise of a law and its derivatives with x and v.
  std::string law_fault(const Arguments<double>& at) const;

 private:
  struct Parsed {
    std::string text;
    std::vector<TapeInstruction> tape;  // empty for a constant
    std::vector<std::shared_ptr<const Spline>> tables;
    std::function<Jet2<double>(double)> function;  // in the place of the tape
    int switches = 0;
    bool with_elongation = false, with_rate = false, with_time = false;
  };
  Expression(std::string_view text, ParsedTape parsed);
  static void look_through(Parsed& parsed);
  template <class T>
  static Jet2<T> jet_of(const Jet2<double>& f) {
    return {static_cast<T>(f.f), static_cast<T>(f.fd), static_cast<T>(f.fdd)};
  }
  std::string not_finite(const char* which, const Arguments<double>& at, const std::string& where) const;

  bool constant_ = true;
  double value_ = 0;                      // of a constant
  std::shared_ptr<const Parsed> parsed_;  // copies share it; none where there was no text
};

}  // namespace poinsot
