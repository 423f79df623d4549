// The image that waves make of light sorted by pupil cells, on a device: WaveImage in float.
#pragma once

#include "optics/waves/pupil_filter.hpp"
#include "trace/device/sorted_light.hpp"
#include "trace/device/wave_planes.hpp"
#include "trace/interface/wave_windows.hpp"
#include "vulkan/fourier_planes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::trace {

class DeviceWaveImage {
  public:
    // light: of the filter's cells, WaveImage::numbers_a_cell() each. Device, filter and light must outlive it.
    DeviceWaveImage(const vulkan::Device& device, const optics::PupilFilter& filter, ImageSize pixels,
                    const SortedLight& light);

    // Of the light as it is when the commands run.
    void record(vulkan::Commands& commands) const;
    // What they leave: of each pixel, in the units of the sorted light, bytes(pixels).
    const vulkan::Buffer& light_of_pixels() const { return result_; }
    static std::size_t bytes(ImageSize pixels) { return pixels.count() * sizeof(float); }

  private:
    void record(vulkan::Commands& commands, const WaveWindow& window) const;
    // The table of the window's filters, where there are several tiles.
    void put_table_together(vulkan::Commands& commands, const WaveWindow& window) const;
    void dispatch(vulkan::Commands& commands, const vulkan::Kernel& kernel, std::span<const vulkan::Binding> bindings,
                  std::span<const std::byte> push, std::size_t places) const;

    const SortedLight& light_;
    ImageSize pixels_;
    physics::f32::PupilCells cells_;
    ImageSize image_size_;                                  // in parts of pixels
    std::vector<WaveWindow> windows_;                       // of one size
    std::array<vulkan::SpecializationConstant, 1> filters_; // that are blended in each
    ImageSize size_;                                        // of a window, in parts of pixels
    WavePlanes sizes_;
    std::uint32_t steps_;
    std::uint32_t nodes_; // of the tables of all cells together
    float steps_a_column_;
    float steps_a_row_;
    vulkan::Buffer planes_;
    vulkan::Buffer tables_;               // of all tiles of the field
    std::optional<vulkan::Buffer> table_; // of the window's four filters, where there are any
    vulkan::Buffer spectrum_;
    vulkan::Buffer image_;
    vulkan::Buffer result_;
    vulkan::FourierPlanes forward_;
    vulkan::FourierPlanes inverse_;
    std::optional<vulkan::Kernel> put_together_; // makes table_
    vulkan::Kernel sort_;
    vulkan::Kernel filter_;
    vulkan::Kernel extend_;
    vulkan::Kernel add_up_;
};

} // namespace vkfv::trace
