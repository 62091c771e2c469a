#include "integrators/start/beside.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "core/body_sizes.h"
#include "core/index.h"
#include "core/mechanisms.h"
#include "formulations/registry.h"
#include "integrators/settings.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {
namespace {

constexpr double kMove = 1e-3;        // of a body's size
constexpr double kShortWhile = 1e-3;  // s, where nothing moves yet
constexpr double kPulledBack = 0.3;   // of the move that has to be left after the projection
// Of a row that is free beside far more is left in sums with random coefficients, but for a chance of one in 1e10.
constexpr double kFollows = 1e-8;
constexpr int kSums = 3;

}  // namespace

Beside::Beside(const std::shared_ptr<const Model>& model, std::span<const BodyState> states, RowSpace& space,
               std::size_t suspects)
    : model_(model),
      states_(states.begin(), states.end()),
      space_(space),
      suspects_(suspects),
      sizes_(body_sizes(*model)) {
  auto unit = std::make_shared<Model>(*model_);
  for (std::size_t b = 0; b < sizes_.size(); ++b) {
    unit->bodies[b].mass = 1;
    unit->bodies[b].inertia = sizes_[b] * sizes_[b] * Matrix3::Identity();
  }
  unit_ = std::move(unit);
}

Trial Beside::begin(const std::vector<int>& without, int directions) const {
  Trial trial(without, intrinsic_formulation().make(unit_, without));
  PlaceBeside& start = trial.start;
  start.q.resize(index(trial.problem->nq())), start.v.resize(index(trial.problem->nv()));
  trial.problem->from_bodies(states_, start.q, start.v);
  trial.regular = trial.put_back(start);
  if (!trial.regular) return trial;
  trial.problem->set_position(0, start.q);
  trial.problem->set_velocity(start.v);
  trial.regular = trial.consistent->correct_velocity(0, start.v).ok();
  bool solved = trial.regular;
  for (int k = 0; k < directions; ++k) {
    trial.random.emplace_back();
    solved = solved && free_direction(trial, k + 1, trial.random.back());
  }
  return trial;
}

// By the factors that are those of the start; a move by kMove, none where nothing is free. False where a solution
// fails, and with it the factors.
bool Beside::free_direction(Trial& trial, int seed, std::vector<double>& move) const {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> normal;
  const std::size_t nv = trial.start.v.size();
  std::vector<double> x(nv + index(trial.problem->nc()), 0.0);
  for (std::size_t b = 0; b < sizes_.size(); ++b)
    for (std::size_t k = 0; k < 6; ++k) x[6 * b + k] = sizes_[b] * (k < 3 ? 1 : sizes_[b]) * normal(random);
  const double asked = extent(std::span<const double>(x).first(nv));
  if (!trial.consistent->solve(0, x).ok()) return false;
  x.resize(nv);
  // Each mechanism of the scene by itself: of thousands some would hardly move beside the one that moves most.
  const std::vector<int> mechanism = mechanisms(*model_);
  std::vector<double> length(mechanism_count(mechanism), 0.0);
  const auto of_body = [&](std::size_t b) { return std::span(x).subspan(6 * b, 6); };
  for (std::size_t b = 0; b < sizes_.size(); ++b)
    for (std::size_t k = 0; k < 6; ++k)
      length[index(mechanism[b])] =
          std::max(length[index(mechanism[b])], std::abs(of_body(b)[k]) / (k < 3 ? sizes_[b] : 1.0));
  bool moves = false;
  for (std::size_t b = 0; b < sizes_.size(); ++b) {
    const double most = length[index(mechanism[b])];
    const bool can = most > 1e-6 * asked;
    moves = moves || can;
    for (double& part : of_body(b)) part = can ? part * (kMove / most) : 0;
  }
  if (moves) move = std::move(x);
  return true;
}

double Beside::extent(std::span<const double> dq) const {
  double largest = 0;
  const std::size_t per_body = dq.size() / sizes_.size();
  for (std::size_t k = 0; k < dq.size(); ++k)
    largest = std::max(largest, std::abs(dq[k]) / (k % per_body < 3 ? sizes_[k / per_body] : 1.0));
  return largest;
}
double Beside::distance(std::span<const double> q, std::span<const double> from) const {
  std::vector<double> difference(q.size());
  std::ranges::transform(q, from, difference.begin(), std::minus());
  return extent(difference);
}

std::optional<Beside::Move> Beside::along(const PlaceBeside& start) const {
  const double speed = extent(start.v);
  const bool driven = std::ranges::any_of(model_->rows, [](const Row& row) { return !row.f.is_constant(); });
  if (speed == 0 && !driven) return {};
  const double t = speed > 0 ? std::min(kMove / speed, 1.0) : kShortWhile;
  Move move{t, start.v, speed > 0 && kMove / speed <= 1.0};
  for (double& x : move.dq) x *= t;
  return move;
}

std::optional<PlaceBeside> Beside::along_velocities(Trial& trial) {
  const std::optional<Move> move = along(trial.start);
  return move ? settle(trial, *move) : std::nullopt;
}

std::optional<PlaceBeside> Beside::at_random(Trial& trial, int direction) {
  const std::vector<double>& free = trial.random[index(direction)];
  return free.empty() ? std::nullopt : settle(trial, {0, free, true});
}

std::optional<PlaceBeside> Beside::anywhere(Trial& trial, int direction) {
  std::optional<Move> move = along(trial.start);
  const std::vector<double>& free = trial.random[index(direction)];
  if (!move || free.empty()) return {};
  for (std::size_t k = 0; k < free.size(); ++k) move->dq[k] += free[k];
  move->must_stay = true;  // that at random, however slow the other
  return settle(trial, *move);
}

