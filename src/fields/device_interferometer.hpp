// The interferometer on a Vulkan device.
#pragma once

#include "fields/interferometer.hpp"
#include "vulkan/opened_device.hpp"

#include <memory>

namespace vkfv::fields {

// Where fields are made: by the device and VkFFT, or by the host, which is faster where the device is the host's cores.
enum class FieldsBy { device, host, automatic };

// As make_host_interferometer(), in single precision. Groups of exposures that are under way together are made by one
// dispatch, to the same bits as alone. Throws DeviceError, RunError.
std::unique_ptr<trace::Tracer> make_device_interferometer(const vulkan::OpenedDevice& opened,
                                                          const optics::Instrument& instrument,
                                                          const optics::InstrumentDescription& description,
                                                          const specimen::Specimen& specimen, const ReferenceArm& arm,
                                                          FocalRange range, FieldsBy by = FieldsBy::automatic);

} // namespace vkfv::fields
