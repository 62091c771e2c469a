// Problem over Mechanism<F, double> and MechanismMatrix<F, double>: the virtual seam, one call per evaluation of the
// whole mechanism.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/check.h"
#include "formulations/alternates.h"
#include "formulations/blocks.h"
#include "formulations/counted_turn.h"
#include "formulations/faults.h"
#include "formulations/largest_residual.h"
#include "formulations/mechanism.h"
#include "formulations/mechanism_matrix.h"
#include "formulations/registry.h"
#include "formulations/torsion.h"

namespace poinsot {

template <Formulation F>
class MechanismProblem final : public Problem {
 public:
  explicit MechanismProblem(std::shared_ptr<const Elements> elements)
      : mechanism_(std::move(elements)), matrix_(*mechanism_.c.elements) {
    bodies_ = mechanism_.nb();
    nq_ = mechanism_.nq();
    nv_ = mechanism_.nv();
    nc_ = mechanism_.nc();
  }

  std::unique_ptr<Problem> clone() const override {
    auto copy = std::make_unique<MechanismProblem>(mechanism_.c.elements);
    copy->mechanism_.c.twist = mechanism_.c.twist;
    copy->mechanism_.c.followed = mechanism_.c.followed;
    copy->mechanism_.c.alternate_stood_in = mechanism_.c.alternate_stood_in;
    return copy;
  }
  std::unique_ptr<Problem> clone_without(std::span<const int> dropped) const override {
    auto copy =
        std::make_unique<MechanismProblem>(std::make_shared<const Elements>(mechanism_.c.elements->model, dropped));
    copy->mechanism_.c.twist = mechanism_.c.twist;
    copy->mechanism_.c.followed = mechanism_.c.followed;
    return copy;
  }
  std::string_view formulation() const override { return F::name; }
  const Model& model() const override { return *mechanism_.c.elements->model; }
  const std::vector<int>& model_rows() const override { return mechanism_.c.elements->model_row; }

  void from_bodies(std::span<const BodyState> states, std::span<double> q, std::span<double> v) const override {
    expect(q, nq_), expect(v, nv_);
    for (int b = 0; b < bodies_; ++b) {
      const BodyState& state = states[static_cast<std::size_t>(b)];
      double* r = q.data() + b * M::kQ;
      double* rd = v.data() + b * M::kV;
      Eigen::Map<Vector3>{r} = state.r;
      Eigen::Map<Vector3>{rd} = state.rd;
      F::from_rotation(state.A, r + 3);
      typename F::template Position<double> at;
      F::position(r + 3, at);
      F::rates_from(at, state.w, rd + 3);
    }
  }

  void to_bodies(std::span<const double> a, std::span<BodyState> states) const override {
    expect(a, nv_);
    check(states.size() <= static_cast<std::size_t>(bodies_), "states are asked of bodies there are");
    const auto& c = mechanism_.c;
    for (int b = 0; b < static_cast<int>(states.size()); ++b) {
      const std::size_t k = static_cast<std::size_t>(b);
      const double* ab = a.data() + b * M::kV;
      BodyState& state = states[k];
      state.r = c.r(b);
      state.A = c.at[k].A;
      state.rd = c.rd(b);
      state.w = c.rate[k].w;
      state.rdd = Eigen::Map<const Vector3>(ab);
      state.wd = F::angular_acceleration(c.at[k], c.rate[k], c.xd(b), ab + 3);
    }
  }

  void poses(std::span<const int> bodies, std::span<double> out) const override {
    expect(out, 12 * static_cast<int>(bodies.size()));
    double* pose = out.data();
    for (const int b : bodies) {
      Eigen::Map<Vector3>{pose} = mechanism_.c.r(b);
      Eigen::Map<Matrix3>{pose + 3} = mechanism_.c.at[static_cast<std::size_t>(b)].A;
      pose += 12;
    }
  }

  void retract(std::span<const double> q, std::span<const double> dq, std::span<double> q_out) const override {
    expect(q, nq_), expect(dq, nv_), expect(q_out, nq_);
    M::retract(q.data(), dq.data(), q_out.data(), bodies_);
  }

  void set_position(double t, std::span<const double> q) override {
    expect(q, nq_);
    mechanism_.set_position(t, q.data());
  }
  void set_velocity(std::span<const double> v) override {
    expect(v, nv_);
    mechanism_.set_velocity(v.data());
  }

