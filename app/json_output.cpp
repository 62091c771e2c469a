#include "app/json_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace poinsot::app {

void add_json(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "say it as JSON");
}

void print_json(std::FILE* out, const nlohmann::ordered_json& json) {
  fmt::print(out, "{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace poinsot::app
