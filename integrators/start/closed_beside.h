// Positions beside a given one that satisfy all constraints: bodies are moved a little at random, and the mechanism is
// closed again. Beside a singular position they are where the constraints are what they are elsewhere.
#pragma once

#include <optional>
#include <random>
#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot {

class ClosedBeside {
 public:
  ClosedBeside(const Model& model, std::span<const BodyState> states);

  // Drivers that move the mechanism on hold it where it is, and large mechanisms cannot be closed.
  bool can_be_found() const;
  // The next one; nothing where that could not be closed.
  std::optional<std::vector<BodyState>> next();

 private:
  const Model& model_;
  std::span<const BodyState> states_;
  std::vector<double> sizes_;
  std::mt19937 random_;
};

}  // namespace poinsot