  void position_residual(std::span<double> Phi) const override {
    expect(Phi, nc_);
    mechanism_.constraint_residual(1.0, 0.0, Phi.data());
  }
  void velocity_residual(std::span<double> r) const override {
    expect(r, nc_);
    mechanism_.velocity_residual(r.data());
  }
  LargestResidual largest_residual() const override { return largest_residual_of(mechanism_); }
  void nu(std::span<double> out) const override {
    expect(out, nc_);
    mechanism_.nu(out.data());
  }
  void gamma(std::span<double> out) override {
    expect(out, nc_);
    mechanism_.gamma(out.data());
  }
  void momentum(std::span<const double> v_in, std::span<double> out) const override {
    expect(v_in, nv_), expect(out, nv_);
    mechanism_.momentum(v_in.data(), out.data());
  }
  void constraint_forces(std::span<const double> lambda, std::span<double> out) override {
    expect(lambda, nc_), expect(out, nv_);
    mechanism_.constraint_forces(lambda.data(), out.data());
  }
  void equations_of_motion(std::span<const double> a, std::span<const double> lambda, std::span<double> out) override {
    expect(a, nv_), expect(out, nv_);
    if (!lambda.empty()) expect(lambda, nc_);
    mechanism_.residual(a.data(), lambda.empty() ? nullptr : lambda.data(), out.data(), nullptr, nullptr);
  }
  void step_residual(const StepScale& scale, std::span<const double> a, std::span<const double> lambda,
                     std::span<double> out) override {
    expect(a, nv_), expect(lambda, nc_), expect(out, nv_ + nc_);
    mechanism_.residual(a.data(), lambda.data(), out.data(), &scale, out.data() + nv_);
  }

  Pattern pattern(MatrixKind kind) const override {
    const std::vector<double> zeros(static_cast<std::size_t>(std::max(nq_, nv_) + nc_), 0.0);  // places, no values
    M scratch(mechanism_.c.elements);
    scratch.set_position(0, zeros.data());
    scratch.set_velocity(zeros.data());
    Pattern pattern;
    const bool rows_only = kind == MatrixKind::kinematic || kind == MatrixKind::rates;
    pattern.n = rows_only ? std::max(nv_, nc_) : nv_ + nc_;
    pattern.blocks.reserve(static_cast<std::size_t>(12 * bodies_ + 6 * nc_));  // about as many as joints come to
    Blocks blocks{&pattern.blocks};
    Matrix(*mechanism_.c.elements).write(scratch.c, kind, {1, 1, 1}, nullptr, zeros.data(), zeros.data(), blocks);
    for (int k = 0; k < pattern.n; ++k) pattern.node.push_back(node_of(k));
    return pattern;
  }

  void assemble(MatrixKind kind, const StepScale& scale, std::span<const double> dq, std::span<const double> a,
                std::span<const double> lambda, std::span<const int> slots, std::span<double> values) override {
    if (Matrix::adds_only(*mechanism_.c.elements, kind)) std::fill(values.begin(), values.end(), 0.0);
    Blocks blocks{slots, values};
    matrix_.write(mechanism_.c, kind, scale, dq.empty() ? nullptr : dq.data(), a.data(), lambda.data(), blocks);
    check(blocks.slot == slots.data() + slots.size(), "an assembled matrix has the blocks of its pattern");
  }
  void lower(std::span<const double> dq, std::span<double> z) const override { M::lower(dq.data(), z.data(), bodies_); }

  bool has_discrete_state() const override {
    return F::space == CoordinateSpace::charts || !mechanism_.c.twist.empty() || !mechanism_.c.followed.empty();
  }
  bool exchanges_rows() const override { return alternates_change(mechanism_.c); }
  Status accept(double t, std::span<double> q, std::span<double> v, std::span<double> a, std::span<double>,
                bool& rewritten) override {
    auto& c = mechanism_.c;
    const auto rows_off = [&] {
      Eigen::VectorXd Phi(nc_);
      position_residual(std::span(Phi.data(), static_cast<std::size_t>(nc_)));
      return Phi.template lpNorm<Eigen::Infinity>();
    };
    if (Status status = exchange_alternates(c, t, rows_off); !status.ok()) return status;
    for (std::size_t k = 0; k < c.twist.size(); ++k) {
      c.twist[k] = Torsion<F, double>::angle(c, c.elements->torsions[k], c.twist[k]);
    }
    for (std::size_t k = 0; k < c.followed.size(); ++k) c.followed[k] = followed_angle(static_cast<int>(k));
    rewritten = false;
    if constexpr (F::space == CoordinateSpace::charts) {
      for (int b = 0; b < bodies_; ++b) {
        const std::size_t k = static_cast<std::size_t>(b);
        rewritten |= F::rechart(mechanism_.c.at[k], mechanism_.c.rate[k], q.data() + b * M::kQ + 3,
                                v.data() + b * M::kV + 3, a.data() + b * M::kV + 3);
      }
    }
    return {};
  }

