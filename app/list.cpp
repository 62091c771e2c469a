#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "formulations/registry.h"
#include "integrators/integrator.h"
#include "integrators/jacobian_policy.h"
#include "integrators/settings_reader.h"
#include "integrators/stopping_test.h"
#include "linsolve/registry.h"

namespace poinsot::app {
namespace {
using Json = nlohmann::ordered_json;

struct ListOptions {
  bool json = false, quiet = false;
};

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

template <class Table>
Json listed(const Table& table) {
  Json list = Json::array();
  for (const auto& entry : table) {
    Json& one = list.emplace_back(Json{{"name", entry.name}, {"about", entry.about}});
    if constexpr (requires { entry.controls_error; }) {
      one["analysis"] = find_setting("analysis")->names()[static_cast<std::size_t>(entry.analysis)];
      one["order"] = entry.order;
      one["controls_error"] = entry.controls_error;
      one["parameters"] = one["refuses"] = Json::array();
      for (const MethodParameter& p : entry.parameters)
        one["parameters"].push_back(
            {{"name", p.name}, {"about", p.about}, {"default", p.by_default}, {"least", p.least}, {"most", p.most}});
      for (const FormulationEntry& formulation : formulations())
        if (const auto refusal = refusal_of(entry, formulation.name))
          one["refuses"].push_back({{"formulation", refusal->formulation}, {"why", refusal->why}});
    }
  }
  return list;
}

void print_lists() {
  print_table("formulations", formulations());
  print_table("integrators", integrators());
  print_table("linear solvers", linear_solvers());
  print_table("linear systems", linear_systems());
  print_table("jacobians", jacobians());
  print_table("stopping tests", stopping_tests());
}

Json lists() {
  return {{"formulations", listed(formulations())},     {"integrators", listed(integrators())},
          {"linear_solvers", listed(linear_solvers())}, {"linear_systems", listed(linear_systems())},
          {"jacobians", listed(jacobians())},           {"stopping_tests", listed(stopping_tests())}};
}

int list(const ListOptions& options) {
  if (options.json)
    print_json(stdout, lists());
  else if (!options.quiet)
    print_lists();
  return kDone;
}

}  // namespace

void add_list(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "list", "formulations, integrators, linear solvers and Newton matrices there are", list);
  add_json(command, options.json);
  add_quiet(command, options.quiet);
}

}  // namespace poinsot::app
