// Where the things stand that messages speak of: names beside key paths, key paths beside names, and lines of the file.
//
//   what cannot be read     "FILE: /joints/17/axis: found the zero vector, expected a direction (joint 'upper arm',
//   line 212)" what comes up later     "... violates joint 'upper arm' (/joints/17, line 212) by 0.242 m"
//
// Nothing is kept for it while all goes well: the text is gone through once more, line by line, when there is something
// to say.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/scene.h"

namespace poinsot {

// Does what may throw an ElementError about the document with this text; the error comes out with name and line.
void with_lines_of_errors(std::string_view text, const std::function<void()>& read);

// Likewise about a scene that is in no file: the error comes out with the name.
void with_names_of_errors(const Scene& scene, const std::function<void()>& check);

// The message with the key path of each body, constraint, joint, driver and force of the scene that it names, where it
// names it first; what has no name of its own is known by its type and number, as in core/model.h.
std::string with_key_paths(std::string_view message, const Scene& scene);
// The message with the line of each of these key paths in the text of the scene's file.
std::string with_lines(std::string_view message, std::string_view text);

}  // namespace poinsot
