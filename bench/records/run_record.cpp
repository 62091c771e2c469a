#include "bench/records/run_record.h"

#include <nlohmann/json.hpp>

#include "core/provenance.h"

namespace poinsot::records {
namespace {

nlohmann::ordered_json packed(const study::Verification& verification) {
  nlohmann::ordered_json json;
  json["against"] = verification.against;
  json["failure"] = verification.failure;
  json["times"] = verification.times;
  json["quantities"] = nlohmann::ordered_json::array();
  for (const auto& q : verification.quantities) {
    json["quantities"].push_back(
        {{"quantity", q.name}, {"unit", q.unit}, {"apart", q.apart}, {"where", q.where}, {"t", q.t}});
    if (q.order) json["quantities"].back()["order"] = *q.order;
    if (q.order_unseen) json["quantities"].back()["order"] = nullptr;
    if (q.error) json["quantities"].back()["error"] = *q.error;
  }
  return json;
}

}  // namespace

void add_origin(nlohmann::ordered_json& json) {
  const Provenance& origin = provenance();
  nlohmann::ordered_json libraries;
  for (const Library& library : origin.libraries) libraries[library.name] = library.version;
  json["program"] = {{"name", "poinsot"},
                     {"version", origin.version},
                     {"commit", origin.commit},
                     {"dirty", origin.dirty},
                     {"compiler", origin.compiler},
                     {"flags", origin.flags},
                     {"build_type", origin.build_type},
                     {"libraries", libraries}};
  json["processor"] = processor();
}

std::string to_json(const RunRecord& record) {
  using Json = nlohmann::ordered_json;
  const Status& status = record.outcome.status;
  const Statistics& s = record.outcome.statistics;

  Json json;
  json["status"] = record.running ? "running" : name(status.failure);
  json["incomplete"] = record.running || !status.ok();
  json["message"] = record.running ? "the run goes on, or was killed; the files hold what it computed" : status.message;
  if (!status.ok()) json["failure_time"] = status.time;
  json["notices"] = record.outcome.notices;
  json["accuracy"] = record.accuracy;
  if (record.verification) json["verify"] = packed(*record.verification);
  json["reactions_undetermined"] = !record.outcome.undetermined_reactions.empty();
  json["undetermined_reactions"] = record.outcome.undetermined_reactions;
  json["undetermined_components"] = Json::object();
  for (std::size_t k = 0; k < record.outcome.undetermined_reactions.size(); ++k)
    json["undetermined_components"][record.outcome.undetermined_reactions[k]] =
        record.outcome.undetermined_components[k];
  auto linear = nlohmann::ordered_json::array();
  for (const LinearWork& w : s.linear) {
    linear.push_back({{"solver", w.solver},
                      {"system", w.system},
                      {"factorizations", w.factorizations},
                      {"refactorizations", w.refactorizations},
                      {"solves", w.solves},
                      {"refinements", w.refinements}});
    if (!w.handed_over_by.empty()) linear.back()["handed_over_by"] = w.handed_over_by;
    if (w.reciprocal_condition > 0) linear.back()["condition"] = 1 / w.reciprocal_condition;
  }
  auto methods = nlohmann::ordered_json::array();
  for (const MethodWork& w : s.methods)
    methods.push_back({{"integrator", w.integrator}, {"from", w.from}, {"to", w.to}, {"steps", w.steps}});
  json["statistics"] = {{"linear", linear},
                        {"methods", methods},
                        {"steps", s.steps},
                        {"rejected_steps", s.rejected_steps},
                        {"divided_steps", s.divided_steps},
                        {"newton_iterations", s.newton_iterations},
                        {"convergence_rate", s.convergence.rate()},
                        {"jacobian_evaluations", s.jacobian_evaluations},
                        {"factorizations", s.factorizations},
                        {"solves", s.solves},
                        {"seconds",
                         {{"total", s.seconds.total},
                          {"assembly", s.seconds.assembly},
                          {"factor", s.seconds.factor},
                          {"solve", s.seconds.solve},
                          {"other", s.seconds.other}}},
                        {"largest_rotation", s.largest_rotation},
                        {"violation", {{"position", s.violation.position}, {"velocity", s.violation.velocity}}}};
  for (const auto& [option, names] : record.columns) json["columns"][option] = names;
  if (s.acceleration_error)
    json["statistics"]["acceleration_error"] = {{"index", s.acceleration_error->index},
                                                {"acceleration", s.acceleration_error->acceleration},
                                                {"multiplier", s.acceleration_error->multiplier}};
  if (s.energy_change) json["statistics"]["energy_change"] = *s.energy_change;
  add_origin(json);
  json["configuration"] = Json::parse(record.configuration);
  if (!record.scene.parameters.empty()) {
    Json values, set = Json::array();
    for (const Parameter& parameter : record.scene.parameters) {
      values[parameter.name] = parameter.value;
      if (parameter.set) set.push_back(parameter.name);
    }
    json["parameters"] = {{"values", values}, {"set", set}};
  }
  json["scene_file"] = record.scene_file.string();
  json["scene"] = Json::parse(record.scene.source, nullptr, true, true);
  // A message may quote bytes of a file that are not UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace poinsot::records
