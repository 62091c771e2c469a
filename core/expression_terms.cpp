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
  Sum product;
  for (const Tape& a : x)
    for (const Tape& b : y) product.push_back(applied(a, b, TapeOp::multiply));
  return product;
}

Sum added(Sum x, const Sum& y, TapeOp op) {
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
  struct Value {
    std::size_t begin;  // in the tape
    Sum sum;
  };
  std::vector<Value> stack;
  for (std::size_t k = 0; k < tape.size(); ++k) {
    const TapeInstruction& i = tape[k];
    if (arity(i.op) == 0) {
      stack.push_back({k, {Tape{i}}});
      continue;
    }
    const auto written = [&](std::size_t from, std::size_t end) {
      return Tape(tape.begin() + static_cast<std::ptrdiff_t>(from), tape.begin() + static_cast<std::ptrdiff_t>(end));
    };
    if (arity(i.op) == 1) {
      Value& x = stack.back();
      if (i.op != TapeOp::negate)
        x.sum = {written(x.begin, k + 1)};
      else
        for (Tape& term : x.sum) term.push_back(i);
      continue;
    }
    const Value y = std::move(stack.back());
    stack.pop_back();
    Value& x = stack.back();
    if (i.op == TapeOp::add || i.op == TapeOp::subtract) {
      x.sum = added(std::move(x.sum), y.sum, i.op);
    } else if (i.op == TapeOp::multiply && x.sum.size() * y.sum.size() <= kMostTerms) {
      x.sum = multiplied(x.sum, y.sum);
    } else if (i.op == TapeOp::divide) {
      const Tape by = written(y.begin, k);
      for (Tape& term : x.sum) term = applied(std::move(term), by, i.op);
    } else {
      x.sum = {written(x.begin, k + 1)};
    }
  }
  Sum terms = std::move(stack.back().sum);
  if (terms.size() == 1 || terms.size() > kMostTerms) return {};
  std::erase_if(terms, is_polynomial);
  const auto too_deep = [](const Tape& term) { return stack_of(term) + 1 > kTapeStack; };
  if (std::ranges::any_of(terms, too_deep)) return {};
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
