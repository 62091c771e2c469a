// A number of a sample by the name of its column, as the files of `poinsot run` call it: of the trajectory
// ("rod.vx"), of the reactions ("hinge.fx", "driver.lambda"), of the signals ("energy", "hinge.angle").
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "integrators/signals.h"

namespace poinsot::cases {

struct Column {
  enum Of { body, reaction, signal } of = body;
  std::size_t item = 0;       // body, group of the model, signal
  std::size_t component = 0;  // of a body: as in bench/view/trajectory_columns.h; of a reaction: f, n; of others: 0
};

// Nothing where there is no such column. Throws InputError where several files have it.
std::optional<Column> find_column(const Model& model, const std::string& name);

// The numbers of one run's samples. What no column asks for is not computed.
class SampleColumns {
 public:
  explicit SampleColumns(const std::vector<Column>& columns);

  void update(const Sample& sample);
  double value(const Column& column) const;

 private:
  bool with_bodies_ = false, with_reactions_ = false, with_signals_ = false;
  std::vector<BodyState> bodies_;
  const Model* model_ = nullptr;
  std::optional<Reactions> reactions_;
  std::optional<Signals> signals_;
};

}  // namespace poinsot::cases
