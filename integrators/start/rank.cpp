#include "integrators/start/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "core/check.h"
#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/settings.h"
#include "integrators/start/loop_rows.h"
#include "integrators/start/row_choice.h"
#include "integrators/start/row_space.h"
#include "integrators/stepping/consistent.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// Beside: bodies move by this part of their size. A row that is singular where they stood has that much of its length
// free there, give or take the shape of the mechanism; what follows from others but for the second order of the move,
// where some row does not hold, has the square of it.
constexpr double kMove = 1e-3;
constexpr double kFreeBeside = 3e-5;
constexpr double kPulledBack = 0.3;  // of the move that has to be left after the projection
// Parts of a body's size: a row that holds beside is off by no more than the solution of the others, one that does not
// by some kMove² = 1e-6; one that contradicts the others by what the scene says.
constexpr double kHolds = 1e-9, kContradicts = 1e-6;
constexpr double kNoLoad = 1e-7;                       // of a null vector on unit rows
constexpr double kShortWhile = 1e-3;                   // s, where nothing moves yet
constexpr std::size_t kMostChosen = RowChoice::kMost;  // dependent rows: the time grows with their square
constexpr int kManyRows = 20'000;  // of loops: one random direction is looked at in the place of two

// Bodies of unit mass that turn as hard as they move: projections are the shortest ways.
std::shared_ptr<const Model> with_unit_masses(const Model& model, std::span<const double> sizes) {
  auto unit = std::make_shared<Model>(model);
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    unit->bodies[b].mass = 1;
    unit->bodies[b].inertia = sizes[b] * sizes[b] * Matrix3::Identity();
  }
  return unit;
}

