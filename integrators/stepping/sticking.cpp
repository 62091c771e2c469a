#include "integrators/stepping/sticking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/index.h"
#include "integrators/stepping/beside_jump.h"

namespace poinsot {
namespace {

constexpr Eigen::Index kMostVelocities = 3000;  // a law's rate is differentiated by each velocity

// A law by one of its arguments, and the k-th of its switches, which jumps.
class Along {
 public:
  Along(const SpringLaw& law, int k, const Arguments<double>& at, double Arguments<double>::*by)
      : law_(law), k_(k), there_(at), by_(by), values_(index(law.F->switch_count())) {
    from = at.*by;
    part = kPart * (1 + std::abs(from));
    here = value(from);
    slope = (value(from + part) - value(from - part)) / (2 * part);
    to = from - here / slope;
  }
  double from, part, here, slope;
  double to;  // where it jumps; not finite where it does not by this argument

  double value(double u) {
    there_.*by_ = u;
    law_.F->switches(there_, values_);
    return values_[index(k_)];
  }
  double force(double u) {
    there_.*by_ = u;
    return law_.F->law(there_).F;
  }
  double largest_force() { return std::max(std::abs(force(to - part)), std::abs(force(to + part))); }
  // How fast the place of the jump goes, where what it depends on besides goes on by so much a second.
  double rate(const Arguments<double>& rates) {
    const Arguments<double> now = there_;
    there_.t += part * rates.t, there_.x += part * rates.x, there_.v += part * rates.v;
    const double moved = -(value(from) - here) / part / slope;
    there_ = now;
    return moved;
  }

 private:
  static constexpr double kPart = 1e-6;

