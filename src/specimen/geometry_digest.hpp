// The digest of a specimen's surface.
#pragma once

#include "specimen/specimen.hpp"

#include <string>

namespace vkfv::specimen {

// The digest of the surface, vertex by vertex, and of the points of its reflectance. It brings the content of an STL,
// of a glTF with its buffers or of an image into the identity of a stack.
std::string geometry_digest(const Specimen& specimen);

} // namespace vkfv::specimen
