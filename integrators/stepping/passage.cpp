#include "integrators/stepping/passage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr double kTurn = 0.015;  // rad, τ: rounding 50 ε/τ³ and 576 (τ/R)⁸ are about as large, R being half a radian
// Of a sample other τ, where one of ±τ, ... ±4τ hits another position.
constexpr std::array kOtherTurns{0.8 * kTurn, 1.3 * kTurn};
// Of the end of a step, where what is singular goes by slowly while other bodies turn: nearer than that is rounding.
constexpr std::array kEndTurns{kTurn, 2.5 * kTurn, 5 * kTurn};
// Times the least steepness seen: from there on states beside are looked at, where a step has failed or none has.
constexpr double kSteep = 2, kSteeper = 10;
constexpr std::array kWeights{1.6, -0.8, 8.0 / 35, -1.0 / 35};
// Part of the steepness here at the most at ±τ, ...: a pole within τ/2 leaves two sevenths at 4τ.
constexpr std::array kFall{1.0, 1.0, 1.0, 0.4};
// Times that distance and steepness multiplied, which one position leaves the same, may differ: at ±kτ within τ/30 of
// another position rounding is seen in accelerations.
constexpr double kUneven = 30;
// Part of its size by which a velocity or an acceleration interpolated by two pairs less may differ, and that from one
// side from that from the other: else the motion is not smooth, as where a force is switched.
constexpr double kSmooth = 3e-3;
constexpr double kTooLittle = 1e-6;  // of the velocity, changed within τ

}  // namespace

// What puts a state moved along v back onto the constraints, and what it comes to.
struct Passage::Beside {
  Eigen::VectorXd c, v, a, lambda;
  double steepness = 0;
};

struct Passage::Work {
  explicit Work(const Problem& problem)
      : place(problem), nearest(problem), moved(problem.nv()), moved_by(2 * problem.nv()) {}

  using Part = Eigen::VectorXd Beside::*;
  Eigen::VectorXd mean(std::size_t k, Part x) const { return 0.5 * (beside[k][0].*x + beside[k][1].*x); }
  Eigen::VectorXd limit(Part x) const {
    Eigen::VectorXd all = kWeights[0] * mean(0, x);
    for (std::size_t k = 1; k < kWeights.size(); ++k) all += kWeights[k] * mean(k, x);
    return all;
  }
  // In every mechanism by itself, by norm(mechanism, x). Changes of up to `nothing` are none.
  template <class Norm>
  bool is_smooth(const Parts& parts, Part x, const Eigen::VectorXd& value, double nothing, Norm&& norm) {
    moved = (4 * mean(0, x) - mean(1, x)) / 3 - value;
    jump = beside[0][0].*x - beside[0][1].*x - 0.5 * (beside[1][0].*x - beside[1][1].*x);  // half of one
    const auto size = [&](std::size_t part) {
      return std::max(norm(part, span(value)), norm(part, span(std::as_const(beside)[0][0].*x)));
    };
    double all = 0;
    for (std::size_t part = 0; part < parts.count(); ++part) all = std::max(all, size(part));
    for (std::size_t part = 0; part < parts.count(); ++part) {
      const double of = size(part), most = std::max(kSmooth * of, nothing);
      if (parts.rests(of, all)) continue;
      if (!(norm(part, span(moved)) <= most && norm(part, span(jump)) <= most)) return false;
    }
    return true;
  }

  State place, nearest;                                       // nearest: at +τ
  std::array<std::array<Beside, 2>, kWeights.size()> beside;  // at ±τ, ±2τ, ...
  Eigen::VectorXd moved, jump, moved_by;
};

Passage::Passage(Problem& problem, Consistent& consistent)
    : problem_(problem),
      consistent_(consistent),
      parts_(problem),
      given_(problem),
      driven_(std::ranges::any_of(problem.model().rows, [](const Row& row) { return !row.f.is_constant(); })) {}
Passage::~Passage() = default;

