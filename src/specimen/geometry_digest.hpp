// A specimen's surface in one word.
#pragma once

#include "specimen/specimen.hpp"

#include <string>

namespace vkfv::specimen {

// The surface as it was made, vertex by vertex, and the points of its reflectance: what an STL, a glTF with its buffers
// or an image contributes to the identity of a stack.
std::string geometry_digest(const Specimen& specimen);

} // namespace vkfv::specimen
