#include "integrators/stepping/passed_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace poinsot {

PassedLaws::PassedLaws(const LawSteps& steps, double end, double rtol, double atol, Tell tell)
    : steps_(steps), end_(end), rtol_(rtol), atol_(atol), tell_(std::move(tell)) {
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const SpringLaw& of = steps.law(k).of;
    watches_.push_back({LawTerms(of), of.F != nullptr});
    none_ = none_ && !watches_[k].on;
  }
}

double PassedLaws::reach() {
  const double to = steps_.to();
  double reach = to;
  for (std::size_t k = 0; k < watches_.size(); ++k) {
    if (!watches_[k].on) continue;
    const double tolerance = atol_ + rtol_ * steps_.law(k).from.rate.norm();
    for (const LawTerms::Part& part : watches_[k].terms.parts()) {
      const LawPath path = steps_.path(k, part.law);
      const LawEnds ends = path.ends();
      reach = std::min(reach, cut(k, path, ends, to, part.whole ? first_unseen : first_known, atol_));
      if (part.steep) reach = std::min(reach, cut(k, path, ends, to, first_steep, tolerance));
      if (part.whole) reach = std::min(reach, knot(k, path, ends, to));
    }
  }
  if (reach < to) leave_unknown(reach);
  return reach;
}

double PassedLaws::ahead(double to) {
  double reach = to;
  for (std::size_t k = 0; k < watches_.size(); ++k) {
    if (!watches_[k].on) continue;
    for (const LawTerms::Part& part : watches_[k].terms.parts()) {
      const LawPath path = steps_.ahead(k, part.law, to);
      const LawEnds ends = path.ends();
      reach = std::min(reach, cut(k, path, ends, to, part.whole ? first_unseen : first_known, atol_));
      if (part.steep) reach = std::min(reach, cut(k, path, ends, to, first_between, atol_));
    }
  }
  if (reach < to) leave_unknown(reach);
  return reach;
}

double PassedLaws::to_knot(double to) {
  double reach = to;
  for (std::size_t k = 0; k < watches_.size(); ++k) {
    if (!watches_[k].on || !steps_.law(k).of.F->asks_tables()) continue;
    const LawPath path = steps_.ahead(k, to);
    reach = std::min(reach, knot(k, path, path.ends(), to));
  }
  return reach;
}

double PassedLaws::nothing(std::size_t k, const LawEnds& ends, double h, double tolerance) {
  double& largest = watches_[k].largest;
  largest = std::max({largest, std::abs(ends.from.f), std::abs(ends.to.f)});
  return kUnseen * std::max(rtol_ * largest, tolerance * steps_.law(k).of.inertia / h);
}

double PassedLaws::knot(std::size_t k, const LawPath& path, const LawEnds& ends, double to) {
  const double h = to - steps_.from();
  if (!path.asks_tables() || h <= kResolved * end_) return to;
  const double s = first_table_knot(path, nothing(k, ends, h, atol_ + rtol_ * steps_.law(k).from.rate.norm()));
  return s < 1 ? steps_.from() + s * h : to;
}

double PassedLaws::cut(std::size_t k, const LawPath& path, const LawEnds& ends, double to, Look look,
                       double tolerance) {
  Watch& watch = watches_[k];
  const double from = steps_.from(), h = to - from, nothing_that_counts = nothing(k, ends, h, tolerance);
  if (h <= kResolved * end_) return to;
  const UnseenForce first = look(path, ends, nothing_that_counts);
  if (!(first.s < 1)) return to;
  watch.unknown = first.known ? 0 : watch.unknown + 1;
  return from + h * (first.known || first.s > kPart ? first.s : 0.5);
}

// Arithmetic on intervals may not say what a law comes to, or no more than bounds far from the truth.
void PassedLaws::leave_unknown(double t) {
  for (std::size_t k = 0; k < watches_.size(); ++k) {
    if (watches_[k].unknown < kMostUnknown || !std::exchange(watches_[k].on, false)) continue;
    tell_(
        fmt::format("from t = {:.6g} s on '{}' is not watched for what it does within less than a step, since it has "
                    "no close bounds there",
                    t, steps_.law(k).of.F->text()));
  }
}

}  // namespace poinsot