  void reaction(int group, std::span<const double> lambda, Vector3& force, Vector3& moment) const override {
    const Elements& e = *mechanism_.c.elements;
    const Group& of = e.model->groups[static_cast<std::size_t>(group)];
    force.setZero();
    moment.setZero();
    int first = 0, count = 0;
    for (int k = 0; k < of.rows; ++k) {
      const int row = e.row_of[static_cast<std::size_t>(of.first_row + k)];
      if (row < 0) continue;
      if (count++ == 0) first = row;
    }
    if (count == 0) return;
    mechanism_.reaction(first, count, lambda.data(), force, moment);
    if (of.j != kGround) {
      moment -= (mechanism_.c.at[static_cast<std::size_t>(of.j)].A * of.point_j).cross(force);
    } else {
      moment -= of.point_j.cross(force);
    }
  }
  double energy() const override { return mechanism_.energy(); }
  std::string fault() const override { return first_fault(mechanism_.c); }
  double twist(int torsion) const override {
    const auto& c = mechanism_.c;
    const std::size_t k = static_cast<std::size_t>(torsion);
    return Torsion<F, double>::angle(c, c.elements->torsions[k], c.twist[k]);
  }
  double followed_angle(int of) const override {
    const auto& c = mechanism_.c;
    const std::size_t k = static_cast<std::size_t>(of);
    return Torsion<F, double>::angle(c, c.elements->followed[k], c.followed[k]);
  }
  void count_turns_from(const Problem& other) override {
    const auto& from = static_cast<const MechanismProblem&>(other).mechanism_.c;
    mechanism_.c.twist = from.twist;
    mechanism_.c.followed = from.followed;
  }

  double turn(int body) const override { return mechanism_.c.rate[index(body)].w.norm(); }
  double fastest_turn() const override {
    double square = 0;
    for (const auto& rate : mechanism_.c.rate) square = std::max(square, rate.w.squaredNorm());
    return std::sqrt(square);
  }
  CountedTurn counted_turn() const override { return fastest_counted_turn(mechanism_.c); }

  std::string describe_unknown(int k) const override {
    const Elements& e = *mechanism_.c.elements;
    if (k < nv_) return body_name(k / M::kV) + (k % M::kV < 3 ? "" : unfit_orientation(k / M::kV));
    if (k - nv_ >= e.rows) return body_name(k - nv_ - e.rows) + " (its normalization)";
    return describe_row(*e.model, e.model_row[static_cast<std::size_t>(k - nv_)]);
  }

 private:
  using M = Mechanism<F, double>;
  using Matrix = MechanismMatrix<F, double>;

  template <class T>
  static void expect(std::span<T> vector, int size) {
    check(vector.size() == static_cast<std::size_t>(size), "a vector has the length the problem asks for");
  }

  int node_of(int unknown) const {
    const Elements& e = *mechanism_.c.elements;
    if (unknown < nv_) return unknown / M::kV;
    const int row = unknown - nv_;
    return row < e.rows ? bodies_ + e.row_node[static_cast<std::size_t>(row)] : row - e.rows;
  }

  // Where the chart of a body's orientation is all but singular, so is the matrix: Bᵀ J̄ B, the square of it.
  std::string unfit_orientation(int b) const {
    if constexpr (F::space == CoordinateSpace::charts) {
      constexpr double kNear = 1e-4;
      if (std::abs(mechanism_.c.at[static_cast<std::size_t>(b)].B.determinant()) > kNear) return {};
      std::vector<std::string_view> fit;
      for (const FormulationEntry& other : formulations())
        if (other.space != CoordinateSpace::charts) fit.push_back(other.name);
      return fmt::format(", whose orientation is singular in formulation {} there, but not in {}", F::name,
                         fmt::join(fit, ", "));
    }
    return {};
  }

  std::string body_name(int b) const { return "body '" + model().bodies[static_cast<std::size_t>(b)].name + "'"; }

  M mechanism_;
  Matrix matrix_;
};

}  // namespace poinsot
