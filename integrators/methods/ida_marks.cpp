#include "integrators/methods/ida_marks.h"

#include <utility>

#include "integrators/stepping/rest_watch.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr double kMark = 0.01;   // rad, between two marks
constexpr double kTooFar = 0.1;  // rad: beyond, accelerations may be others

}  // namespace

IdaMarks::IdaMarks(Problem& problem, Consistent& consistent)
    : problem_(problem), consistent_(consistent), parts_(problem) {
  before_.a = last_.a.setZero(problem.nv());
}

void IdaMarks::begin(const State& at) {
  last_.a = at.z.head(problem_.nv()), last_.known = true;
}

Status IdaMarks::pass(State& end, double turned) {
  way_ += turned;
  if (way_ < kMark) return {};
  const double t = end.t;
  std::swap(before_, last_);
  last_.t = t, last_.a = end.z.head(problem_.nv()), last_.way = way_, last_.known = true;
  way_ = 0;
  if (!before_.known || last_.way > kTooFar) return {};
  for (std::size_t part = 0; part < parts_.count(); ++part) {
    if (!turned_round(parts_, part, before_.a, last_.a)) continue;
    if (parts_.rests(parts_.largest(part, span(last_.a)), largest(span(last_.a)))) continue;
    consistent_.stand(end);
    if (!consistent_.factor(t).ok()) return {};
    consistent_.look(consistent_.steepness(t));
    if (consistent_.amplification(part) > 1 && consistent_.lies_free(t, last_.a - before_.a, part))
      return other_branch_after_rest(t, before_.t);
  }
  return {};
}

void IdaMarks::forget() {
  before_.known = last_.known = false;
}

void IdaMarks::go_back_to(double t) {
  for (Mark* mark : {&before_, &last_}) mark->known = mark->known && mark->t <= t;
}

void IdaMarks::expect(ControlledPair& pair, double t) const {
  if (before_.known && before_.t < t) pair.expect(before_.t, span(before_.a), last_.way + way_, consistent_);
}

}  // namespace poinsot
