#include "trace/device/scene_waves.hpp"

#include "trace/interface/wave_image.hpp"

#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

namespace vkfv::trace {

SceneWaves::SceneWaves(const vulkan::Device& device, optics::PupilFilter filter, ImageSize pixels, MadeBy by)
    : filter_(std::move(filter)), pixels_(pixels),
      light_(device, static_cast<std::size_t>(filter_.cell_count()), WaveImage(filter_, pixels).numbers_a_cell()) {
    if (by == MadeBy::device) {
        on_device_ = std::async(std::launch::async, [&device, this] {
                         return std::make_unique<const DeviceWaveImage>(device, filter_, pixels_, light_);
                     }).share();
    }
    noise_ = std::async(std::launch::async, [its_filter = filter_] { return its_filter.noise(); });
}

SceneWaves::~SceneWaves() = default; // the members' destructors wait for the threads

void SceneWaves::clear(vulkan::Commands& commands) const {
    light_.clear(commands);
}

void SceneWaves::require() const {
    if (on_device() && on_device_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
        on_device_.get();
    }
}

void SceneWaves::make_image(ExposureWork& work) const {
    const DeviceWaveImage& image = *on_device_.get();
    vulkan::Commands& commands = work.open();
    image.record(commands);
    work.submit();
}

Grid<double> SceneWaves::light_by_host() const {
    const WaveImage image(filter_, pixels_);
    const auto columns = static_cast<std::size_t>(image.columns());
    return image.apply([&](int cell, int first_row, int rows) {
        std::vector<std::uint64_t> numbers(static_cast<std::size_t>(rows) * columns);
        light_.read(static_cast<std::size_t>(cell), static_cast<std::size_t>(first_row) * columns, numbers);
        return numbers;
    });
}

} // namespace vkfv::trace