std::span<const double> Passage::moved_by() const {
  return settled_ ? span(std::as_const(work_->moved_by)) : consistent_.moved_by();
}

Status Passage::stand_beside(const State& at, const Eigen::VectorXd& along, double s, Beside& beside) {
  State& place = work_->place;
  place.t = driven_ ? at.t + s : at.t;  // forces may be switched
  place.v = at.v;
  work_->moved = s * along;
  problem_.retract(span(at.q), span(work_->moved), span(place.q));
  beside.c.setZero(at.v.size());
  if (Status status = consistent_.project_position(place.t, span(place.q), span(beside.c)); !status.ok()) return status;
  consistent_.stand(place);
  if (Status status = consistent_.project_velocity(place.t, span(place.v)); !status.ok()) return status;
  if (Status status = consistent_.accelerations(place); !status.ok()) return status;
  beside.v = place.v;
  beside.a = place.z.head(at.v.size());
  beside.lambda = place.z.tail(place.z.size() - at.v.size());
  beside.steepness = consistent_.steepness(place.t);
  return {};
}

Status Passage::settle(State& at, bool factored, bool& settled) {
  settled = settled_ = at.multipliers_open = false;
  const double rate = problem_.fastest_turn();
  if (!(rate > 0)) return factored ? Status{} : consistent_.accelerations(at);
  const double here = factored ? consistent_.steepness(at.t) : HUGE_VAL;
  consistent_.look(here);
  if (!is_steep(here)) return {};
  settled = settled_ = limit(at, at.v, kTurn / rate, here);
  if (!settled) return consistent_.accelerations(at);
  give_multipliers(at);
  consistent_.stand(work_->nearest);
  if (Status status = consistent_.factor(work_->nearest.t); !status.ok()) return status;
  consistent_.stand(at);
  consistent_.tell_singular();
  return {};
}

bool Passage::is_steep(double here) {
  const bool first = least_ == HUGE_VAL;
  least_ = std::min(least_, here);
  return first || !(here < kSteep * least_);
}

bool Passage::settle_end(State& at, const Eigen::VectorXd& v_n) {
  problem_.set_velocity(span(v_n));
  const double rate = problem_.fastest_turn();
  consistent_.stand(at);
  const double here = rate > 0 && consistent_.factor(at.t).ok() ? consistent_.steepness(at.t) : HUGE_VAL;
  const bool settled = rate > 0 && is_steep(here) &&
                       std::ranges::any_of(kEndTurns, [&](double turn) { return limit(at, v_n, turn / rate, here); });
  if (settled) {
    least_ = std::min(least_, work_->beside.back()[0].steepness);
    give_multipliers(at);
  }
  consistent_.stand(at);
  return settled;
}

bool Passage::limit(State& at, const Eigen::VectorXd& along, double tau, double steepest) {
  if (!work_) work_ = std::make_unique<Work>(problem_);
  double least = HUGE_VAL, most = 0;  // distance in τ times steepness
  for (std::size_t k = 0; k < kWeights.size(); ++k) {
    for (std::size_t side = 0; side < 2; ++side) {
      Beside& beside = work_->beside[k][side];
      const double distance = static_cast<double>(k + 1), s = (side == 0 ? tau : -tau) * distance;
      if (!stand_beside(at, along, s, beside).ok() || !(beside.steepness < kFall[k] * steepest)) return false;
      least = std::min(least, distance * beside.steepness);
      most = std::max(most, distance * beside.steepness);
      if (most > kUneven * least) return false;
      if (k == 0 && side == 0) work_->nearest = work_->place;
    }
  }
  const Eigen::VectorXd c = work_->limit(&Beside::c), v = work_->limit(&Beside::v), a = work_->limit(&Beside::a);
  // Of a motion without accelerations they are nothing but rounding.
  const double unseen = kTooLittle * largest(span(v)) / tau;
  const auto norm = [&](std::size_t part, std::span<const double> x) { return parts_.largest(part, x); };
  if (!work_->is_smooth(parts_, &Beside::v, v, 0, norm) || !work_->is_smooth(parts_, &Beside::a, a, unseen, norm))
    return false;
  problem_.retract(span(at.q), {c.data(), static_cast<std::size_t>(c.size())}, span(work_->place.q));
  work_->moved_by << c, v - at.v;
  at.q = work_->place.q;
  at.v = v;
  at.z.head(v.size()) = a;
  return true;
}

