#include "measurement/scene/wave_devices.hpp"

#include "core/messages/error.hpp"
#include "core/threads/threads.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/scene/host_memory.hpp"
#include "trace/device/wave_memory.hpp"
#include "trace/interface/backward_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace vkfv::measurement {

namespace {

// Half of the storage buffer (bytes) that Vulkan requires of every device (maxStorageBufferRange, 128 MiB).
constexpr std::uint64_t every_device_holds = std::uint64_t{1} << 26;

// The options of each source's light. All sources have the same number of cells; the light of one source is sorted at a
// time.
std::vector<optics::WaveOptions> options_of_lights(const Configuration& configuration,
                                                   const optics::Instrument& instrument, int cells, int tiles) {
    std::vector<optics::WaveOptions> all;
    const std::size_t lights = instrument.lights().size();
    for (std::size_t k = 0; k < lights; ++k) {
        optics::WaveOptions options = configuration.trace.waves.value();
        options.cells = options.cells > 0 ? options.cells : cells;
        options.tiles = options.tiles > 0 ? options.tiles : tiles;
        options.sharers = static_cast<int>(lights);
        all.push_back(options);
    }
    return all;
}

trace::WaveSizes sizes_of(const optics::WaveOptions& options, const optics::Instrument& light) {
    return {.cells = options.cells,
            .parts = optics::parts_of(options, light),
            .tiles = options.tiles,
            .pixels = light.detector_pixels()};
}

std::optional<Warning> warning_of_host(const std::vector<optics::WaveOptions>& options,
                                       const optics::Instrument& instrument) {
    std::uint64_t memory = 0;
    for (std::size_t k = 0; k < options.size(); ++k) {
        memory += trace::wave_memory_of_host(sizes_of(options[k], *instrument.lights()[k]), core_count()).all();
    }
    const std::uint64_t there = memory_of_host();
    if (memory <= there) {
        return std::nullopt;
    }
    return Warning{.code = "memory",
                   .key = "detector.pixels",
                   .value = text_of(instrument.detector_pixels()),
                   .works = pixels_that_fit(instrument.detector_pixels(), memory, there),
                   .sentence =
                       fmt::format("Images as waves make them take {} of memory, and this machine has {}. Take fewer "
                                   "detector.pixels or fewer diffraction.cells, or a device that has as much.",
                                   bytes_text(memory), bytes_text(there))};
}

} // namespace

std::uint64_t counts_of_host(const trace::TraceOptions& options, ImageSize pixels) {
    const std::uint64_t counts = options.estimator == trace::Estimator::backward
                                     ? trace::backward_plan(options.rays, pixels).randomisations
                                     : static_cast<std::uint64_t>(core_count()) * (options.directed_scatter ? 2 : 1);
    constexpr std::uint64_t light_and_error = 2;
    return (counts + light_and_error) * pixels.count() * sizeof(std::uint64_t);
}

void refuse_beyond_host(const trace::TraceOptions& options, const optics::Instrument& instrument) {
    std::uint64_t memory = counts_of_host(options, instrument.detector_pixels());
    if (const auto& waves = options.waves) {
        constexpr int fewest_cells = 8; // the least number that is chosen where none is given
        const trace::WaveSizes least = {.cells = waves->cells > 0 ? waves->cells : fewest_cells,
                                        .parts = optics::parts_of(*waves, instrument),
                                        .tiles = 1,
                                        .pixels = instrument.detector_pixels()};
        memory += trace::wave_memory_of_host(least, 1).light;
    }
    if (const std::uint64_t there = memory_of_host(); memory > there) {
        throw InputError(
            {.where = {},
             .key = "detector.pixels",
             .found =
                 fmt::format("images {}that take {} of memory", options.waves ? "of waves " : "", bytes_text(memory)),
             .expected = fmt::format("at most {}, the memory of this machine", bytes_text(there)),
             .remedy = options.waves ? "Take fewer pixels, fewer diffraction.cells or diffraction.model = \"none\"."
                                     : "Take fewer pixels, or another device (trace.device)."});
    }
}

std::vector<Warning> wave_warnings_of(const vulkan::DeviceReport& device, const Configuration& configuration,
                                      const optics::Instrument& instrument, int cells, int tiles) {
    std::vector<Warning> warnings;
    if (!configuration.trace.waves || configuration.trace.nonsequential) {
        return warnings;
    }
    const auto lights = instrument.lights();
    const auto options = options_of_lights(configuration, instrument, cells, tiles);
    for (std::size_t k = 0; k < options.size(); ++k) {
        const int asked = optics::parts_of(options[k], *lights[k]);
        Warning warning{.code = "memory",
                        .key = "detector.pixels",
                        .value = text_of(lights[k]->detector_pixels()),
                        .works = "fewer, fewer diffraction.cells, or a device with more memory",
                        .sentence = {}};
        try {
            const int parts = trace::waves_on_device(options[k], *lights[k], device).parts;
            if (parts == asked) {
                continue;
            }
            warning.sentence =
                fmt::format("{} has room for light of waves sorted in {} parts of a pixel's side, where {} are "
                            "asked for: finer waves fold back.",
                            device.name, parts, asked);
        } catch (const InputError& error) {
            const InputProblem& problem = error.problem();
            warning.sentence = fmt::format("{} cannot make images as waves make them: {}, where {} are possible. {}",
                                           device.name, problem.found, problem.expected, problem.remedy);
        }
        if (std::ranges::find(warnings, warning) == warnings.end()) {
            warnings.push_back(warning);
        }
    }
    return warnings;
}

std::vector<Warning> wave_warnings_of_device(const Configuration& configuration, int cells, int tiles) {
    if (!configuration.trace.waves || configuration.trace.nonsequential) {
        return {};
    }
    const auto instrument = assemble_for_figures(configuration);
    const auto options = options_of_lights(configuration, instrument, cells, tiles);
    std::uint64_t memory = 0;
    for (std::size_t k = 0; k < options.size(); ++k) {
        memory += trace::wave_memory(sizes_of(options[k], *instrument.lights()[k])).all();
    }
    if (memory <= every_device_holds && options.front().most_memory == 0) {
        return {};
    }
    if (configuration.trace.device == "host") {
        const auto warning = warning_of_host(options, instrument);
        return warning ? std::vector{*warning} : std::vector<Warning>();
    }
    try {
        const auto reports = vulkan::list_devices();
        const auto chosen = vulkan::choose_devices(reports, configuration.trace.device);
        return wave_warnings_of(reports[chosen.front()], configuration, instrument, cells, tiles);
    } catch (const DeviceError&) { // the configuration's images are not made on this machine
        return {};
    }
}

} // namespace vkfv::measurement
