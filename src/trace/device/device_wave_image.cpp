#include "trace/device/device_wave_image.hpp"

#include "trace/device/wave_memory.hpp"
#include "trace/interface/device_records.hpp"
#include "waves/waves.hpp"

#include "spirv/wave_extend.h"
#include "spirv/wave_filter.h"
#include "spirv/wave_pixels.h"
#include "spirv/wave_sort.h"
#include "spirv/wave_table.h"

#include <algorithm>
#include <array>

namespace vkfv::trace {

using namespace waves;

namespace {

constexpr std::size_t workgroup = 128; // invocations of a workgroup of all kernels here

vulkan::Buffer buffer_of(const vulkan::Device& device, std::size_t bytes) {
    return {device, bytes, vulkan::Buffer::Memory::device, wave_memory_remedy};
}

vulkan::Buffer table_of(const vulkan::Device& device, const optics::PupilFilter& filter) {
    const auto& table = filter.table();
    vulkan::Buffer buffer(device, table.size() * sizeof(table.front()));
    buffer.write(std::as_bytes(std::span(table)));
    return buffer;
}

std::uint32_t nodes_of(const optics::PupilFilter& filter) {
    return static_cast<std::uint32_t>(filter.table().size()) / static_cast<std::uint32_t>(filter.tiles().count());
}

// Steps of the filter's table from one frequency to the next, for an image of so many parts that is continued as its
// mirror image.
float steps_a_line(const optics::PupilFilter& filter, int parts) {
    return static_cast<float>(0.5 / parts / filter.part_pitch() / filter.cutoff() * filter.steps());
}

vulkan::Kernel kernel_of(const vulkan::Device& device, const char* name, std::span<const std::uint32_t> code,
                         std::initializer_list<std::uint32_t> slots, std::uint32_t push_bytes,
                         std::span<const vulkan::SpecializationConstant> constants = {}) {
    std::vector<vulkan::BindingDeclaration> declarations;
    for (const std::uint32_t slot : slots) {
        declarations.push_back({slot, vulkan::BindingKind::storage_buffer});
    }
    return {device, name, code, declarations, push_bytes, constants};
}

TileRamp in_float(const f64::TileRamp& ramp) {
    return {.from = static_cast<float>(ramp.from),
            .width = static_cast<float>(ramp.width),
            .fade = static_cast<float>(ramp.fade),
            .neighbours = ramp.neighbours};
}

ImageSize parts_of(ImageSize pixels, const optics::PupilFilter& filter) {
    const auto parts = static_cast<int>(filter.cells().parts);
    return {pixels.columns * parts, pixels.rows * parts};
}

} // namespace

DeviceWaveImage::DeviceWaveImage(const vulkan::Device& device, const optics::PupilFilter& filter, ImageSize pixels,
                                 const SortedLight& light)
    : light_(light), pixels_(pixels), cells_(to_float(filter.cells())), image_size_(parts_of(pixels, filter)),
      windows_(wave_windows(filter.tiles().across(), pixels, static_cast<int>(cells_.parts))),
      filters_{vulkan::SpecializationConstant{.id = WAVES_CONSTANT_FILTERS,
                                              .value = static_cast<std::uint32_t>(windows_.front().filters)}},
      size_(parts_of(windows_.front().size, filter)),
      sizes_(static_cast<int>(cells_.side), size_, windows_.front().filters, largest_binding(device.report())),
      steps_(static_cast<std::uint32_t>(filter.steps())), nodes_(nodes_of(filter)),
      steps_a_column_(steps_a_line(filter, size_.columns)), steps_a_row_(steps_a_line(filter, size_.rows)),
      planes_(buffer_of(device, sizes_.plane_bytes())), tables_(table_of(device, filter)),
      spectrum_(buffer_of(device, sizes_.spectrum_bytes())), image_(buffer_of(device, sizes_.image_bytes())),
      result_(device, bytes(pixels)), forward_(device, planes_, size_.columns, size_.rows, sizes_.planes_at_once(),
                                               vulkan::FourierPlanes::Direction::forward),
      inverse_(device, image_, 2 * size_.columns, 2 * size_.rows, sizes_.image_planes(),
               vulkan::FourierPlanes::Direction::inverse),
      sort_(kernel_of(device, "wave_sort", wave_sort, {WAVES_BINDING_PLANES}, sizeof(WaveGroups))),
      filter_(kernel_of(device, "wave_filter", wave_filter,
                        {WAVES_BINDING_PLANES, WAVES_BINDING_TABLE, WAVES_BINDING_SPECTRUM}, sizeof(WaveGroups),
                        filters_)),
      extend_(kernel_of(device, "wave_extend", wave_extend, {WAVES_BINDING_SPECTRUM, WAVES_BINDING_IMAGE},
                        sizeof(WaveSize), filters_)),
      add_up_(kernel_of(device, "wave_pixels", wave_pixels, {WAVES_BINDING_IMAGE, WAVES_BINDING_PIXELS},
                        sizeof(WaveSize), filters_)) {
    if (windows_.front().filters > 1) {
        table_.emplace(buffer_of(device, std::size_t{nodes_} * 4 * sizeof(std::complex<float>)));
        put_together_.emplace(kernel_of(device, "wave_table", wave_table, {WAVES_BINDING_TABLES, WAVES_BINDING_TABLE},
                                        sizeof(WaveTables)));
    }
}

void DeviceWaveImage::dispatch(vulkan::Commands& commands, const vulkan::Kernel& kernel,
                               std::span<const vulkan::Binding> bindings, std::span<const std::byte> push,
                               std::size_t places) const {
    const auto workgroups = vulkan::groups_of(places, workgroup);
    commands.dispatch(kernel, bindings, push, workgroups.x, workgroups.y);
    commands.barrier();
}

void DeviceWaveImage::record(vulkan::Commands& commands) const {
    commands.fill_zero(result_);
    commands.barrier();
    for (const WaveWindow& window : windows_) {
        record(commands, window);
    }
}

void DeviceWaveImage::put_table_together(vulkan::Commands& commands, const WaveWindow& window) const {
    const auto tile = [&](std::size_t filter) { return static_cast<std::uint32_t>(window.tiles[filter]); };
    const WaveTables tables{.nodes = nodes_, .tiles = {tile(0), tile(1), tile(2), tile(3)}};
    const std::array<vulkan::Binding, 2> bindings = {
        {{WAVES_BINDING_TABLES, &tables_}, {WAVES_BINDING_TABLE, &*table_}}};
    dispatch(commands, *put_together_, bindings, std::as_bytes(std::span(&tables, 1)), 4 * std::size_t{nodes_});
}

void DeviceWaveImage::record(vulkan::Commands& commands, const WaveWindow& window) const {
    if (table_) {
        put_table_together(commands, window);
    }
    const vk::DeviceAddress address = light_.address();
    const auto number = [](int value) { return static_cast<std::uint32_t>(value); };
    WaveGroups groups{.light = {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32)},
                      .image_columns = number(image_size_.columns),
                      .first_column = number(window.column) * cells_.parts,
                      .first_row = number(window.row) * cells_.parts,
                      .columns = number(size_.columns),
                      .rows = number(size_.rows),
                      .cells_side = cells_.side,
                      .first = 0,
                      .count = sizes_.groups_at_once(),
                      .steps = steps_,
                      .steps_a_column = steps_a_column_,
                      .steps_a_row = steps_a_row_};
    const std::array<vulkan::Binding, 1> to_planes = {{{WAVES_BINDING_PLANES, &planes_}}};
    const std::array<vulkan::Binding, 3> to_spectrum = {{{WAVES_BINDING_PLANES, &planes_},
                                                         {WAVES_BINDING_TABLE, table_ ? &*table_ : &tables_},
                                                         {WAVES_BINDING_SPECTRUM, &spectrum_}}};
    const std::array<vulkan::Binding, 2> to_image = {
        {{WAVES_BINDING_SPECTRUM, &spectrum_}, {WAVES_BINDING_IMAGE, &image_}}};
    const std::array<vulkan::Binding, 2> to_pixels = {
        {{WAVES_BINDING_IMAGE, &image_}, {WAVES_BINDING_PIXELS, &result_}}};
    const std::size_t places = size_.count();
    const std::size_t pairs =
        static_cast<std::size_t>(size_.columns + 1) / 2 * static_cast<std::size_t>(size_.rows); // pairs of columns
    // A workgroup of the filter takes 32 frequencies of a quarter of the plane, its middle included, and their mirror
    // images.
    const std::size_t quarters =
        static_cast<std::size_t>(size_.columns / 2 / 32 + 1) * static_cast<std::size_t>(size_.rows / 2 + 1) * workgroup;
    for (; groups.first < sizes_.groups(); groups.first += sizes_.groups_at_once()) {
        const auto push = std::as_bytes(std::span(&groups, 1));
        dispatch(commands, sort_, to_planes, push, pairs);
        forward_.record(commands);
        dispatch(commands, filter_, to_spectrum, push, quarters);
    }
    const WaveSize size{.columns = groups.columns,
                        .rows = groups.rows,
                        .cells = cells_,
                        .image_columns = number(pixels_.columns),
                        .first_column = number(window.column),
                        .first_row = number(window.row),
                        .along = in_float(window.along),
                        .up = in_float(window.up)};
    const auto push = std::as_bytes(std::span(&size, 1));
    dispatch(commands, extend_, to_image, push, 2 * places * static_cast<std::size_t>(sizes_.image_planes()));
    inverse_.record(commands);
    dispatch(commands, add_up_, to_pixels, push, window.size.count());
}

} // namespace vkfv::trace
