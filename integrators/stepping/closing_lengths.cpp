#include "integrators/stepping/closing_lengths.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kNoShorter = 1e-10;  // of the run
constexpr double kComesTo = 1e-8;     // of what it is where the run begins, or of 1
constexpr int kSearched = 4000;       // stretches looked at in one search

}  // namespace

ClosingLengths::ClosingLengths(const Model& model, double end) : model_(model), shortest_(kNoShorter * end) {
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const Row& row = model.rows[k];
    if (row.type != RowType::D || row.f.is_constant() || row.f.is_function() || !(row.f.at(0.0).f > 0)) continue;
    Function of{&row.f, static_cast<int>(k), kSearched};
    if (closes(of, 0, end) < HUGE_VAL || of.budget < 0) functions_.push_back(of);
  }
}

Status ClosingLengths::look(double to) {
  if (!(to > looked_to_)) return {};
  const double from = std::exchange(looked_to_, to);
  for (Function& of : functions_) {
    of.budget = kSearched;
    const double t = closes(of, from, to);
    if (!(t < HUGE_VAL)) continue;
    const char* what = model_.rows[index(of.row)].squared ? "length" : "squared distance";
    const double beyond = t + shortest_;
    if (of.f->at(beyond).f < 0) return {Failure::inconsistent_state, beyond, {}};  // who asks says so of any function
    return with_remedy(Failure::inconsistent_state, t,
                       fmt::format("at t = {:.9g} s {}: the {} '{}' comes to 0, where it does not say in which "
                                   "direction the points come together or part",
                                   t, describe_row(model_, of.row), what, of.f->text()),
                       "three CD constraints in its place, one for each axis, do; else end the run before, or change "
                       "the function");
  }
  return {};
}

double ClosingLengths::closes(Function& of, double from, double to) const {
  const Bounds f = of.f->range({{from, to}, Bounds::unknown(), Bounds::unknown()}).f;
  if (f.least > 0 || --of.budget < 0) return HUGE_VAL;
  const double middle = from + (to - from) / 2;
  if (to - from <= shortest_ || !(from < middle && middle < to)) {
    const Jet2<double> at = of.f->at(middle);
    const double least = at.f - std::abs(at.fd) * (to - from);
    return least <= kComesTo * std::fmax(1.0, of.f->at(0.0).f) ? middle : HUGE_VAL;
  }
  const double sooner = closes(of, from, middle);
  return sooner < HUGE_VAL ? sooner : closes(of, middle, to);
}

}  // namespace poinsot