  const SpringLaw& law_;
  const int k_;
  Arguments<double> there_;
  double Arguments<double>::*by_;
  std::vector<double> values_;
};

// F on either side of a jump.
struct Trap {
  double at, before, after;
};
Trap trap_at(Along& along, double aside) {
  return {std::abs(along.to) < aside ? 0 : along.to, along.force(along.to - aside), along.force(along.to + aside)};
}
bool leads_back(double before, double after) {
  constexpr double kLeast = 1e-6;  // of the accelerations on both sides
  const double least = kLeast * (std::abs(before) + std::abs(after));
  return before > least && after < -least;
}
constexpr double kBesideJump = 1e-3;  // of how far away it may be
constexpr double kReaches = 4;        // an inertia is smaller about some axes, and other forces act besides

// Of a jump by v, that the motion cannot leave.
std::optional<Trap> trap_of(BesideJump& beside, const SpringLaw& law, int k, double instant) {
  Along along(law, k, beside.here(), &Arguments<double>::v);
  const double reach = kReaches * along.largest_force() / law.inertia * instant, aside = kBesideJump * reach;
  if (!(std::abs(along.to - along.from) <= reach)) return {};
  const double moves = along.rate({1, along.from, 0});  // v = c t, x + c v
  const auto change = [&](double v) { return beside.change_beside_v(v - along.from) - moves; };
  // At the jump itself: beside it damping leads back, too.
  const double before = 2 * change(along.to - aside) - change(along.to - 2 * aside);
  const double after = 2 * change(along.to + aside) - change(along.to + 2 * aside);
  if (!leads_back(before, after)) return {};
  return trap_at(along, aside);
}

constexpr double kVibration = 10;  // instants
constexpr double kOfPlace = 1e-10;

// Of a jump by x, about which the motion vibrates.
std::optional<Trap> rest_of(BesideJump& beside, const SpringLaw& law, int k, double instant) {
  if (std::isfinite(Along(law, k, beside.here(), &Arguments<double>::v).to)) return {};
  Along along(law, k, beside.here(), &Arguments<double>::x);
  const double span = kVibration * instant, reach = 0.5 * kReaches * along.largest_force() / law.inertia * span * span;
  const double aside = std::max(kBesideJump * reach, kOfPlace * (1 + std::abs(along.to))), off = along.from - along.to;
  if (!(std::abs(off) <= reach)) return {};
  const double before = beside.change_beside_x(-aside - off), after = beside.change_beside_x(aside - off);
  if (!leads_back(before, after)) return {};
  const double v = beside.here().v - along.rate({1, 0, 0});
  const double passes_at = std::sqrt(v * v + 2 * std::abs(off * (off > 0 ? after : before)));
  if (!(2 * passes_at * (1 / before - 1 / after) <= span)) return {};
  return trap_at(along, aside);
}

// Whether either side leads back to where a spring that pulls there has no length.
bool rests_without_length(BesideJump& beside, const SpringLaw& spring, double F, double instant) {
  constexpr double kLeast = 1e-6;  // of the acceleration that F is good for
  const double length = beside.here().x + spring.zero, span = kVibration * instant;
  const double reach = 0.5 * kReaches * F / spring.inertia * span * span;
  const double aside = std::max(kBesideJump * reach, kOfPlace);
  if (!(length <= reach)) return false;
  const double back = -beside.change_beside_x(-aside - length), back_again = -beside.change_beside_x(aside - length);
  if (!(std::min(back, back_again) > kLeast * F / spring.inertia)) return false;
  const double v = beside.here().v, passes_at = std::sqrt(v * v + 2 * length * std::max(back, back_again));
  return 2 * passes_at * (1 / back + 1 / back_again) <= span;
}

// What `find` finds of the jumps of laws, the first of it in words.
template <class Find>
std::string law_that(Find&& find, const char* leads, const Problem& problem, const LinearChoice& choice,
                     const State& state, double instant) {
  if (state.v.size() > kMostVelocities) return {};
  const Model& model = problem.model();
  for (const SpringLaw& law : spring_laws(model)) {
    for (int k = 0; k < law.F->switch_count(); ++k) {
      if (!law.F->switch_jumps(k)) continue;
      BesideJump beside(problem, choice, state, law);
      if (!beside.moves()) continue;
      const std::optional<Trap> trap = find(beside, law, k, instant);
      if (!trap) continue;
      return fmt::format("the law of force '{}' jumps from {:.3g} to {:.3g} {} where ", law.name(model), trap->before,
                         trap->after, law.unit()) +
             fmt::format(fmt::runtime(leads), trap->at);
    }
  }
  return {};
}

// The first spring that rests without length, in words.
std::string spring_without_length(const Problem& problem, const LinearChoice& choice, const State& state,
                                  double instant) {
  if (state.v.size() > kMostVelocities) return {};
  for (const SpringLaw& spring : springs_that_may_turn_round(problem.model())) {
    const double F = spring.at_no_length(state.t);
    if (!(F > 0) || !std::isfinite(F)) continue;
    BesideJump beside(problem, choice, state, spring);
    if (!beside.moves() || !rests_without_length(beside, spring, F, instant)) continue;
    return fmt::format(
        "the force '{}', {:.3g} N, turns round where the spring has no length, and leads back there from either side: "
        "the motion goes to and fro about it, the faster the nearer; a law that is steep instead, as this one times "
        "min((x + length)/c, 1) with a small c, does not stop it",
        spring.name(problem.model()), F);
  }
  return {};
}

Status to_and_fro(double t) {
  return {Failure::step_size_too_small, t,
          fmt::format("at t = {:.9g} s steps go to and fro about a jump of a force, and do not get on", t)};
}

}  // namespace

StickingWatch::StickingWatch(const Model& model, const LinearChoice& choice, double instant)
    : choice_(choice), instant_(instant), jumps_(model), before_(jumps_.sides()), sides_(before_) {}

Status StickingWatch::look(const Problem& problem, const State& at) {
  constexpr double kBetween = 0.05;  // of a crossing, that a step without one takes back
  constexpr double kToAndFro = 30;
  constexpr double kShort = 0.1;
  constexpr int kSeldomer = 4;
  if (jumps_.none()) return {};
  std::swap(before_, sides_);
  jumps_.look(problem, at, sides_);
  crossings_ = jumps_.crossed(before_, sides_) ? crossings_ + 1 : std::max(0.0, crossings_ - kBetween);
  short_ = at.t - std::exchange(t_, at.t) < kShort * instant_ ? short_ + 1 : 0;
  if (crossings_ < kToAndFro && short_ < many_) return {};
  if (short_ >= many_) many_ *= kSeldomer;
  crossings_ = 0;
  return sticking_law(problem, choice_, at, instant_).empty() ? Status{} : to_and_fro(at.t);
}

Status StickingWatch::look_for_rest(const Problem& problem, const State& at) const {
  return resting_law(problem, choice_, at, instant_).empty() ? Status{} : to_and_fro(at.t);
}

std::string sticking_law(const Problem& problem, const LinearChoice& choice, const State& state, double instant) {
  return law_that(trap_of,
                  "v passes {:.3g}, and either side leads back there: no motion follows such a law, as of a body that "
                  "sticks; one that is steep instead, as min(max(v/c, -1), 1) with a small c in the place of sign(v), "
                  "does not stop it",
                  problem, choice, state, instant);
}

std::string resting_law(const Problem& problem, const LinearChoice& choice, const State& state, double instant) {
  std::string why =
      law_that(rest_of,
               "x passes {:.3g}, and either side leads back there: the motion goes to and fro about it, the faster the "
               "nearer; a law that is steep instead, as min(max(x/c, -1), 1) with a small c in the place of sign(x), "
               "does not stop it",
               problem, choice, state, instant);
  return why.empty() ? spring_without_length(problem, choice, state, instant) : why;
}

}  // namespace poinsot
