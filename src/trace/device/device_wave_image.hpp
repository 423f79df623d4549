// The wave image of light sorted by pupil cells, made on a device: WaveImage in float.
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
    // light: WaveImage::numbers_a_cell() numbers for each of the filter's cells. Device, filter and light must outlive
    // it.
    DeviceWaveImage(const vulkan::Device& device, const optics::PupilFilter& filter, ImageSize pixels,
                    const SortedLight& light);

    // Records the making of the image from the light as it is when the commands run.
    void record(vulkan::Commands& commands) const;
    // The image that the commands leave: float for each pixel, in the units of the sorted light; its size is
    // bytes(pixels).
    const vulkan::Buffer& light_of_pixels() const { return result_; }
    static std::size_t bytes(ImageSize pixels) { return pixels.count() * sizeof(float); }

  private:
    void record(vulkan::Commands& commands, const WaveWindow& window) const;
    // Gathers the tables of the window's filters, where there are several tiles.
    void put_table_together(vulkan::Commands& commands, const WaveWindow& window) const;
    void dispatch(vulkan::Commands& commands, const vulkan::Kernel& kernel, std::span<const vulkan::Binding> bindings,
                  std::span<const std::byte> push, std::size_t places) const;

    const SortedLight& light_;
    ImageSize pixels_;
    physics::f32::PupilCells cells_;
    ImageSize image_size_;                                  // parts of pixels
    std::vector<WaveWindow> windows_;                       // all of one size
    std::array<vulkan::SpecializationConstant, 1> filters_; // number of filters blended in a window
    ImageSize size_;                                        // size of a window, parts of pixels
    WavePlanes sizes_;
    std::uint32_t steps_;
    std::uint32_t nodes_; // number of nodes of all cells' tables together
    float steps_a_column_;
    float steps_a_row_;
    vulkan::Buffer planes_;
    vulkan::Buffer tables_;               // tables of all tiles of the field
    std::optional<vulkan::Buffer> table_; // table of a window's four filters, if there are four
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