bool Passage::limit_multipliers(State& at) {
  const Eigen::VectorXd lambda = work_->limit(&Beside::lambda);
  const auto norm = [&](std::size_t part, std::span<const double> x) { return parts_.largest_row(part, problem_, x); };
  if (!work_->is_smooth(parts_, &Beside::lambda, lambda, 0, norm)) return false;
  at.z.tail(lambda.size()) = lambda;
  return true;
}

Status Passage::complete(State& at) {
  settled_ = at.multipliers_open = false;
  given_ = at;
  const Status status = consistent_.complete(at);
  if (status.ok()) {
    const double here = consistent_.steepness(at.t);
    const bool steep = !(here < kSteeper * std::min(here, least_seen()));
    if (!steep) least_ = std::min(least_, here);
    if (!steep && !consistent_.made_of_rounding(at)) return {};
  }
  at = given_;
  bool settled = false;
  if (Status here = settle(at, consistent_.accelerations(at).ok(), settled); !here.ok()) return here;
  return settled ? Status{} : consistent_.complete(at);
}

void Passage::stand_on_rows(State& at) {
  if (complete(at).ok()) return;
  at = given_;
  consistent_.stand(at);
}

Status Passage::complete_sample(State& at) {
  Status status = complete(at);
  if (status.ok() && !settled_ && consistent_.made_of_rounding(at)) status = {Failure::singular_position, at.t, {}};
  if (status.ok() || status.failure == Failure::refused) return status;
  at = given_;
  const double here = consistent_.accelerations(at).ok() ? consistent_.steepness(at.t) : HUGE_VAL;
  const double rate = problem_.fastest_turn();
  const auto found = [&](double turn) { return limit(at, at.v, turn / rate, here); };
  if (!(rate > 0) || !std::ranges::any_of(kOtherTurns, found)) return status;
  give_multipliers(at);
  return {};
}

Status Passage::give(State& at, State& spare) {
  consistent_.stand(at);
  const double here = consistent_.factor(at.t).ok() ? consistent_.steepness(at.t) : HUGE_VAL;
  if (least_seen() == HUGE_VAL || here < kSteeper * least_seen()) return {};
  spare = at;
  const Status status = complete_sample(spare);
  if (status.ok()) std::swap(at, spare);
  consistent_.stand(at);
  return status.failure == Failure::singular_position ? status : Status{};
}

void Passage::give_multipliers(State& at) {
  consistent_.stand(at);
  at.multipliers_open = !multipliers(at).ok();
  if (at.multipliers_open) std::ranges::copy(std::as_const(work_->nearest).lambda(), at.lambda().begin());
}

// Those that fit M a + Gᵀλ = Q or, where the position leaves them open, the limit of those beside.
Status Passage::multipliers(State& at) {
  constexpr double kOpen = 1e8;  // steepness from which on rounding of a makes them
  if (!consistent_.factor(at.t).ok() || !(consistent_.steepness(at.t) < kOpen)) {
    if (limit_multipliers(at)) return {};
    return {Failure::singular_position, at.t, {}};
  }
  const auto nv = static_cast<std::size_t>(problem_.nv());
  work_->place.z.setZero();
  const std::span<double> z = span(work_->place.z);
  problem_.equations_of_motion(at.a(), {}, z.first(nv));
  for (double& x : z.first(nv)) x = -x;
  if (Status status = consistent_.solve(at.t, z); !status.ok()) return status;
  std::ranges::copy(z.subspan(nv), at.lambda().begin());
  return {};
}

}  // namespace poinsot
