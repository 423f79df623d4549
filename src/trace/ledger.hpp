// From counts of fates to the ledger of an image.
#pragma once

#include "optics/instrument.hpp"
#include "trace/tracer.hpp"

#include <cstdint>
#include <span>

namespace vkfv::trace {

// Slots of physics::ledger_slot() for this instrument.
std::size_t ledger_slot_count(const optics::Instrument& instrument);

// Power that one launched ray carries at the detector: flux * aimed share * splitter's two passes / rays; W.
double detected_power_per_ray(const optics::Instrument& instrument, std::uint64_t rays);

// counts[slot]: rays of each fate. What was not aimed at and what the ideal splitter turns away is added
// analytically, so the ledger closes exactly when every launched ray has one fate.
Ledger make_ledger(const optics::Instrument& instrument, std::span<const std::uint64_t> counts, std::uint64_t rays);

// Image in W from counts per pixel, with the binomial standard error of each.
Image make_image(const optics::Instrument& instrument, std::span<const std::uint64_t> pixel_counts,
                 std::span<const std::uint64_t> ledger_counts, std::uint64_t rays);

} // namespace vkfv::trace
