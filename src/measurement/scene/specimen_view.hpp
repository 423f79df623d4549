// The part of the specimen that the detector sees, and warnings where it is small or sends little light.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace vkfv::measurement {

// Lowest and highest point of the specimen in the field of view (mm), and the share of the field that it fills.
struct Relief {
    double lowest = INFINITY;
    double highest = -INFINITY;
    double seen_share = 0;
};

// pixels: of the detector, whose middle sees the axis. pitch: of the pixels in the object plane, mm.
Relief relief_of(const specimen::Specimen& specimen, ImageSize pixels, double pitch);

// A warning where the specimen fills less than half of the field.
std::vector<Warning> warning_of_sparse_field(const specimen::Specimen& specimen, const Relief& relief);

// A warning where no light was detected, or less than the numbers of an image can hold, or where nearly all light that
// came as far fell beside the specimen. It says where the light went and what may have caused that.
std::vector<Warning> warning_of_lost_light(const Configuration& configuration, const optics::Instrument& instrument,
                                           const trace::Image& image);

// A warning for images in which none of this number of rays was detected. If the configuration proves that no light can
// arrive, it says so; otherwise it says what share of the light may arrive. With p the share of the rays that arrive,
// none of N rays does with a probability (1 - p)^N, which is 5 % at the bound (Clopper and Pearson, Biometrika 26, 404
// (1934), one-sided). Backward paths carry no shares of the flux, and have no bound. where: a sentence with a space
// before it, or nothing.
std::vector<Warning> warning_of_no_light(const Configuration& configuration, const optics::Instrument& instrument,
                                         std::uint64_t rays, const std::string& where = {});

} // namespace vkfv::measurement
