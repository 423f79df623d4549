// The sum of the light of several exposures.
#pragma once

#include "trace/interface/tracer.hpp"

namespace vkfv::trace {

// Adds an exposure of the same pixels, independent of the first, that was made after it. Ledger entries with the same
// name are added; entries that only the part has are appended.
void add(Image& sum, const Image& part);

} // namespace vkfv::trace
