#include "trace/device_estimate.hpp"

#include "core/parallel_rows.hpp"
#include "spirv/estimate_light.h"
#include "trace/wave_image.hpp"

#include <algorithm>
#include <utility>

namespace vkfv::trace {

namespace {

// Of values that a device left for the host.
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
                               const Counted& counted, const SceneWaves* waves, double waves_scale, By by)
    : device_(device), rule_(rule), pixels_(pixels), counted_(counted), waves_(waves), waves_scale_(waves_scale) {
    if (by == By::device && device.report().doubles) {
        estimates_.emplace(device, (has_waves_there() ? 3 : 2) * plane_bytes());
        kernel_.emplace(device, "estimate_light", estimate_light, std::vector<vulkan::BindingDeclaration>(),
                        static_cast<std::uint32_t>(sizeof(estimate::EstimatedPixels)));
    }
}

void DeviceEstimate::record(vulkan::Commands& commands, std::size_t slot) const {
    auto& for_host = for_host_.at(slot);
    if (!for_host) {
        const std::size_t waves = has_waves_there() ? DeviceWaveImage::bytes(pixels_) : 0;
        const std::size_t bytes = estimates_ ? estimates_->bytes() : counted_.pixels.bytes() + waves;
        for_host.emplace(device_, further_bytes() + bytes, vulkan::Buffer::Memory::host);
    }
    if (counted_.further != nullptr) {
        commands.copy(*counted_.further, *for_host, further_bytes());
    }
    if (estimates_) {
        record_estimates(commands, *for_host);
    } else {
        record_numbers(commands, *for_host);
    }
    commands.barrier();
}

void DeviceEstimate::record_estimates(vulkan::Commands& commands, const vulkan::Buffer& for_host) const {
    const estimate::EstimatedPixels push{.rule = rule_,
                                         .waves_scale = waves_scale_,
                                         .waves_noise = has_waves_there() ? waves_->filter().noise() : 1,
                                         .numbers = counted_.pixels.address(),
                                         .waves = has_waves_there() ? waves_->light_there().address() : 0,
                                         .estimates = estimates_->address(),
                                         .pixels = static_cast<std::uint32_t>(pixels_.count()),
                                         .stride = static_cast<std::uint32_t>(counted_.stride)};
    const auto groups = vulkan::groups_of(pixels_.count(), workgroup);
    commands.dispatch(*kernel_, {}, push, groups.x, groups.y);
    commands.barrier();
    commands.copy(*estimates_, for_host, estimates_->bytes(), 0, further_bytes());
}

void DeviceEstimate::record_numbers(vulkan::Commands& commands, const vulkan::Buffer& for_host) const {
    const vulkan::Buffer& numbers = counted_.pixels;
    commands.copy(numbers, for_host, numbers.bytes(), 0, further_bytes());
    if (has_waves_there()) {
        const vulkan::Buffer& waves = waves_->light_there();
        commands.copy(waves, for_host, waves.bytes(), 0, further_bytes() + numbers.bytes());
    }
}

std::span<const std::uint64_t> DeviceEstimate::further(std::size_t slot) const {
    return for_host_.at(slot).value().values<std::uint64_t>(further_bytes() / sizeof(std::uint64_t));
}

PixelLight DeviceEstimate::by_rays(const vulkan::Buffer& for_host) const {
    const std::size_t count = counted_.pixels.bytes() / sizeof(std::uint64_t);
    return estimate_pixels(rule_, pixels_, for_host.values<std::uint64_t>(count, further_bytes()), counted_.stride);
}

PixelLight DeviceEstimate::light(std::size_t slot) const {
    const vulkan::Buffer& for_host = for_host_.at(slot).value();
    const bool made_there = estimates_ && has_waves_there();
    PixelLight light;
    if (estimates_) {
        const std::size_t flux = further_bytes() + (made_there ? 2 * plane_bytes() : 0);
        light = {grid_of<double>(for_host, flux, pixels_),
                 grid_of<double>(for_host, further_bytes() + plane_bytes(), pixels_)};
    } else {
        light = by_rays(for_host);
    }
    if (waves_ == nullptr || made_there) {
        return light;
    }
    const Grid<double> waves = has_waves_there()
                                   ? grid_of<float>(for_host, further_bytes() + counted_.pixels.bytes(), pixels_)
                                   : waves_->light_by_host();
    return with_waves(std::move(light), waves, waves_scale_, waves_->filter());
}

double DeviceEstimate::power(std::size_t slot) const {
    const vulkan::Buffer& for_host = for_host_.at(slot).value();
    return estimates_ ? sum_of(for_host.values<double>(pixels_.count(), further_bytes()))
                      : sum_of(by_rays(for_host).flux.values);
}

} // namespace vkfv::trace
