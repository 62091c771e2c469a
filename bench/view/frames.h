// A motion as a page shows it: bodies at frames, energies and how far the constraints are violated there.
//
// Energy and violation are computed from the bodies alone, in the intrinsic formulation and over all rows of the model,
// so that motions of different formulations and from files are judged alike: the largest |Φ| and |G v − ν|.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "formulations/problem.h"

namespace poinsot::view {

struct Frame {
  double t = 0;                                           // s
  std::vector<BodyState> bodies;                          // in scene order
  double kinetic = 0, energy = 0;                         // J; energy with the potential one of gravity and springs
  double position_violation = 0, velocity_violation = 0;  // in the units of the rows
};

struct Motion {
  std::string label;    // what tells it from others: how it was computed, or the file it is from
  std::string message;  // why it ends before its time; empty where it does not
  std::vector<Frame> frames;
};

// A page of more poses (bodies × frames) than this is a burden to a browser.
inline constexpr std::size_t kManyPoses = 200000;

class FrameRecorder {
 public:
  // `thin`: where the frames become too many every other one is left out, again and again; the last one stays.
  FrameRecorder(std::shared_ptr<const Model> model, bool thin);

  void add(double t, std::span<const BodyState> bodies);
  std::vector<Frame> take();
  std::size_t stride() const { return stride_; }  // every how many-th of the frames added is kept

 private:
  std::shared_ptr<const Model> model_;
  std::unique_ptr<Problem> problem_;
  bool thin_;
  std::size_t added_ = 0, stride_ = 1;
  std::vector<double> q_, v_, a_, lambda_, residual_;
  std::vector<Frame> frames_;
  Frame last_;  // the one added last
};

}  // namespace poinsot::view
