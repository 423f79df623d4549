// What of the specimen the detector sees, and what is likely wrong where that is little.
#pragma once

#include "configuration/configuration.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace vkfv::measurement {

// Lowest and highest point of the specimen in the field of view (mm), and the share of the field that it fills.
struct Relief {
    double lowest = INFINITY;
    double highest = -INFINITY;
    double seen_share = 0;
};

// pixels: of the detector, whose middle sees the axis; pitch: of the pixels in the object plane, mm.
Relief relief_of(const specimen::Specimen& specimen, ImageSize pixels, double pitch);

// A sentence where the specimen fills less than half of the field.
std::vector<std::string> warning_of_sparse_field(const specimen::Specimen& specimen, const Relief& relief);

// A sentence where no light was detected, or less than the numbers of an image hold, or where nearly all that came as
// far fell beside the specimen: where it went, and what that may come from.
std::vector<std::string> warning_of_lost_light(const trace::Image& image);

} // namespace vkfv::measurement
