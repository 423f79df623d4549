// Light of several exposures together.
#pragma once

#include "trace/interface/tracer.hpp"

namespace vkfv::trace {

// Adds an exposure of the same pixels, independent of the first, that was made after it. Ledger entries of one name
// become one; what only the part has stands at the end.
void add(Image& sum, const Image& part);

} // namespace vkfv::trace
