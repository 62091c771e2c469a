#include "integrators/methods/dopri5.h"

#include "integrators/methods/explicit_runge_kutta.h"

namespace poinsot {
namespace {
namespace dopri5_tableau {

constexpr Term a2[] = {{0, 1.0 / 5}};
constexpr Term a3[] = {{0, 3.0 / 40}, {1, 9.0 / 40}};
constexpr Term a4[] = {{0, 44.0 / 45}, {1, -56.0 / 15}, {2, 32.0 / 9}};
constexpr Term a5[] = {{0, 19372.0 / 6561}, {1, -25360.0 / 2187}, {2, 64448.0 / 6561}, {3, -212.0 / 729}};
constexpr Term a6[] = {
    {0, 9017.0 / 3168}, {1, -355.0 / 33}, {2, 46732.0 / 5247}, {3, 49.0 / 176}, {4, -5103.0 / 18656}};
constexpr Stage stages[] = {{0, {}}, {1.0 / 5, a2}, {3.0 / 10, a3}, {4.0 / 5, a4}, {8.0 / 9, a5}, {1, a6}};
constexpr Term b[] = {{0, 35.0 / 384}, {2, 500.0 / 1113}, {3, 125.0 / 192}, {4, -2187.0 / 6784}, {5, 11.0 / 84}};
constexpr Term error[] = {{0, 71.0 / 57600},      {2, -71.0 / 16695}, {3, 71.0 / 1920},
                          {4, -17253.0 / 339200}, {5, 22.0 / 525},    {6, -1.0 / 40}};
constexpr Term d1[] = {{0, -12715105075.0 / 11282082432}, {2, 87487479700.0 / 32700410799},
                       {3, -10690763975.0 / 1880347072},  {4, 701980252875.0 / 199316789632},
                       {5, -1453857185.0 / 822651844},    {6, 69997945.0 / 29380423}};
constexpr Terms dense[] = {d1};

constexpr double kBeta = 0.04;
constexpr RungeKuttaPair kPair{
    "dopri5", 5, stages, b, error, {}, {}, dense, {0.9, 1.0 / 5 - 0.75 * kBeta, kBeta, 0.2, 10}, 3.25};

}  // namespace dopri5_tableau
}  // namespace

const RungeKuttaPair& dopri5_pair() {
  return dopri5_tableau::kPair;
}

std::unique_ptr<Integrator> make_dopri5() {
  return make_explicit_runge_kutta(dopri5_tableau::kPair);
}

}  // namespace poinsot