// Moves, puts the mechanism back onto the problem's rows, and looks at all of them.
std::optional<PlaceBeside> Beside::settle(Trial& trial, const Move& move) {
  const PlaceBeside& start = trial.start;
  PlaceBeside place = start;
  place.t = move.t;
  trial.problem->retract(start.q, move.dq, place.q);
  const double moved = distance(place.q, start.q);
  if (!trial.put_back(place)) return {};
  if (move.must_stay && distance(place.q, start.q) < kPulledBack * moved) return {};
  look(trial, place);
  return place;
}

void Beside::stand(Problem& problem, const PlaceBeside& place) {
  std::vector<BodyState> states(states_.size());
  problem.set_position(place.t, place.q);
  problem.set_velocity(place.v);
  const std::vector<double> none(place.v.size(), 0.0);
  problem.to_bodies(none, states);
  space_.stand(place.t, states);
}

std::span<const double> Beside::measure_start(Trial& trial) {
  stand(*trial.problem, trial.start);
  off_at_start_.assign(space_.rows().size(), 0.0);
  space_.distances(off_at_start_);
  for (double& x : off_at_start_) x = std::abs(x);
  return off_at_start_;
}

// Whether the rows left out are combinations of the others where the trial was last put back: of sums of them with
// random coefficients all is, M-orthogonally, in the span of G_Kᵀ. No decomposition is needed for that.
bool Beside::all_follow(Trial& trial, double t) const {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> size(1, 2);
  const std::size_t nv = trial.start.v.size(), nc = index(trial.problem->nc());
  std::vector<double> b(nv + nc);
  for (int k = 0; k < kSums; ++k) {
    std::ranges::fill(b, 0.0);
    const auto scaled = [&](std::size_t j) { return j % 6 < 3 ? 1 : sizes_[j / 6]; };
    for (const int row : trial.without) {
      const auto column = std::ranges::lower_bound(space_.rows(), row) - space_.rows().begin();
      const double factor = (random() % 2 == 0 ? 1 : -1) * size(random);
      for (Eigen::SparseMatrix<double>::InnerIterator it(space_.columns(), column); it; ++it)
        b[index(it.row())] += factor * scaled(index(it.row())) * it.value();
    }
    if (!trial.consistent->solve(t, b).ok()) return false;
    for (std::size_t j = 0; j < nv; ++j)
      if (!(std::abs(scaled(j) * b[j]) < kFollows)) return false;
  }
  return true;
}

void Beside::look(Trial& trial, PlaceBeside& place) {
  stand(*trial.problem, place);
  // The factors at hand belong to a position as far away as the last correction was large: not nothing in long scenes,
  // where rounding of coordinates alone moves their middle by micrometres.
  const auto all_follow_here = [&] { return trial.consistent->factor(place.t).ok() && all_follow(trial, place.t); };
  if (trial.without.size() == suspects_ && (all_follow(trial, place.t) || all_follow_here())) {
    place.dependent = suspects_;
  } else {
    place.columns = space_.columns();
    place.dependent = dependent_columns(place.columns, kFreeBeside, suspects_).size();
  }
  std::vector<double> off(space_.rows().size());
  space_.distances(off);
  place.holds = true;
  for (std::size_t k = 0; k < off.size(); ++k) {
    const double allowed = kHolds * space_.size_of_row(k) + 3 * off_at_start_[k];
    if (std::abs(off[k]) <= allowed) continue;
    place.holds = false;
    if (std::abs(off[k]) <= place.off) continue;
    place.off = std::abs(off[k]);
    place.worst = space_.rows()[k];
  }
  if (place.holds && place.t > 0) look_at_rates(trial, place);
}

// Velocity rows have no place to be off: later on they hold where the velocities that the rows kept lead to satisfy
// them.
void Beside::look_at_rates(Trial& trial, PlaceBeside& place) {
  const std::size_t rows = space_.rows().size();
  bool any = false;
  for (std::size_t k = 0; k < rows && !any; ++k) any = space_.is_velocity_row(k);
  if (!any) return;
  std::vector<double> v = place.v, rate(rows), nu(rows);
  trial.problem->set_position(place.t, place.q);
  trial.problem->set_velocity(v);
  if (!trial.consistent->project_velocity(place.t, v).ok()) return;
  space_.rates(v, rate, nu);
  const double speed = extent(v);
  for (std::size_t k = 0; k < rows; ++k) {
    if (!space_.is_velocity_row(k)) continue;
    const double size = space_.size_of_row(k), norm = space_.norm_of_row(k), off = std::abs(rate[k]) / norm;
    if (off <= kContradicts * std::max({speed * size, std::abs(nu[k]) / norm, kHolds * size}) || off <= place.off)
      continue;
    place.holds = false;
    place.by_rate = true;
    place.off = off;
    place.worst = space_.rows()[k];
  }
}

bool Beside::leads_on(const PlaceBeside& start, const PlaceBeside& along, const std::vector<int>& without) {
  if (extent(start.v) == 0) return false;
  PlaceBeside place = along;
  if (!along.holds) {
    Trial trial(without, intrinsic_formulation().make(unit_, without));
    if (!trial.put_back(place)) return false;
    if (distance(place.q, start.q) < kPulledBack * kMove) return false;
    look(trial, place);
  }
  return place.holds && place.dependent == without.size();
}

}  // namespace poinsot
