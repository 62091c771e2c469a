// Positions beside a given one: the mechanism moved a little along its velocities, or along a random direction that its
// constraints leave free, time going on where drivers ask for it, and put back onto the rows that are kept. Bodies of
// unit mass that turn as hard as they move make projections the shortest ways.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/start/onto_rows.h"
#include "integrators/start/row_space.h"
#include "linsolve/column_dependencies.h"
#include "linsolve/front_qr.h"

namespace poinsot {

// A row that is singular where the mechanism stood has this much of its length free beside, give or take the shape of
// the mechanism; what follows from others but for the second order of the move, where some row does not hold, has the
// square of it.
inline constexpr double kFreeBeside = 3e-5;
// The same farther off, of rows that follow beside to the first order: of what is left of them when they are first
// seen.
inline constexpr double kFreeFarther = 1e-8;
// Part of a body's size: a row that holds beside is off by no more than the solution of the others, one that does not
// by some 1e-6, the square of the move.
inline constexpr double kHolds = 1e-9;
inline constexpr double kContradicts = 1e-6;  // of a body's size, or of its speed: by what the scene says

struct PlaceBeside {
  double t = 0;
  std::vector<double> q, v;
  Eigen::SparseMatrix<double> columns;  // where fewer are dependent than suspected
  std::size_t dependent = 0;            // of them; all suspects where it is as many
  bool holds = false;
  int worst = -1;  // the row that is off most, of those left out
  double off = 0;  // m, or m/s
  bool by_rate = false;
};

// The given state, put onto the rows that are not left out.
struct Trial {
  std::unique_ptr<OntoRows> onto;
  PlaceBeside start;
  std::vector<std::vector<double>> random;  // moves along directions that the constraints leave free at the start
  bool regular = false;                     // it could be put there
};

class Beside {
 public:
  // `space` stands where it was last looked. `suspects`: how many of its rows may be dependent.
  Beside(const std::shared_ptr<const Model>& model, std::span<const BodyState> states, RowSpace& space,
         std::size_t suspects);

  // `directions`: how many random ones at_random() is to have.
  Trial begin(const std::vector<int>& without, int directions = 0) const;
  // Without its dependent columns, of the space where it stands; with one direction.
  Trial begin(std::shared_ptr<FrontQr> decomposition) const;
  // Makes the trial's start the one from which `holds` is judged: m that each row of the space is off there.
  std::span<const double> measure_start(Trial& trial);
  // Nothing where it does not move, or the projection pulls it back.
  std::optional<PlaceBeside> along_velocities(Trial& trial);
  std::optional<PlaceBeside> at_random(Trial& trial, int direction);
  // Where rows that follow beside do not farther off, as a power of the way: they do to the first order only.
  std::optional<PlaceBeside> where_they_part(Trial& trial, int direction);
  // Both at once, as far as there are both.
  std::optional<PlaceBeside> anywhere(Trial& trial);
  // Whether the mechanism, moved on along its velocities, comes to a position where all rows hold and are independent
  // but those left out.
  bool leads_on(const PlaceBeside& start, const PlaceBeside& along, const std::vector<int>& without);

  // Whether bodies have moved against one another from one place to the other in each combination of rows: `null` has
  // vectors on the space's columns.
  bool has_moved(const PlaceBeside& from, const PlaceBeside& to, const NullSpace& null);

  double extent(std::span<const double> dq) const;  // largest move of a body by dq, in its size

 private:
  std::unique_ptr<OntoRows> by_motion(const std::vector<int>& without) const;
  Trial begin(std::unique_ptr<OntoRows> onto, int directions) const;
  bool free_direction(Trial& trial, int seed, std::vector<double>& move) const;
  struct Move {
    double t;
    std::vector<double> dq;
    bool must_stay;  // most of it after the projection, or it was none
  };
  std::optional<Move> along(const PlaceBeside& start) const;
  std::optional<PlaceBeside> settle(Trial& trial, const Move& move);
  std::optional<PlaceBeside> settled(Trial& trial, const Move& move);
  void look(Trial& trial, PlaceBeside& place);
  void look_at_rates(Trial& trial, PlaceBeside& place);
  double distance(std::span<const double> q, std::span<const double> from) const;
  std::vector<BodyState> bodies_at(const PlaceBeside& place);
  double rounding_of(int row, std::span<const BodyState> states) const;

  std::shared_ptr<const Model> model_;
  RowSpace& space_;
  std::size_t suspects_;
  std::vector<double> sizes_, q_, v_, off_at_start_;  // q_, v_: the given state
};

}  // namespace poinsot
