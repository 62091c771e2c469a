#include "integrators/stepping/gap_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "core/all_but.h"
#include "core/index.h"
#include "core/joined.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

constexpr std::size_t kMostBodies = 1000;
// From one look to the next, where constraints are as steep as at the least: rad, and a part of the run. And how much
// sooner at the most.
constexpr double kTurnedMost = 0.5, kLooks = 20, kMuchSooner = 0.06;
constexpr double kSteepTimes = 8;         // times the least: a singular position may be near
constexpr double kOtherVelocities = 0.3;  // of their size, as far apart on two branches
constexpr double kVerySteep = 50;         // times the least: a singular position was as good as met
constexpr double kMayBeNear = 0.5;        // of the way from look to look
constexpr int kMostUnjudged = 3;

// Whether a mechanism of the scene may come to a singular position at all.
bool may_be_singular(const Model& model) {
  const int ground = static_cast<int>(model.bodies.size());
  Joined joined(model.bodies.size() + 1);
  std::set<std::pair<int, int>> pairs;
  for (const Group& group : model.groups) {
    const int i = group.i == kGround ? ground : group.i, j = group.j == kGround ? ground : group.j;
    const std::pair<int, int> pair = std::minmax(i, j);
    if (group.kind == GroupKind::joint) {
      if (!joined.join(i, j)) return true;
      pairs.insert(pair);
    } else if (group.kind == GroupKind::constraint || group.type != "angle" || !pairs.contains(pair)) {
      return true;
    }
  }
  return false;
}

// Twice the kinetic energy of the difference of velocities, of the bodies of one mechanism.
double twice_kinetic(const Model& model, const Parts& parts, std::size_t part, std::span<const BodyState> x,
                     std::span<const BodyState> y) {
  double sum = 0;
  for (std::size_t b = 0; b < x.size(); ++b) {
    if (parts.of_body(static_cast<int>(b)) != part) continue;
    const Body& body = model.bodies[b];
    const Vector3 v = x[b].rd - y[b].rd, w = x[b].w - y[b].w;
    sum += body.mass * v.squaredNorm() + w.dot(body.inertia * w);
  }
  return sum;
}

std::vector<BodyState> bodies_at(Problem& problem, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  std::vector<BodyState> states(index(problem.bodies()));
  problem.set_position(t, span(q));
  problem.set_velocity(span(v));
  problem.to_bodies(std::vector<double>(index(problem.nv()), 0.0), states);
  return states;
}

// The same motion from `state` on, to t; consistent to begin with. Given up where that takes unusually long.
Status do_again(Problem& problem, const Settings& settings, State& state, double t) {
  constexpr std::int64_t kMostRejected = 300;
  constexpr double kRtol = 1e-7;
  Settings again = settings;
  again.integrator = "dop853";
  again.rtol = kRtol;
  again.atol.reset();
  again.end = again.every = t;
  Consistent consistent(problem, settings.linear());
  consistent.stand(state);
  if (Status status = consistent.complete(state); !status.ok()) return status;
  LinearSystems systems(settings.linear());
  Statistics statistics;
  const Observer observe;
  const Tell tell = [](const std::string&) {};
  Run run{problem, systems, again, state, observe, statistics, tell};
  run.most_rejected = kMostRejected;
  return integrators().require(again.integrator).make()->run(run);
}

}  // namespace

GapWatch::GapWatch(const Problem& problem, const Settings& settings, Tell tell)
    : settings_(settings),
      tell_(std::move(tell)),
      parts_(problem),
      looks_(problem.model().bodies.size() <= kMostBodies && may_be_singular(problem.model())),
      length_(longest_arm(problem.model())),
      of_run_(std::min(1.0, kLooks * settings.step / settings.end)),
      least_(HUGE_VAL) {}

void GapWatch::begin(const Problem& problem, const State& at) {
  if (!looks_) return;
  q_ = q_steepest_ = at.q;
  v_ = at.v;
  prepare(problem);
  if (!looks_) return;
  (void)look(problem, at);
  looks_ = least_ < HUGE_VAL;
}

void GapWatch::prepare(const Problem& problem) {
  own_ = problem.clone_without(all_but(problem.model().rows.size(), problem.model_rows()));
  revision_ = problem.revision();
  consistent_.emplace(*own_, settings_.linear());
  side_.emplace(*own_);
  looks_ = consistent_->prepare().ok();
}

bool GapWatch::due(double turned, const Eigen::VectorXd& v, double h) {
  if (!looks_ || unjudged_ == kMostUnjudged) return false;
  double speed = 0;
  for (Eigen::Index b = 0; b < v.size(); b += parts_.per_body()) speed = std::max(speed, v.segment<3>(b).squaredNorm());
  if (length_ > 0) turned = std::max(turned, h * std::sqrt(speed) / length_);
  way_ += std::max(turned / kTurnedMost, of_run_);
  return way_ >= due_;
}

double GapWatch::steepness(const Problem& problem, const State& at) {
  if (revision_ != problem.revision()) prepare(problem);
  own_->set_position(at.t, span(at.q));
  own_->set_velocity(span(at.v));
  return consistent_->factor(at.t).ok() ? consistent_->steepness(at.t) : HUGE_VAL;
}

