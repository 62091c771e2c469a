// A family computed: its cells as the cases of a study (bench/cases), and what they come to.
#pragma once

#include <functional>

#include "bench/cases/case_table.h"
#include "bench/stability/family.h"
#include "bench/stability/verdict.h"
#include "integrators/integrator.h"

namespace poinsot::stability {

// What is computed of a family. Formulations and integrators: by name, all where empty.
struct Extent {
  bool quick = false;
  std::vector<std::string> formulations = {}, integrators = {};
};

// The study of a family: one scene, or its variants, with its parameters; each integrator in each formulation that it
// takes, with what varies of the settings.
class FamilyStudy {
 public:
  FamilyStudy(const Family& family, const Extent& extent);

  const cases::Study& study() const { return study_; }
  // Of rows that are all there, judged, by method, y and x.
  std::vector<Cell> cells(const cases::CaseTable& table) const;

 private:
  struct Choice {  // of settings
    const IntegratorEntry* integrator;
    std::size_t x_place = 0, y_place = 0;  // along axes of settings
  };
  void add_scenes();
  void add_axes();
  void add_settings(const Extent& extent);
  void add_columns();
  Cell cell(const cases::CaseTable& table, std::int64_t number) const;

  const Family& family_;
  bool quick_;
  cases::Study study_;
  std::vector<Choice> choices_;
};

// Computes what the table does not have, in so many threads; `meanwhile` is called at intervals by this one.
void compute(const FamilyStudy& family, cases::CaseTable& table, int threads, const std::function<void()>& meanwhile);

}  // namespace poinsot::stability
