// The sections of a scene file, one item each: a JSON object read into the plain data of core/scene.h. What is checked
// here is the form; whether it makes sense is for validate().
#pragma once

#include "core/json_value.h"
#include "core/scene.h"
#include "core/scene_names.h"

namespace poinsot {

Body read_body(const JsonValue& item);
Constraint read_constraint(const JsonValue& item, const BodyNames& bodies);
Joint read_joint(const JsonValue& item, const BodyNames& bodies);
Driver read_driver(const JsonValue& item, const BodyNames& bodies);
Force read_force(const JsonValue& item, const BodyNames& bodies);

}  // namespace poinsot
