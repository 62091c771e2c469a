// The rules that a scene has to keep, whoever built it: core/scene_reader.h holds files to them, compile() in
// core/model.h every scene, so that whatever takes a Scene takes a sound one.
//
//   numbers      finite; masses positive, inertias symmetric and positive semidefinite, driven
//                lengths positive, unloaded ones not negative
//   orientations a rotation, to within kOrientationTolerance in every entry
//   directions   not zero, of any length; the two axes of a universal joint perpendicular, and a_i and a_j to axes
//   joints       global at the initial pose or in the bodies' frames, not both
//   bodies       at least one; two different ones in whatever acts between two; a force acts on one that can move
//   names        without control characters, in UTF-8; bodies have one, of its own and not "ground"; constraints,
//                joints and drivers differ in theirs, and so do forces
//
// Matters of motion (whether the initial pose fits, which rows follow from others, kinematics with free motion) are not
// among them: those are found by integrators/start.
#pragma once

#include <vector>

#include "core/scene.h"

namespace poinsot {

// Throws ElementError that begins with the place as a path in a scene file: "/bodies/2/mass: found -1, expected a
// positive number". Linear in the scene, a fraction of what compile() takes.
void validate(const Scene& scene);
// The part of it that is about bodies alone (body_validation.cpp): before anything refers to them by name.
void validate_bodies(const std::vector<Body>& bodies);

}  // namespace poinsot
