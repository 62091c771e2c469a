#include "integrators/start/rough_pose.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/so3.h"

namespace poinsot {
namespace {

constexpr int kSteps = 300;
constexpr double kClosed = 1e-9;                             // of the size: the projection that follows does the rest
constexpr double kRoundedTo = 4e-16;                         // of the coordinates
constexpr double kLargestTurn = 1.0 / 3;                     // rad, of a body in a step
constexpr double kLeastDamping = 1e-13, kMostDamping = 1e9;  // the least: long mechanisms are soft
constexpr double kLeastWeight = 1e-4;  // of the largest mass, and of mass times size² for moments

class Closing {
 public:
  Closing(const Model& model, std::span<const BodyState> given)
      : model_(model),
        states_(given.begin(), given.end()),
        n_(static_cast<Eigen::Index>(6 * given.size())),
        size_(longest_arm(model)) {
    for (const Body& body : model.bodies) heaviest_ = std::max(heaviest_, body.mass);
    for (const BodyState& state : states_) rounding_ = std::max(rounding_, kRoundedTo * state.r.cwiseAbs().maxCoeff());
    rounding_ = std::max(rounding_, 1e-14 * size_);
  }

  // Whether nothing is left open.
  bool run() {
    double damping = 1e-3, cost = open();
    for (int step = 0; step < kSteps && largest() > rounding_; ++step) {
      const Eigen::VectorXd delta = bounded(solve(damping));
      if (!delta.allFinite()) break;
      const std::vector<BodyState> before = states_;
      const double was = cost;
      move(delta);
      cost = open();
      if (cost < was) {
        damping = std::max(kLeastDamping, damping / (cost < 1e-4 * was ? 1000 : 10));
        if (was - cost <= 1e-10 * was && largest() > kClosed * size_) break;  // it comes no nearer
        continue;
      }
      states_ = before;
      cost = open();
      damping *= 10;
      if (damping > kMostDamping) break;
    }
    return largest() <= kClosed * size_;
  }

  // Turns every body a little, each about another axis.
  void step_aside() {
    constexpr double kAside = 0.05;
    for (std::size_t b = 0; b < states_.size(); ++b) {
      const double k = static_cast<double>(b + 1);
      const Vector3 axis(std::sin(k), std::sin(2 * k + 1), std::cos(3 * k));
      states_[b].A = exp_so3<double>(kAside * axis.normalized()) * states_[b].A;
    }
  }

  std::vector<BodyState>& states() { return states_; }

 private:
  double open() {
    parts_ = open_parts(model_, states_);
    double sum = 0;
    for (const OpenPart& part : parts_) sum += weighed(part) * weighed(part);
    return std::isfinite(sum) ? sum : HUGE_VAL;
  }
  double weighed(const OpenPart& part) const { return part.angle ? size_ * part.value : part.value; }
  double largest() const {
    double most = 0;
    for (const OpenPart& part : parts_) most = std::max(most, std::abs(weighed(part)));
    return most;
  }

  Eigen::VectorXd solve(double damping) const {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd e(static_cast<Eigen::Index>(parts_.size()));
    const auto add = [&](int row, int body, const Vector3& r, const Vector3& turn, double by) {
      if (body == kGround) return;
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(row, 6 * body + k, by * r[k]);
        entries.emplace_back(row, 6 * body + 3 + k, by * turn[k]);
      }
    };
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const OpenPart& part = parts_[k];
      const Group& group = model_.groups[index(part.group)];
      const int row = static_cast<int>(k);
      e[row] = weighed(part);
      add(row, group.i, -part.g, part.on_i, part.angle ? size_ : 1);
      add(row, group.j, part.g, part.on_j, part.angle ? size_ : 1);
    }
    Eigen::SparseMatrix<double> J(e.size(), n_);
    J.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> matrix = Eigen::SparseMatrix<double>(J.transpose() * J) + damping * weights();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    return factors.solve(-(J.transpose() * e));
  }

  // M
  Eigen::SparseMatrix<double> weights() const {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t b = 0; b < states_.size(); ++b) {
      const Body& body = model_.bodies[b];
      const int first = 6 * static_cast<int>(b);
      const double mass = std::max(body.mass / heaviest_, kLeastWeight);
      const Matrix3 moments = states_[b].A * body.inertia * states_[b].A.transpose() / heaviest_;
      for (int k = 0; k < 3; ++k) {
        entries.emplace_back(first + k, first + k, mass);
        for (int l = 0; l < 3; ++l) {
          const double least = k == l ? kLeastWeight * mass * size_ * size_ : 0;
          entries.emplace_back(first + 3 + k, first + 3 + l, moments(k, l) + least);
        }
      }
    }
    Eigen::SparseMatrix<double> M(n_, n_);
    M.setFromTriplets(entries.begin(), entries.end());
    return M;
  }

  // The step, shortened where it would turn a body too far.
  static Eigen::VectorXd bounded(Eigen::VectorXd delta) {
    double turn = 0;
    for (Eigen::Index k = 3; k < delta.size(); k += 6) turn = std::max(turn, delta.segment<3>(k).norm());
    if (turn > kLargestTurn) delta *= kLargestTurn / turn;
    return delta;
  }

  void move(const Eigen::VectorXd& delta) {
    for (std::size_t b = 0; b < states_.size(); ++b) {
      const Eigen::Index first = 6 * static_cast<Eigen::Index>(b);
      states_[b].r += delta.segment<3>(first);
      states_[b].A = exp_so3<double>(Vector3(delta.segment<3>(first + 3))) * states_[b].A;
    }
  }

  const Model& model_;
  std::vector<BodyState> states_;
  const Eigen::Index n_;
  double size_, heaviest_ = 0;
  double rounding_ = 0;  // m, of coordinates: no pose closes further
  std::vector<OpenPart> parts_;
};

}  // namespace

ClosedPose close_mechanism(const Model& model, std::span<const BodyState> given) {
  Closing closing(model, given);
  if (closing.run()) return {.closed = true, .states = std::move(closing.states())};
  Closing beside(model, given);
  beside.step_aside();
  if (beside.run()) return {.closed = true, .from_beside = true, .states = std::move(beside.states())};
  const std::vector<Gap> open = gaps(model, closing.states());
  const auto most = std::ranges::max_element(open, {}, &Gap::largest);
  return {.states = std::move(closing.states()), .worst = static_cast<int>(most - open.begin()), .gap = *most};
}

}  // namespace poinsot
