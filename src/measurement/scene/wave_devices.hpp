// A check, before any image is traced, that the device for images of waves has the memory for them.
#pragma once

#include "configuration/configuration.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "core/messages/warning.hpp"
#include "optics/instrument/instrument.hpp"
#include "vulkan/device.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vkfv::measurement {

// Warnings about images of waves that do not fit on the device. Where it has no room even for one part of a pixel, the
// warning names the limit that forbids it; where it has room for fewer parts than the waves ask for, it tells how many.
// cells: across the pupil; tiles: across the field. A configuration without waves has no warnings.
std::vector<Warning> wave_warnings_of(const vulkan::DeviceReport& device, const Configuration& configuration,
                                      const optics::Instrument& instrument, int cells, int tiles);

// Warnings for the device of trace.device, the first if there are several. There are none without a driver or such a
// device. The device is not looked for where the images are so small that every device holds them.
std::vector<Warning> wave_warnings_of_device(const Configuration& configuration, int cells, int tiles);

// The memory (bytes) of an image that this machine's processors trace in double: a count a pixel for each of them, or
// for each randomisation backward. Light sorted for waves comes on top.
std::uint64_t counts_of_host(const trace::TraceOptions& options, ImageSize pixels);

// Throws InputError where an image that this machine's processors trace in double, and light sorted for waves, exceed
// its memory: the system would end the program without a word.
void refuse_beyond_host(const trace::TraceOptions& options, const optics::Instrument& instrument);

} // namespace vkfv::measurement
