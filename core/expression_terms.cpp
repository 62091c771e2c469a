#include "core/expression_terms.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace poinsot {
namespace {

using Sum = std::vector<Tape>;

constexpr std::size_t kMostTerms = 16;

void append(Tape& tape, std::span<const TapeInstruction> more) {
  tape.insert(tape.end(), more.begin(), more.end());
}

Tape applied(Tape x, const Tape& y, TapeOp op) {
  append(x, y);
  x.push_back({op, {0}});
  return x;
}

Sum multiplied(const Sum& x, const Sum& y) {
  if (x.size() * y.size() > kMostTerms) return {applied(sum_of(x), sum_of(y), TapeOp::multiply)};
  Sum product;
  for (const Tape& a : x)
    for (const Tape& b : y) product.push_back(applied(a, b, TapeOp::multiply));
  return product;
}

Sum combined(Sum x, const Sum& y, TapeOp op) {
  if (op == TapeOp::multiply) return multiplied(x, y);
  if (op == TapeOp::divide) {
    const Tape by = sum_of(y);
    for (Tape& term : x) term = applied(std::move(term), by, op);
    return x;
  }
  if (op != TapeOp::add && op != TapeOp::subtract) return {applied(sum_of(x), sum_of(y), op)};
  for (const Tape& term : y) {
    x.push_back(term);
    if (op == TapeOp::subtract) x.back().push_back({TapeOp::negate, {0}});
  }
  return x;
}

bool is_polynomial(const Tape& tape) {
  return std::ranges::all_of(tape, [](const TapeInstruction& i) {
    if (i.op == TapeOp::power_constant) return i.value > 0 && i.value == std::floor(i.value);
    return arity(i.op) == 0 || i.op == TapeOp::negate || i.op == TapeOp::add || i.op == TapeOp::subtract ||
           i.op == TapeOp::multiply;
  });
}

// Values on the stack at the most.
std::size_t stack_of(const Tape& tape) {
  int now = 0, most = 0;
  for (const TapeInstruction& i : tape) {
    now += 1 - arity(i.op);
    most = std::max(most, now);
  }
  return static_cast<std::size_t>(most);
}

}  // namespace

std::vector<Tape> tape_terms(std::span<const TapeInstruction> tape) {
  std::vector<Sum> stack;
  for (const TapeInstruction& i : tape) {
    if (arity(i.op) == 0) {
      stack.push_back(Sum{Tape{i}});
    } else if (arity(i.op) == 1) {
      Sum& x = stack.back();
      if (i.op != TapeOp::negate) x = Sum{sum_of(x)};
      for (Tape& term : x) term.push_back(i);
    } else {
      const Sum y = std::move(stack.back());
      stack.pop_back();
      stack.back() = combined(std::move(stack.back()), y, i.op);
    }
  }
  Sum terms = std::move(stack.back());
  std::erase_if(terms, is_polynomial);
  const auto too_deep = [](const Tape& term) { return stack_of(term) + 1 > kTapeStack; };
  if (terms.size() > kMostTerms || std::ranges::any_of(terms, too_deep)) return {Tape(tape.begin(), tape.end())};
  return terms;
}

Tape sum_of(std::span<const Tape> terms) {
  Tape sum = terms.front();
  for (const Tape& term : terms.subspan(1)) {
    append(sum, term);
    sum.push_back({TapeOp::add, {0}});
  }
  return sum;
}

}  // namespace poinsot
