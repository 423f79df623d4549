#include "trace/device/device_estimate.hpp"

#include "core/threads/parallel_rows.hpp"
#include "spirv/estimate_light.h"
#include "trace/interface/wave_image.hpp"

#include <algorithm>
#include <utility>

namespace vkfv::trace {

namespace {

// A grid of the values that a device has left in a buffer for the host.
template <class Value>
Grid<double> grid_of(const vulkan::Buffer& for_host, std::size_t from_byte, ImageSize pixels) {
    Grid<double> grid(pixels.columns, pixels.rows);
    const auto values = for_host.values<Value>(pixels.count(), from_byte);
    parallel_rows(pixels.columns, pixels.rows, [&](int first_row, int end_row) {
        const std::size_t first = grid.index(0, first_row);
        const std::size_t count = grid.index(0, end_row) - first;
        std::ranges::copy(values.subspan(first, count), grid.values.begin() + static_cast<std::ptrdiff_t>(first));
    });
    return grid;
}

} // namespace

DeviceEstimate::DeviceEstimate(const vulkan::Device& device, const estimate::EstimateRule& rule, ImageSize pixels,
                               const Counted& counted, MadeBy by)
    : device_(device), rule_(rule), pixels_(pixels), counted_(counted) {
    if (by == MadeBy::device && device.report().doubles) {
        kernel_.emplace(device, "estimate_light", estimate_light, std::vector<vulkan::BindingDeclaration>(),
                        static_cast<std::uint32_t>(sizeof(estimate::EstimatedPixels)));
    }
}

void DeviceEstimate::make_room(std::size_t slot) const {
    auto& for_host = for_host_.at(slot);
    if (!for_host) {
        const std::size_t waves = has_waves_there() ? DeviceWaveImage::bytes(pixels_) : 0;
        const std::size_t bytes =
            made_there() ? plane_byte(has_rays_beside() ? 3 : 2) : further_bytes() + counted_.pixels.bytes() + waves;
        for_host.emplace(device_, bytes, vulkan::Buffer::Memory::host);
    }
}

void DeviceEstimate::record(vulkan::Commands& commands, std::size_t slot) const {
    make_room(slot);
    const vulkan::Buffer& for_host = for_host_.at(slot).value();
    if (counted_.further != nullptr) {
        commands.copy(*counted_.further, for_host, further_bytes());
    }
    if (made_there()) {
        record_kernel(commands, for_host);
    } else {
        record_copies(commands, for_host);
    }
    commands.barrier();
}

// The kernel writes its estimates into the buffer that the host reads.
void DeviceEstimate::record_kernel(vulkan::Commands& commands, const vulkan::Buffer& for_host) const {
    const auto* waves = has_waves_there() ? counted_.waves : nullptr;
    const estimate::EstimatedPixels push{.rule = rule_,
                                         .waves_scale = counted_.waves_scale,
                                         .waves_noise = waves != nullptr ? waves->filter().noise() : 1,
                                         .numbers = counted_.pixels.address(),
                                         .waves = waves != nullptr ? waves->light_there().address() : 0,
                                         .estimates = for_host.address() + plane_byte(0),
                                         .pixels = static_cast<std::uint32_t>(pixels_.count()),
                                         .stride = static_cast<std::uint32_t>(counted_.stride),
                                         .by_rays = has_rays_beside() ? 1u : 0u};
    const auto groups = vulkan::groups_of(pixels_.count(), estimate::ESTIMATE_WORKGROUP);
    commands.dispatch(*kernel_, {}, push, groups.x, groups.y);
}

void DeviceEstimate::record_copies(vulkan::Commands& commands, const vulkan::Buffer& for_host) const {
    const vulkan::Buffer& numbers = counted_.pixels;
    commands.copy(numbers, for_host, numbers.bytes(), 0, further_bytes());
    if (has_waves_there()) {
        const vulkan::Buffer& waves = counted_.waves->light_there();
        commands.copy(waves, for_host, waves.bytes(), 0, further_bytes() + numbers.bytes());
    }
}

std::span<const std::uint64_t> DeviceEstimate::further(std::size_t slot) const {
    return for_host_.at(slot).value().values<std::uint64_t>(further_bytes() / sizeof(std::uint64_t));
}

DeviceEstimate::Estimated DeviceEstimate::estimated(std::size_t slot) const {
    const vulkan::Buffer& for_host = for_host_.at(slot).value();
    const std::size_t numbers_end = further_bytes() + counted_.pixels.bytes();
    Estimated result;
    if (made_there()) {
        result.pixels = {.flux = grid_of<double>(for_host, plane_byte(1), pixels_),
                         .standard_error = grid_of<double>(for_host, plane_byte(0), pixels_)};
    } else {
        const std::size_t count = counted_.pixels.bytes() / sizeof(std::uint64_t);
        result.pixels =
            estimate_pixels(rule_, pixels_, for_host.values<std::uint64_t>(count, further_bytes()), counted_.stride);
    }
    if (counted_.asks_for_power) {
        const bool beside = made_there() && has_rays_beside();
        result.power = sum_of(beside ? for_host.values<double>(pixels_.count(), plane_byte(2))
                                     : std::span<const double>(result.pixels.flux.values));
    }
    if (counted_.waves != nullptr && !(made_there() && has_waves_there())) {
        const Grid<double> light =
            has_waves_there() ? grid_of<float>(for_host, numbers_end, pixels_) : counted_.waves->light_by_host();
        result.pixels = with_waves(std::move(result.pixels), light, counted_.waves_scale, counted_.waves->filter());
    }
    return result;
}

} // namespace vkfv::trace
