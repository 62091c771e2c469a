#include "integrators/stepping/passed_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace poinsot {

PassedLaws::PassedLaws(const LawSteps& steps, double end, double rtol, double atol, Tell tell)
    : steps_(steps), end_(end), rtol_(rtol), atol_(atol), tell_(std::move(tell)), watches_(steps.size()) {
  for (std::size_t k = 0; k < steps.size(); ++k) {
    watches_[k].on = steps.law(k).of.F != nullptr;
    none_ = none_ && !watches_[k].on;
  }
}

double PassedLaws::reach() {
  double reach = steps_.to();
  for (std::size_t k = 0; k < watches_.size(); ++k)
    if (watches_[k].on) reach = std::min(reach, cut(k, steps_.path(k), steps_.to(), first_unseen));
  if (reach < steps_.to()) leave_unknown(reach);
  return reach;
}

double PassedLaws::ahead(double to) {
  double reach = to;
  for (std::size_t k = 0; k < watches_.size(); ++k)
    if (watches_[k].on) {
      const LawPath path = steps_.ahead(k, to);
      reach = std::min({reach, cut(k, path, to, first_unseen), cut(k, path, to, first_between)});
    }
  if (reach < to) leave_unknown(reach);
  return reach;
}

double PassedLaws::cut(std::size_t k, const LawPath& path, double to, Look look) {
  Watch& watch = watches_[k];
  const double from = steps_.from(), h = to - from, before = path.force(0), after = path.force(1);
  watch.largest = std::max({watch.largest, std::abs(before), std::abs(after)});
  if (h <= kResolved * end_) return to;
  const double nothing = kUnseen * std::max(rtol_ * watch.largest, atol_ * steps_.law(k).of.inertia / h);
  const UnseenForce first = look(path, {std::min(before, after), std::max(before, after)}, nothing);
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
