// An expression is read or refused, as a function of time, as a constant and as a law, and can be computed.
#include "core/expression.h"

#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace poinsot;
  const std::string_view text = fuzz::text_of(data, size);
  for (const auto parse : {&Expression::parse, &Expression::parse_constant, &Expression::parse_law}) {
    try {
      const Expression f = parse(text, nullptr);
      for (const double t : {0.0, 0.3, -1.0, 1e300})
        (void)f.along(Arguments<Jet2<double>>{{t, 1, 0}, {t, 1, 0}, {1, t, 0}});
      (void)f.law(Arguments<double>{0.3, 0.1, -0.2});
      (void)f.fault(0.5, 2);
      (void)f.law_fault({0.3, 0.1, -0.2});
      std::vector<double> at(static_cast<std::size_t>(f.switch_count()));
      f.switches({0.3, 0.1, -0.2}, at);
      for (const Bounds state : {Bounds{-0.2, 0.1}, Bounds::unknown()}) {
        (void)f.range({{0, 1}, state, state});
        for (int k = 0; k < f.switch_count(); ++k) (void)f.switch_range(k, {{0, 1}, state, state});
      }
    } catch (const ExpressionError&) {
    }
  }
  return 0;
}
