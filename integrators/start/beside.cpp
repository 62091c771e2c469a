#include "integrators/start/beside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "core/body_sizes.h"
#include "core/index.h"
#include "core/mechanisms.h"
#include "formulations/registry.h"
#include "integrators/settings.h"

namespace poinsot {
namespace {

constexpr double kMove = 1e-3;        // of a body's size
constexpr double kShortWhile = 1e-3;  // s, where nothing moves yet
constexpr double kNoSpeed = 1e-9;     // of a body's size in a second: speeds below are rounding of velocities
constexpr double kPulledBack = 0.3;   // of the move that has to be left after the projection

}  // namespace

Beside::Beside(const std::shared_ptr<const Model>& model, std::span<const BodyState> states, RowSpace& space,
               std::size_t suspects)
    : model_(model),
      space_(space),
      suspects_(suspects),
      sizes_(body_sizes(*model)),
      q_(index(space.problem().nq())),
      v_(index(space.problem().nv())) {
  space.problem().from_bodies(states, q_, v_);
}

std::unique_ptr<OntoRows> Beside::by_motion(const std::vector<int>& without) const {
  auto unit = std::make_shared<Model>(*model_);
  for (std::size_t b = 0; b < sizes_.size(); ++b) {
    unit->bodies[b].mass = 1;
    unit->bodies[b].inertia = sizes_[b] * sizes_[b] * Matrix3::Identity();
  }
  return onto_rows_by_motion(unit, space_, without, sizes_);
}

Trial Beside::begin(const std::vector<int>& without, int directions) const {
  return begin(by_motion(without), directions);
}

Trial Beside::begin(std::shared_ptr<FrontQr> decomposition) const {
  return begin(onto_rows_by_decomposition(std::move(decomposition), space_, sizes_), 1);
}

Trial Beside::begin(std::unique_ptr<OntoRows> onto, int directions) const {
  Trial trial{std::move(onto), {}, {}, false};
  PlaceBeside& start = trial.start;
  start.q = q_, start.v = v_;
  trial.regular = trial.onto->position(0, start.q) && trial.onto->velocity(0, start.q, start.v);
  bool solved = trial.regular;
  for (int k = 0; k < directions; ++k) {
    trial.random.emplace_back();
    solved = solved && free_direction(trial, k + 1, trial.random.back());
  }
  return trial;
}

// A move by kMove, none where nothing is free. False where it cannot be found.
bool Beside::free_direction(Trial& trial, int seed, std::vector<double>& move) const {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> normal;
  Eigen::MatrixXd moves(1, static_cast<Eigen::Index>(trial.start.v.size()));
  std::span<double> x(moves.data(), trial.start.v.size());
  for (std::size_t b = 0; b < sizes_.size(); ++b)
    for (std::size_t k = 0; k < 6; ++k) x[6 * b + k] = (k < 3 ? sizes_[b] : 1) * normal(random);
  const double asked = extent(x);
  if (!trial.onto->leave_free(0, moves)) return false;
  // Each mechanism of the scene by itself: of thousands some would hardly move beside the one that moves most.
  const std::vector<int> mechanism = mechanisms(*model_);
  std::vector<double> length(mechanism_count(mechanism), 0.0);
  const auto of_body = [&](std::size_t b) { return x.subspan(6 * b, 6); };
  for (std::size_t b = 0; b < sizes_.size(); ++b)
    for (std::size_t k = 0; k < 6; ++k)
      length[index(mechanism[b])] =
          std::max(length[index(mechanism[b])], std::abs(of_body(b)[k]) / (k < 3 ? sizes_[b] : 1.0));
  bool any = false;
  for (std::size_t b = 0; b < sizes_.size(); ++b) {
    const double most = length[index(mechanism[b])];
    const bool can = most > 1e-6 * asked;
    any = any || can;
    for (double& part : of_body(b)) part = can ? part * (kMove / most) : 0;
  }
  if (any) move.assign(x.begin(), x.end());
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
  double speed = extent(start.v);
  const bool driven = std::ranges::any_of(model_->rows, [](const Row& row) { return !row.f.is_constant(); });
  if (driven && speed < kNoSpeed) speed = 0;
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

std::optional<PlaceBeside> Beside::anywhere(Trial& trial) {
  std::optional<Move> move = along(trial.start);
  const std::vector<double>& free = trial.random.front();
  if (free.empty()) return move ? settle(trial, *move) : std::nullopt;
  if (!move) return settle(trial, {0, free, true});
  for (std::size_t k = 0; k < free.size(); ++k) move->dq[k] += free[k];
  move->must_stay = true;  // that at random, however slow the other
  return settle(trial, *move);
}

// Moves and puts the mechanism back onto the rows kept.
std::optional<PlaceBeside> Beside::settled(Trial& trial, const Move& move) {
  const PlaceBeside& start = trial.start;
  PlaceBeside place = start;
  place.t = move.t;
  space_.problem().retract(start.q, move.dq, place.q);
  const double moved = distance(place.q, start.q);
  if (!trial.onto->position(place.t, place.q)) return {};
  if (move.must_stay && distance(place.q, start.q) < kPulledBack * moved) return {};
  return place;
}

std::optional<PlaceBeside> Beside::settle(Trial& trial, const Move& move) {
  std::optional<PlaceBeside> place = settled(trial, move);
  if (place) look(trial, *place);
  return place;
}

// Rows that the kept ones imply are off by rounding however far it is; what grows otherwise, as where the kept ones
// have come onto another branch, says nothing.
std::optional<PlaceBeside> Beside::where_they_part(Trial& trial, int direction) {
  constexpr std::size_t kWays = 4;
  constexpr double kLonger = 4, kLeastPower = 1.5, kMostPower = 8;
  constexpr double kSeen = 1e-14, kMuch = 1000;  // kSeen: of bodies' sizes
  const std::vector<double>& free = trial.random[index(direction)];
  if (free.empty()) return {};
  std::optional<PlaceBeside> place;
  std::array<double, kWays> off{};
  double seen = kSeen;
  for (std::size_t k = 0; k < off_at_start_.size(); ++k)
    seen = std::max(seen, 3 * off_at_start_[k] / space_.size_of_row(k));
  Move move{0, free, true};
  for (double& most : off) {
    if (&most != &off.front())
      for (double& x : move.dq) x *= kLonger;
    if (place = settled(trial, move); !place) return {};
    space_.stand_at(place->t, place->q);
    std::vector<double> by(space_.rows().size());
    space_.distances(by);
    for (std::size_t k = 0; k < by.size(); ++k) most = std::max(most, std::abs(by[k]) / space_.size_of_row(k));
  }
  if (!(off[kWays - 2] > 10 * seen && off[kWays - 1] > kMuch * seen)) return {};
  for (std::size_t k = 0; k + 1 < kWays; ++k) {
    const double times = off[k + 1] / std::max(seen, off[k]);
    const bool known = off[k] > seen;
    if (times > std::pow(kLonger, kMostPower) || (known && times < std::pow(kLonger, kLeastPower))) return {};
  }
  place->columns = space_.columns();
  return place;
}

std::span<const double> Beside::measure_start(Trial& trial) {
  space_.stand_at(0, trial.start.q);
  off_at_start_.assign(space_.rows().size(), 0.0);
  space_.distances(off_at_start_);
  for (double& x : off_at_start_) x = std::abs(x);
  return off_at_start_;
}

void Beside::look(Trial& trial, PlaceBeside& place) {
  space_.stand_at(place.t, place.q);
  if (trial.onto->without().size() == suspects_ && trial.onto->all_follow(place.t)) {
    place.dependent = suspects_;
  } else {
    place.columns = space_.columns();
    place.dependent = dependent_columns(place.columns, kFreeBeside, suspects_).size();
  }
  std::vector<double> off(space_.rows().size());
  space_.distances(off);
  const std::vector<BodyState> states = bodies_at(place);
  place.holds = true;
  for (std::size_t k = 0; k < off.size(); ++k) {
    const double allowed =
        kHolds * space_.own_size_of_row(k) + rounding_of(space_.rows()[k], states) + 3 * off_at_start_[k];
    if (std::abs(off[k]) <= allowed) continue;
    place.holds = false;
    if (std::abs(off[k]) <= place.off) continue;
    place.off = std::abs(off[k]);
    place.worst = space_.rows()[k];
  }
  if (place.holds && place.t > 0) look_at_rates(trial, place);
}

// Of places that far from the origin, m.
double Beside::rounding_of(int row, std::span<const BodyState> states) const {
  constexpr double kRounding = 2e-15;
  const Row& of = model_->rows[index(row)];
  double far = 0;
  for (const int body : {of.i, of.j})
    if (body != kGround) far = std::max(far, states[index(body)].r.norm());
  return kRounding * far;
}

// Velocity rows have no place to be off: later on they hold where the velocities that the rows kept lead to satisfy
// them.
void Beside::look_at_rates(Trial& trial, PlaceBeside& place) {
  const std::size_t rows = space_.rows().size();
  bool any = false;
  for (std::size_t k = 0; k < rows && !any; ++k) any = space_.is_velocity_row(k);
  if (!any) return;
  std::vector<double> v = place.v, rate(rows), nu(rows);
  if (!trial.onto->velocity(place.t, place.q, v)) return;
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
    Trial trial{by_motion(without), {}, {}, false};
    if (!trial.onto->position(place.t, place.q)) return false;
    if (distance(place.q, start.q) < kPulledBack * kMove) return false;
    look(trial, place);
  }
  return place.holds && place.dependent == without.size();
}

std::vector<BodyState> Beside::bodies_at(const PlaceBeside& place) {
  std::vector<BodyState> states(sizes_.size());
  space_.stand_at(place.t, place.q);
  space_.problem().to_bodies(std::vector<double>(place.v.size(), 0.0), states);
  return states;
}

bool Beside::has_moved(const PlaceBeside& from, const PlaceBeside& to, const NullSpace& null) {
  constexpr double kMoved = 1e-3 * kMove;
  const std::vector<BodyState> before = bodies_at(from), after = bodies_at(to);
  const auto seen = [](const std::vector<BodyState>& states, const Row& row) -> std::pair<Vector3, Matrix3> {
    if (row.i == kGround) return {states[index(row.j)].r, states[index(row.j)].A};
    const BodyState& i = states[index(row.i)];
    if (row.j == kGround) return {i.r, i.A};
    return {i.A.transpose() * (states[index(row.j)].r - i.r), i.A.transpose() * states[index(row.j)].A};
  };
  const auto moves = [&](const std::pair<int, double>& entry) {
    const std::size_t k = index(entry.first);
    const Row& row = model_->rows[index(space_.rows()[k])];
    const auto [r, A] = seen(before, row);
    const auto [to_r, to_A] = seen(after, row);
    return (to_r - r).norm() > kMoved * space_.size_of_row(k) || (to_A - A).norm() > kMoved;
  };
  return std::ranges::all_of(null.vectors, [&](const SparseEntries& z) { return std::ranges::any_of(z, moves); });
}

}  // namespace poinsot
