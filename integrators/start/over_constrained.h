// A problem with redundant rows: kept are rows that determine the motion, the others are set aside and watched.
//
// After every accepted step the rows set aside are measured, but for those that a row kept says word for word. Where
// one of them does not hold any more the run stops and names it: it followed from the others where the run began only.
// And when the mechanism has turned by some angle the choice is looked at again (integrators/start/row_choice.h): as
// the directions in which the mechanism is constrained too often turn with it, rows that were a good choice become
// singular. Then other rows take the place of those kept, with the multipliers that mean the same reactions; revision()
// counts that up, and linear systems are analysed anew.
//
// Scenes without redundant rows have none of this.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formulations/problem.h"
#include "integrators/start/aside_watch.h"
#include "integrators/start/rank.h"
#include "integrators/start/row_choice.h"

namespace poinsot {

class OverConstrained final : public Problem {
 public:
  // `kept` is the model's problem without the rows that `rank` sets aside, which are redundant at `states`.
  OverConstrained(std::unique_ptr<Problem> kept, const std::shared_ptr<const Model>& model, const RankAnalysis& rank,
                  std::span<const BodyState> states, Steps steps);

  std::unique_ptr<Problem> clone() const override;
  std::unique_ptr<Problem> clone_without(std::span<const int> dropped) const override {
    return kept_->clone_without(dropped);
  }
  int revision() const override { return choice_->revision; }
  // A sentence about a row set aside that held, but not to rounding, at the ends of steps; else empty.
  std::string apart() const { return describe(choice_->apart, model()); }
  // Whether of its reactions the least can be told (reactions.h).
  bool has_least_reactions() const { return choice_->rows.has_null_vectors(); }
  // Reactions that redundant rows leave undetermined where the bodies stand; none where null vectors are not known.
  std::vector<Undetermined> undetermined(double t, std::span<const BodyState> states) const;

  std::string_view formulation() const override { return kept_->formulation(); }
  const Model& model() const override { return kept_->model(); }
  const std::vector<int>& model_rows() const override { return kept_->model_rows(); }
  void from_bodies(std::span<const BodyState> states, std::span<double> q, std::span<double> v) const override {
    kept_->from_bodies(states, q, v);
  }
  void to_bodies(std::span<const double> a, std::span<BodyState> states) const override { kept_->to_bodies(a, states); }
  void poses(std::span<const int> bodies, std::span<double> out) const override { kept_->poses(bodies, out); }
  void retract(std::span<const double> q, std::span<const double> dq, std::span<double> q_out) const override {
    kept_->retract(q, dq, q_out);
  }
  void set_position(double t, std::span<const double> q) override;
  void set_velocity(std::span<const double> v) override { kept_->set_velocity(v); }
  void position_residual(std::span<double> Phi) const override { kept_->position_residual(Phi); }
  void velocity_residual(std::span<double> r) const override { kept_->velocity_residual(r); }
  void nu(std::span<double> out) const override { kept_->nu(out); }
  void gamma(std::span<double> out) override { kept_->gamma(out); }
  void momentum(std::span<const double> v_in, std::span<double> out) const override { kept_->momentum(v_in, out); }
  void constraint_forces(std::span<const double> lambda, std::span<double> out) override {
    kept_->constraint_forces(lambda, out);
  }
  void equations_of_motion(std::span<const double> a, std::span<const double> lambda, std::span<double> out) override {
    kept_->equations_of_motion(a, lambda, out);
  }
  void step_residual(const StepScale& scale, std::span<const double> a, std::span<const double> lambda,
                     std::span<double> out) override {
    kept_->step_residual(scale, a, lambda, out);
  }
  Pattern pattern(MatrixKind kind) const override { return kept_->pattern(kind); }
  void assemble(MatrixKind kind, const StepScale& scale, std::span<const double> dq, std::span<const double> a,
                std::span<const double> lambda, std::span<const int> slots, std::span<double> values) override {
    kept_->assemble(kind, scale, dq, a, lambda, slots, values);
  }
  void lower(std::span<const double> dq, std::span<double> z) const override { kept_->lower(dq, z); }
  void reaction(int group, std::span<const double> lambda, Vector3& force, Vector3& moment) const override {
    kept_->reaction(group, lambda, force, moment);
  }
  double energy() const override { return kept_->energy(); }
  std::string fault() const override { return kept_->fault(); }
  double twist(int torsion) const override { return kept_->twist(torsion); }
  double followed_angle(int of) const override { return kept_->followed_angle(of); }
  void count_turns_from(const Problem& other) override {
    kept_->count_turns_from(*static_cast<const OverConstrained&>(other).kept_);
  }
  double turn(int body) const override { return kept_->turn(body); }
  double fastest_turn() const override { return kept_->fastest_turn(); }
  CountedTurn counted_turn() const override { return kept_->counted_turn(); }
  std::string describe_unknown(int k) const override { return kept_->describe_unknown(k); }

  bool has_discrete_state() const override { return true; }
  bool exchanges_rows() const override { return kept_->exchanges_rows(); }
  Status accept(double t, std::span<double> q, std::span<double> v, std::span<double> a, std::span<double> lambda,
                bool& rewritten) override;
  bool accepts_as_is(double t, std::span<const double> a) override;
  bool choose_rows_here(double t, std::span<const double> q, std::span<const double> v,
                        std::span<double> lambda) override;
  LargestResidual largest_residual() const override;

 private:
  // Shared by the clones of one run: all of them keep the same rows.
  struct Choice {
    RowChoice rows;
    int revision = 0;
    std::vector<BodyState> at;  // where it was last looked at
    Apart apart;
  };

  // What becomes of the way since the last look with a step.
  struct Way {
    double t;            // s, its end
    double h;            // s
    double ahead, done;  // rad: as much as in this step, by the fastest body; with it
  };

  OverConstrained(const OverConstrained& other);
  Way way_to(double t) const;
  bool is_looked_at(const Way& way) const;
  void go(const Way& way);
  void keep();
  void watch();
  double turned() const;
  void exchange(double t, std::span<const double> q, std::span<const double> v, std::span<double> lambda);
  void normalize(std::span<const double> forces, std::span<double> lambda);

  std::shared_ptr<Choice> choice_;
  int kept_revision_ = 0;
  std::unique_ptr<Problem> kept_;
  const bool to_tolerance_;  // kept rows hold
  mutable std::optional<AsideWatch> watch_;
  double t_ = 0;                // where the problem stands
  double accepted_at_ = 0;      // the last step's end
  double longest_ = 0;          // s, step since the last look
  double way_ = 0, ahead_ = 0;  // rad, what the fastest body has turned by since the last look, about; its last part
  mutable std::vector<BodyState> now_;
  std::vector<double> no_accelerations_;
};

}  // namespace poinsot
