#include "bench/view/frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "formulations/registry.h"

namespace poinsot::view {
namespace {

constexpr std::size_t kFewFrames = 1000;  // no motion is thinned to fewer

double largest(std::span<const double> residual) {
  double x = 0;
  for (const double r : residual) x = std::max(x, std::abs(r));
  return x;
}

}  // namespace

FrameRecorder::FrameRecorder(std::shared_ptr<const Model> model, bool thin)
    : model_(std::move(model)), problem_(intrinsic_formulation().make(model_, {})), thin_(thin) {
  q_.resize(index(problem_->nq()));
  v_.resize(index(problem_->nv()));
  a_.resize(index(problem_->nv()));
  lambda_.resize(index(problem_->nc()));
  residual_.resize(index(problem_->nc()));
}

void FrameRecorder::add(double t, std::span<const BodyState> bodies) {
  last_.t = t;
  last_.bodies.assign(bodies.begin(), bodies.end());
  last_.kinetic = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    last_.kinetic += (model_->bodies[b].mass * bodies[b].rd.squaredNorm() +
                      bodies[b].w.dot(model_->bodies[b].inertia * bodies[b].w)) /
                     2;
  problem_->from_bodies(bodies, q_, v_);
  const auto stand = [&] {
    problem_->set_position(t, q_);
    problem_->set_velocity(v_);
  };
  stand();
  // Turns of torsion springs are counted from frame to frame.
  bool rewritten = false;
  if (problem_->has_discrete_state() && problem_->accept(t, q_, v_, a_, lambda_, rewritten).ok() && rewritten) stand();
  last_.energy = problem_->energy();
  problem_->position_residual(residual_);
  last_.position_violation = largest(residual_);
  problem_->velocity_residual(residual_);
  last_.velocity_violation = largest(residual_);
  if (added_++ % stride_ != 0) return;
  frames_.push_back(last_);
  if (!thin_ || frames_.size() * bodies.size() <= kManyPoses || frames_.size() < 2 * kFewFrames) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < frames_.size(); k += 2) std::swap(frames_[kept++], frames_[k]);
  frames_.resize(kept);
  stride_ *= 2;
}

std::vector<Frame> FrameRecorder::take() {
  if (!frames_.empty() && frames_.back().t < last_.t) frames_.push_back(std::move(last_));
  return std::move(frames_);
}

}  // namespace poinsot::view
