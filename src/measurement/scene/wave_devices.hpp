// Whether the device that images of waves will be made on holds them, before any image is traced.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "optics/instrument/instrument.hpp"
#include "vulkan/device.hpp"

#include <string>
#include <vector>

namespace vkfv::measurement {

// Sentences tell what does not fit on the device: where it has no room even for one part of a pixel, which of its
// limits forbids that; where it has room for fewer parts than the waves ask for, how many. cells: across the pupil;
// tiles: across the field. A configuration without waves has none.
std::vector<Warning> wave_warnings_of(const vulkan::DeviceReport& device, const Configuration& configuration,
                                      const optics::Instrument& instrument, int cells, int tiles);

// The same of the device of trace.device, the first of several. Without a driver or such a device there are none, and
// the device is not looked for where the images are so small that every device holds them.
std::vector<Warning> wave_warnings_of_device(const Configuration& configuration, int cells, int tiles);

// Throws InputError where light sorted for waves cannot lie in this machine's memory, when its processor traces in
// double.
void refuse_beyond_host(const optics::WaveOptions& options, const optics::Instrument& instrument);

} // namespace vkfv::measurement
