// The settings of a study's cases: what stands in "settings", with every combination of those in "vary".
#pragma once

#include <string>
#include <vector>

#include "bench/cases/study_file.h"
#include "core/json_value.h"

namespace poinsot::cases {

// Each choice so far with each value of what `item`, of "vary", says. Throws InputError with file and key path.
void vary_setting(Study& study, const JsonValue& item);
// Once all are there: those that no run can have are told by their cases, unless all are such; then InputError.
void settle_settings(Study& study, const JsonValue& root);
// Sentences about what stands in the file and none of the cases looks at.
std::vector<std::string> ignored_settings(const Study& study, const JsonValue& root);

}  // namespace poinsot::cases
