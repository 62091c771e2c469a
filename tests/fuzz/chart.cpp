// The CSV of a chart is gone on with or refused, and what is read from it has fronts and conclusions.
#include "bench/study/chart_file.h"
#include "bench/study/cost_curve.h"
#include "core/input_error.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace poinsot;
  static const fuzz::InputFile file("chart.csv");
  file.write(fuzz::text_of(data, size));
  const auto conclude = [](const std::vector<study::ChartRow>& rows) {
    for (std::size_t k = 0; k < study::kQuantities.size(); ++k) {
      const study::CostCurves curves(rows, k, 1e-12);
      (void)curves.front();
      (void)curves.conclusion();
      (void)curves.rounding_only();
    }
  };
  try {
    conclude(study::chart_rows(study::read_csv(file.path())));
  } catch (const InputError&) {
  }
  try {
    const study::ChartFile chart(file.path(), {}, false);
    conclude(chart.rows());
  } catch (const InputError&) {
  }
  return 0;
}