Status GapWatch::look(const Problem& problem, const State& at) {
  way_ = 0;
  const double here = steepness(problem, at);
  least_ = std::min(least_, here);
  const double before = std::exchange(due_, std::clamp(least_ / here, kMuchSooner, 1.0));
  if (side_->reversed(*own_, std::min(before, due_) < kMayBeNear)) crossed_ = known_;
  if (here >= steepest_) {
    steepest_ = here;
    t_steepest_ = at.t;
    q_steepest_ = at.q;
  }
  if (!(here < kSteepTimes * least_)) {
    steep_ = known_;
    return {};
  }
  if (std::exchange(steep_, false) || crossed_) {
    const std::optional<Apart> apart = judge(problem, at);
    if (!apart && crossed_) tell_unjudged(problem, at);
    if (apart && are_others(*apart)) {
      if (suspected_) return gone_over(problem, at, *apart);
      suspected_ = steep_ = true;
      return {};
    }
  }
  suspected_ = crossed_ = false;
  steepest_ = 0;
  t_ = at.t;
  q_ = at.q;
  v_ = at.v;
  known_ = true;
  return {};
}

// Where it was only steep, coarse steps lead single bodies elsewhere that stay on their branch: what counts is all the
// mechanism. Else one body is enough.
bool GapWatch::are_others(const Apart& velocities) const {
  const bool met = crossed_ || steepest_ > kVerySteep * least_;
  return (met ? velocities.of_a_body : velocities.of_all) > kOtherVelocities;
}

Status GapWatch::end(const Problem& problem, const State& at) {
  if (!suspected_) return {};
  const std::optional<Apart> apart = judge(problem, at);
  return apart && are_others(*apart) ? gone_over(problem, at, *apart) : Status{};
}

// Nothing where error control finds no way; 0 where nothing moves.
std::optional<GapWatch::Apart> GapWatch::judge(const Problem& problem, const State& at) {
  constexpr double kMoves = 1e-4;  // arms of the mechanism, meanwhile
  const std::unique_ptr<Problem> own =
      problem.clone_without(all_but(problem.model().rows.size(), problem.model_rows()));
  State again(*own);
  again.t = t_;
  again.q = q_;
  again.v = v_;
  const std::vector<BodyState> began = bodies_at(*own, t_, q_, v_), now = bodies_at(*own, at.t, at.q, at.v);
  if (!do_again(*own, settings_, again, at.t).ok()) {
    ++unjudged_;
    return {};
  }
  const std::vector<BodyState> right = bodies_at(*own, again.t, again.q, again.v), rest(now.size());
  Apart apart;
  for (std::size_t part = 0; part < parts_.count(); ++part) {
    const auto largest_of = [&](const std::vector<BodyState>& x, const std::vector<BodyState>& y) {
      double largest = 0;
      for (std::size_t b = 0; b < x.size(); ++b)
        if (parts_.of_body(static_cast<int>(b)) == part)
          largest = std::max({largest, (x[b].rd - y[b].rd).norm(), length_ * (x[b].w - y[b].w).norm()});
      return largest;
    };
    const double fastest = std::max({largest_of(began, rest), largest_of(now, rest), largest_of(right, rest)});
    if (!(fastest * (at.t - t_) > kMoves * length_)) continue;
    apart.of_a_body = std::max(apart.of_a_body, largest_of(now, right) / fastest);
    const auto square = [&](const std::vector<BodyState>& x, const std::vector<BodyState>& y) {
      return twice_kinetic(problem.model(), parts_, part, x, y);
    };
    const double size = std::max({square(began, rest), square(now, rest), square(right, rest)});
    if (size > 0) apart.of_all = std::max(apart.of_all, std::sqrt(square(now, right) / size));
  }
  return apart;
}

// "by" the row that is hardly independent at the steepest place.
std::string GapWatch::place(const Problem& problem) {
  const int rows = static_cast<int>(problem.model_rows().size());
  const int row = most_dependent_row(*own_, rows, t_steepest_, span(q_steepest_)).row;
  return row < 0 ? "" : fmt::format(" by {}", problem.describe_unknown(problem.nv() + row));
}

void GapWatch::tell_unjudged(const Problem& problem, const State& at) {
  tell_(fmt::format(
      "between t = {:.6g} s and t = {:.6g} s, beside a singular position of the constraints{}, the steps go straight "
      "on to where another branch of positions begins or crosses theirs, and error control finds no way there: that "
      "the motion does so is not certain",
      t_, at.t, place(problem)));
}

Status GapWatch::gone_over(const Problem& problem, const State& at, const Apart& apart) {
  const std::string where = place(problem);
  return with_settings(
      {Failure::singular_position, at.t,
       fmt::format(
           "between t = {:.9g} s and t = {:.9g} s, beside a singular position of the constraints{}, the steps "
           "have gone over to another branch than the motion belongs to, or are too long to follow it: velocities "
           "are off by {:.2g} of their size from those of error control",
           t_, at.t, where, std::max(apart.of_all, apart.of_a_body))},
      "try another step or dop853");
}

}  // namespace poinsot
