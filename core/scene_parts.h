// The sections of a scene file, one item each: a JSON object read and checked into the plain data of core/scene.h.
#pragma once

#include "core/json_value.h"
#include "core/scene.h"
#include "core/scene_names.h"

namespace poinsot {

Body read_body(const JsonValue& item, BodyNames& bodies, int number);
Constraint read_constraint(const JsonValue& item, const BodyNames& bodies, ItemNames& names);
Joint read_joint(const JsonValue& item, const BodyNames& bodies, ItemNames& names);
Driver read_driver(const JsonValue& item, const BodyNames& bodies, ItemNames& names);
Force read_force(const JsonValue& item, const BodyNames& bodies, ItemNames& names);

}  // namespace poinsot
