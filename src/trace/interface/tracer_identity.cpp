#include "trace/interface/tracer_identity.hpp"

#include "core/files/digest.hpp"
#include "core/toml/toml_reader.hpp"
#include "trace/interface/device_records.hpp"
#include "trace/interface/lattice_generators.hpp"
#include "vulkan/device.hpp"
#include "vulkan/fourier_planes.hpp"

#include "spirv/digest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace vkfv::trace {

LightSorting LightSorting::of(const std::optional<optics::PupilFilter>& filter) {
    return filter ? LightSorting{.pupil_cells = static_cast<int>(filter->cells().side),
                                 .parts_per_pixel = static_cast<int>(filter->cells().parts),
                                 .field_tiles = filter->tiles().across()}
                  : LightSorting();
}

LightSorting LightSorting::of(const optics::WaveOptions& options) {
    return {.pupil_cells = options.cells, .parts_per_pixel = options.parts, .field_tiles = options.tiles};
}

std::string TracerIdentity::toml() const {
    std::string text = fmt::format("device = {}\n", toml_quoted(device));
    if (vendor_id != 0) {
        text += fmt::format("vendor_id = 0x{:04x}\ndevice_id = 0x{:04x}\n", vendor_id, device_id);
    }
    if (!driver.empty()) {
        text += fmt::format("driver = {}\n", toml_quoted(driver));
    }
    if (!traversal.empty()) {
        text += fmt::format("traversal = {}\n", toml_quoted(traversal));
    }
    if (!fourier.empty()) {
        text += fmt::format("fourier = {}\n", toml_quoted(fourier));
    }
    if (sorting.pupil_cells != 0) {
        text += fmt::format("pupil_cells = {}\nparts_per_pixel = {}\n", sorting.pupil_cells, sorting.parts_per_pixel);
    }
    if (sorting.field_tiles > 1) {
        text += fmt::format("field_tiles = {}\n", sorting.field_tiles);
    }
    if (!further_sortings.empty()) {
        std::vector<int> cells, parts, tiles;
        for (const LightSorting& further : further_sortings) {
            cells.push_back(further.pupil_cells);
            parts.push_back(further.parts_per_pixel);
            tiles.push_back(further.field_tiles);
        }
        text += fmt::format("further_pupil_cells = [{}]\nfurther_parts_per_pixel = [{}]\n", fmt::join(cells, ", "),
                            fmt::join(parts, ", "));
        if (std::ranges::any_of(tiles, [](int across) { return across > 1; })) {
            text += fmt::format("further_field_tiles = [{}]\n", fmt::join(tiles, ", "));
        }
    }
    return text +
           fmt::format("kernels_digest = {}\ninstrument_digest = {}\n", toml_quoted(kernels), toml_quoted(instrument));
}

TracerIdentity TracerIdentity::parse(const TomlTable& table) {
    const auto text = [&](const char* key) { return table.optional_string(key).value_or(""); };
    const auto number = [&](const char* key, std::int64_t otherwise = 0) {
        return table.optional_integer(key, 0, std::numeric_limits<std::uint32_t>::max()).value_or(otherwise);
    };
    const auto numbers = [&](const char* key) { return table.optional_numbers(key).value_or(std::vector<double>()); };
    const auto cells = numbers("further_pupil_cells"), parts = numbers("further_parts_per_pixel");
    auto tiles = numbers("further_field_tiles");
    tiles.resize(cells.size(), 1);
    std::vector<LightSorting> further;
    for (std::size_t k = 0; k < std::min(cells.size(), parts.size()); ++k) {
        further.push_back({.pupil_cells = static_cast<int>(cells[k]),
                           .parts_per_pixel = static_cast<int>(parts[k]),
                           .field_tiles = static_cast<int>(tiles[k])});
    }
    return {.device = table.string("device"),
            .vendor_id = static_cast<std::uint32_t>(number("vendor_id")),
            .device_id = static_cast<std::uint32_t>(number("device_id")),
            .driver = text("driver"),
            .traversal = text("traversal"),
            .fourier = text("fourier"),
            .sorting = {.pupil_cells = static_cast<int>(number("pupil_cells")),
                        .parts_per_pixel = static_cast<int>(number("parts_per_pixel")),
                        .field_tiles = static_cast<int>(number("field_tiles", 1))},
            .further_sortings = std::move(further),
            .kernels = table.string("kernels_digest"),
            .instrument = table.string("instrument_digest")};
}

std::string TracerIdentity::text() const {
    return fmt::format("{}{}{}", device, driver.empty() ? "" : fmt::format(" ({})", driver),
                       traversal.empty() ? "" : fmt::format(", traversal {}", traversal));
}

std::string instrument_digest(const optics::Instrument& instrument) {
    const auto constants = to_float(instrument.constants);
    std::vector<physics::f32::Surface> surfaces;
    for (const auto& surface : instrument.surfaces) {
        surfaces.push_back(to_float(surface));
    }
    const auto spectrum = spectrum_block(instrument);
    const auto points = instrument.light_field.value_or(optics::LightField{}).points.values;
    Digest digest;
    digest.add_values(std::span<const physics::f32::Instrument>(&constants, 1))
        .add_values(std::span<const physics::f32::Surface>(surfaces))
        .add_values(std::span<const physics::f32::SpectralBin>(spectrum))
        .add_values(std::span<const float>(points));
    if (instrument.turned) {
        const auto optics = to_float(instrument.turned->optics);
        const auto rim = static_cast<float>(instrument.turned->pupil_rim);
        digest.add_values(std::span<const physics::f32::BackwardOptics>(&optics, 1))
            .add_values(std::span<const float>(&rim, 1))
            .add_values(std::span<const decltype(lattice_generators)::value_type>(lattice_generators));
    }
    return digest.text();
}

std::string kernels_digest() {
    return spirv_digest;
}

TracerIdentity host_identity(const optics::Instrument& instrument, LightSorting sorting) {
    TracerIdentity identity;
    identity.device = "host";
    identity.sorting = sorting;
    identity.kernels = kernels_digest();
    identity.instrument = instrument_digest(instrument);
    return identity;
}

TracerIdentity device_identity(const vulkan::DeviceReport& device, const std::string& traversal,
                               const optics::Instrument& instrument, LightSorting sorting) {
    return {.device = device.name,
            .vendor_id = device.vendor_id,
            .device_id = device.device_id,
            .driver = device.driver,
            .traversal = traversal,
            .fourier = sorting.pupil_cells != 0 && !vulkan::is_software(device) ? vulkan::fourier_library() : "",
            .sorting = sorting,
            .further_sortings = {},
            .kernels = kernels_digest(),
            .instrument = instrument_digest(instrument)};
}

} // namespace vkfv::trace