std::vector<int> united(std::vector<int> a, const std::vector<int>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::ranges::sort(a);
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

class Examination {
 public:
  Examination(std::shared_ptr<const Model> model, std::span<const BodyState> states, RankNames names)
      : model_(std::move(model)), states_(states.begin(), states.end()), names_(names), sizes_(body_sizes(*model_)) {}

  RankAnalysis run() {
    const int rows = static_cast<int>(model_->rows.size());
    result_.variables = 6 * static_cast<int>(model_->bodies.size());
    result_.rank = result_.rank_here = rows;
    std::vector<int> loops = loop_rows(model_, 0, states_);
    if (loops.empty()) return std::move(result_);
    space_.emplace(model_, std::move(loops));
    space_->stand(0, states_);
    const std::size_t suspects = dependent_columns(space_->columns(), kIndependent).size();
    if (suspects == 0) return std::move(result_);
    without_ = chosen(space_->columns(), kIndependent);
    look_beside(suspects);
    return std::move(result_);
  }

 private:
  // Rows of the model without which the others are as independent as can be; beyond kMostChosen, just independent.
  std::vector<int> chosen(const Sparse& columns, double tolerance) const {
    return of_model(choose(columns, tolerance));
  }
  static std::vector<int> choose(const Sparse& columns, double tolerance) {
    std::vector<int> plain = dependent_columns(columns, tolerance);
    if (plain.size() > kMostChosen) return plain;
    return separate(null_space(columns, tolerance).vectors);
  }
  std::vector<int> of_model(std::vector<int> columns) const {
    for (int& column : columns) column = space_->rows()[index(column)];
    std::ranges::sort(columns);
    return columns;
  }

  struct Place {
    double t = 0;
    std::vector<double> q, v;
    Sparse columns;
    std::size_t dependent = 0;
    bool holds = false;
    int worst = -1;  // the row that is off most, of those left out
    double off = 0;  // m
  };

  // `suspects`: how many rows may be dependent.
  void look_beside(std::size_t suspects) {
    const Sparse columns = space_->columns();
    const std::vector<int> surely = dependent_columns(columns, kDependent);
    unit_ = with_unit_masses(*model_, sizes_);
    Trial trial = begin(without_);
    if (trial.regular) find_conflicts(trial, without_);
    if (surely.empty()) result_.conflicts.clear();  // rows that are independent, if only just, contradict nothing
    if (!result_.conflicts.empty()) {  // told as a reader of the scene meets them: what contradicts rows before it
      std::vector<Conflict> as_chosen = std::exchange(result_.conflicts, {});
      const std::vector<int> by_order = of_model(null_space(columns, kIndependent).columns);
      Trial other = begin(by_order);
      if (other.regular) find_conflicts(other, by_order);
      if (result_.conflicts.empty()) result_.conflicts = std::move(as_chosen);
    }
    const Place& start = trial.start;
    std::optional<Place> best, along;
    if (trial.regular && result_.conflicts.empty()) {
      along = beside_along_velocities(trial);
      best = along;
      const int directions = static_cast<int>(space_->rows().size()) > kManyRows ? 1 : 2;
      for (int k = 0; k < directions && (!best || best->dependent > 0); ++k) {
        std::optional<Place> place = beside_at_random(trial, k + 1);
        if (place && (!best || place->dependent < best->dependent)) best = std::move(place);
      }
    }
    if (best && best->dependent < suspects) {
      tell_redundant(best->columns, kFreeBeside);
      tell_singular(columns);
      result_.moves_on = along && leads_on(start, *along);
      if (along) result_.time_beside = along->t;
    } else {
      if (surely.size() < suspects) tell_doubt(columns, surely);
      tell_redundant(columns, kDependent);
      if (along && !along->holds && surely.size() == suspects)
        result_.conflicts.push_back({along->worst, Conflict::Level::later, along->off, along->t});
    }
  }

  // The given state, put onto the rows that are not left out.
  struct Trial {
    std::unique_ptr<Problem> problem;
    std::unique_ptr<Consistent> consistent;
    Place start;
    bool regular = false;
  };
  Trial begin(const std::vector<int>& without) const {
    Trial trial;
    trial.problem = intrinsic_formulation().make(unit_, without);
    trial.consistent = std::make_unique<Consistent>(*trial.problem, LinearChoice{});
    Place& start = trial.start;
    start.q.resize(index(trial.problem->nq())), start.v.resize(index(trial.problem->nv()));
    check(trial.problem->from_bodies(states_, start.q, start.v).ok(), "every orientation has coordinates");
    trial.regular = put_back(trial, start);
    if (!trial.regular) return trial;
    trial.problem->set_position(0, start.q);
    trial.problem->set_velocity(start.v);
    trial.regular = trial.consistent->project_velocity(0, start.v).ok();
    return trial;
  }

  // Onto the trial's rows.
  static bool put_back(Trial& trial, Place& place) { return trial.consistent->project_position(place.t, place.q).ok(); }

  // Largest move of a body by dq, in its size.
  double extent(std::span<const double> dq) const {
    double largest = 0;
    for (std::size_t b = 0; b < sizes_.size(); ++b)
      for (std::size_t k = 0; k < 6; ++k)
        largest = std::max(largest, std::abs(dq[6 * b + k]) / (k < 3 ? sizes_[b] : 1.0));
    return largest;
  }
  double distance(std::span<const double> q, std::span<const double> from) const {
    double largest = 0;
    const std::size_t per_body = q.size() / sizes_.size();
    for (std::size_t k = 0; k < q.size(); ++k)
      largest = std::max(largest, std::abs(q[k] - from[k]) / (k % per_body < 3 ? sizes_[k / per_body] : 1.0));
    return largest;
  }

  std::optional<Place> beside_along_velocities(Trial& trial) {
    const Place& start = trial.start;
    const double speed = extent(start.v);
    const bool driven = std::ranges::any_of(model_->rows, [](const Row& row) { return !row.f.is_constant(); });
    if (speed == 0 && !driven) return {};
    Place place = start;
    place.t = speed > 0 ? std::min(kMove / speed, 1.0) : kShortWhile;
    std::vector<double> dq = start.v;
    for (double& x : dq) x *= place.t;
    return settle(trial, std::move(place), dq, speed > 0 && kMove / speed <= 1.0);
  }

  std::optional<Place> beside_at_random(Trial& trial, int seed) {
    Problem& problem = *trial.problem;
    const Place& start = trial.start;
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    std::vector<double> move(index(problem.nv() + problem.nc()), 0.0);
    for (std::size_t b = 0; b < sizes_.size(); ++b)
      for (std::size_t k = 0; k < 6; ++k) move[6 * b + k] = sizes_[b] * (k < 3 ? 1 : sizes_[b]) * normal(random);
    const double asked = extent(std::span<const double>(move).first(start.v.size()));
    const std::vector<double> at_rest(start.v.size(), 0.0);
    problem.set_position(0, start.q);
    problem.set_velocity(at_rest);
    if (!trial.consistent->factor(0).ok() || !trial.consistent->solve(0, move).ok()) return {};
    move.resize(start.v.size());
    const double length = extent(move);
    if (!(length > 1e-6 * asked)) return {};  // it cannot move
    for (double& x : move) x *= kMove / length;
    return settle(trial, start, move, true);
  }

  // Moves by dq, puts the mechanism back onto the problem's rows, and looks at all of them.
  std::optional<Place> settle(Trial& trial, Place place, std::span<const double> dq, bool must_move) {
    const Place& start = trial.start;
    trial.problem->retract(start.q, dq, place.q);
    const double moved = distance(place.q, start.q);
    if (!put_back(trial, place)) return {};
    if (must_move && distance(place.q, start.q) < kPulledBack * moved) return {};
    look(*trial.problem, place);
    return place;
  }

  void look(Problem& problem, Place& place) {
    std::vector<BodyState> states(states_.size());
    problem.set_position(place.t, place.q);
    problem.set_velocity(place.v);
    const std::vector<double> none(place.v.size(), 0.0);
    problem.to_bodies(none, states);
    space_->stand(place.t, states);
    place.columns = space_->columns();
    place.dependent = dependent_columns(place.columns, kFreeBeside).size();
    std::vector<double> off(space_->rows().size());
    space_->distances(off);
    place.holds = true;
    for (std::size_t k = 0; k < off.size(); ++k) {
      const double allowed = kHolds * space_->size_of_row(k) + 3 * off_at_start_[k];
      if (std::abs(off[k]) <= allowed) continue;
      place.holds = false;
      if (std::abs(off[k]) <= place.off) continue;
      place.off = std::abs(off[k]);
      place.worst = space_->rows()[k];
    }
  }

  // The rows left out, where the others hold.
  void find_conflicts(Trial& trial, const std::vector<int>& without) {
    Problem& problem = *trial.problem;
    const Place& start = trial.start;
    std::vector<BodyState> states(states_.size());
    const std::vector<double> none(start.v.size(), 0.0);
    problem.set_position(0, start.q);
    problem.set_velocity(start.v);
    problem.to_bodies(none, states);
    space_->stand(0, states);
    off_at_start_.assign(space_->rows().size(), 0.0);
    space_->distances(off_at_start_);
    for (double& x : off_at_start_) x = std::abs(x);
    const std::unique_ptr<Problem> whole = intrinsic_formulation().make(model_, {});
    std::vector<double> rate(index(whole->nc())), nu(rate.size());
    whole->set_position(0, start.q);
    whole->set_velocity(start.v);
    whole->velocity_residual(rate);
    whole->nu(nu);
    const double speed = extent(start.v);
    for (std::size_t k = 0; k < off_at_start_.size(); ++k) {
      const int row = space_->rows()[k];
      if (!std::ranges::binary_search(without, row)) continue;
      const double size = space_->size_of_row(k), length = space_->lengths()[k];
      const double rate_off = std::abs(rate[index(row)]) / length;
      if (off_at_start_[k] > kContradicts * size)
        result_.conflicts.push_back({row, Conflict::Level::position, off_at_start_[k], 0});
      else if (rate_off > kContradicts * std::max({speed * size, std::abs(nu[index(row)]) / length, kHolds * size}))
        result_.conflicts.push_back({row, Conflict::Level::velocity, rate_off, 0});
    }
  }

  void tell_redundant(const Sparse& columns, double tolerance) {
    if (names_ == RankNames::all) {
      ColumnDependencies found = column_dependencies(columns, tolerance);
      result_.named = found.named;
      for (ColumnDependency& d : found.columns)
        result_.dependent.push_back({space_->rows()[index(d.column)], of_model(std::move(d.others))});
    }
    result_.aside = result_.aside_here = chosen(columns, tolerance);
    result_.rank = static_cast<int>(model_->rows.size() - result_.aside.size());
    result_.rank_here = result_.rank;
    tell_undetermined(columns, tolerance);
  }

  // A null vector loads a group where what its rows do to one of the bodies does not add up to nothing.
  void tell_undetermined(const Sparse& columns, double tolerance) {
    std::vector<char> loaded(model_->groups.size(), 0);
    const auto row = [&](int column) -> const Row& { return model_->rows[index(space_->rows()[index(column)])]; };
    if (result_.aside.size() > kMostChosen) {
      for (int k = 0; k < columns.cols(); ++k) loaded[index(row(k).group)] = 1;
    } else {
      for (const SparseEntries& z : null_space(columns, tolerance).vectors) {
        double largest = 0;
        for (const auto& [column, value] : z) largest = std::max(largest, std::abs(value));
        for (auto first = z.begin(); first != z.end();) {
          const int group = row(first->first).group;
          const Row& of = row(first->first);
          const int body = of.j != kGround ? of.j : of.i;
          Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
          for (; first != z.end() && row(first->first).group == group; ++first)
            for (Sparse::InnerIterator it(columns, first->first); it; ++it)
              if (it.row() / 6 == body) load[it.row() % 6] += first->second * it.value();
          if (load.norm() > kNoLoad * largest) loaded[index(group)] = 1;
        }
      }
    }
    for (std::size_t g = 0; g < loaded.size(); ++g)
      if (loaded[g]) result_.undetermined.push_back(static_cast<int>(g));
  }

  // Of the rows that are kept, those that are no more than combinations of others at the given position.
  void tell_singular(const Sparse& columns) {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<int> kept;
    for (int k = 0; k < columns.outerSize(); ++k) {
      if (std::ranges::binary_search(result_.aside, space_->rows()[index(k)])) continue;
      for (Sparse::InnerIterator it(columns, k); it; ++it)
        entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(kept.size()), it.value());
      kept.push_back(k);
    }
    Sparse part(columns.rows(), static_cast<Eigen::Index>(kept.size()));
    part.setFromTriplets(entries.begin(), entries.end());
    const auto whole = [&](std::vector<int> some) {
      for (int& k : some) k = kept[index(k)];
      return of_model(std::move(some));
    };
    for (ColumnDependency& d : column_dependencies(part, kIndependent).columns)
      result_.singular.push_back({space_->rows()[index(kept[index(d.column)])], whole(std::move(d.others))});
    result_.aside_here = united(result_.aside, whole(choose(part, kIndependent)));
    result_.rank_here = result_.rank - static_cast<int>(result_.singular.size());
  }

  void tell_doubt(const Sparse& columns, const std::vector<int>& surely) {
    result_.doubt = kIndependent;
    for (const int column : dependent_columns(columns, kIndependent))
      if (!std::ranges::binary_search(surely, column)) result_.doubtful = space_->rows()[index(column)];
    for (double part = kIndependent / 10; part > kDependent; part /= 10)
      if (dependent_columns(columns, part).size() > surely.size()) result_.doubt = part;
  }

  // Whether the mechanism, moved on along its velocities, comes to a position where all rows hold and are independent.
  bool leads_on(const Place& start, const Place& along) {
    if (extent(start.v) == 0) return false;
    Place place = along;
    if (!along.holds) {
      Trial trial;
      trial.problem = intrinsic_formulation().make(unit_, result_.aside);
      trial.consistent = std::make_unique<Consistent>(*trial.problem, LinearChoice{});
      if (!put_back(trial, place)) return false;
      if (distance(place.q, start.q) < kPulledBack * kMove) return false;
      look(*trial.problem, place);
    }
    return place.holds && place.dependent == result_.aside.size();
  }

  std::shared_ptr<const Model> model_, unit_;
  std::vector<BodyState> states_;
  RankNames names_;
  std::vector<double> sizes_;
  std::optional<RowSpace> space_;
  std::vector<int> without_;  // model rows: the others are independent at the given position
  std::vector<double> off_at_start_;
  RankAnalysis result_;
};

}  // namespace

std::vector<int> RankAnalysis::dependent_rows() const {
  std::vector<int> rows;
  for (const Dependency& d : dependent) rows.push_back(d.row);
  return rows;
}

std::string describe(const Conflict& conflict) {
  switch (conflict.level) {
    case Conflict::Level::position:
      return fmt::format("{:.3g} m (position)", conflict.by);
    case Conflict::Level::velocity:
      return fmt::format("{:.3g} m/s (velocity)", conflict.by);
    case Conflict::Level::later:
      return fmt::format("{:.3g} m (position, at t = {:.3g} s)", conflict.by, conflict.time);
  }
  return {};
}

RankAnalysis analyze_rank(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                          RankNames names) {
  return Examination(model, states, names).run();
}

}  // namespace poinsot
