#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/commands.h"
#include "formulations/registry.h"
#include "integrators/integrator.h"
#include "integrators/jacobian_policy.h"
#include "linsolve/registry.h"

namespace poinsot::app {
namespace {

template <class Table>
void print_table(const char* title, const Table& table) {
  std::size_t width = 0;
  for (const auto& entry : table) width = std::max(width, entry.name.size());
  fmt::print("{}\n", title);
  for (const auto& entry : table) {
    fmt::print("  {:<{}}  {}\n", entry.name, width, entry.about);
    if constexpr (requires { entry.parameters; }) {
      for (const MethodParameter& p : entry.parameters)
        fmt::print("  {:<{}}  {}, {} to {}, default {}: {}\n", "", width, p.name, p.least, p.most, p.by_default,
                   p.about);
    }
    if constexpr (requires { entry.needs_vector_space; }) {
      for (const FormulationEntry& formulation : formulations())
        if (const auto refusal = refusal_of(entry, formulation.name))
          fmt::print("  {:<{}}  refuses {}: {}\n", "", width, refusal->formulation, refusal->why);
    }
  }
}

}  // namespace

void add_list(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("list", "formulations, integrators, linear solvers and Newton matrices there are");
  command->callback([&status] {
    print_table("formulations", formulations());
    print_table("integrators", integrators());
    print_table("linear solvers", linear_solvers());
    print_table("linear systems", linear_systems());
    print_table("jacobians", jacobians());
    status = 0;
  });
}

}  // namespace poinsot::app
