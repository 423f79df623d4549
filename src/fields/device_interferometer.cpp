#include "fields/device_interferometer.hpp"

#include "core/mathematics/units.hpp"
#include "core/threads/parallel_rows.hpp"
#include "fields/exposure_image.hpp"
#include "fields/fields.hpp"
#include "vulkan/device.hpp"
#include "vulkan/fourier_planes.hpp"
#include "vulkan/kernel.hpp"

#include "spirv/fields_edges.h"
#include "spirv/fields_frames.h"
#include "spirv/fields_pixels.h"
#include "spirv/fields_reflect.h"
#include "spirv/fields_transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

namespace vkfv::fields {

namespace {

using kernels::FieldBatch;
using kernels::FieldFrames;
using kernels::FIELDS_FRAMES;
using Memory = vulkan::Buffer::Memory;

constexpr const char* memory_remedy = "Take fewer pixels, or a shorter scan.";
constexpr int groups_under_way = 3; // one is at work, one is read, one is filled

std::uint32_t number(std::size_t value) {
    return static_cast<std::uint32_t>(value);
}

template <class Value>
vulkan::Buffer buffer_with(const vulkan::Device& device, const std::vector<Value>& values) {
    vulkan::Buffer buffer(device, std::max<std::size_t>(1, values.size()) * sizeof(Value), Memory::device,
                          memory_remedy);
    if (!values.empty()) {
        buffer.write_values(std::span<const Value>(values));
    }
    return buffer;
}

void dispatch(vulkan::Commands& commands, const vulkan::Kernel& kernel, std::span<const vulkan::Binding> bindings,
              const FieldBatch& batch, std::size_t places) {
    if (places > 0) {
        const auto groups = vulkan::groups_of(places, kernels::FIELDS_WORKGROUP);
        commands.dispatch(kernel, bindings, batch, groups.x, groups.y);
        commands.barrier();
    }
}

// Makes the fields of all nodes in `pixels`.
void make_fields(const vulkan::Device& device, const FieldParts& parts, const vulkan::Buffer& pixels) {
    const SampledSurface& surface = parts.surface;
    const FieldGrid& grid = surface.grid;
    const std::size_t points = surface.heights.values.size();
    std::vector<float> of_points, edge_heights;
    of_points.reserve(4 * points);
    for (std::size_t k = 0; k < points; ++k) {
        of_points.push_back(static_cast<float>(surface.heights.values[k] - parts.middle_height));
        of_points.push_back(static_cast<float>(surface.slopes.values[k].x));
        of_points.push_back(static_cast<float>(surface.slopes.values[k].y));
        of_points.push_back(static_cast<float>(surface.amplitude.values[k]));
    }
    for (const double height : surface.edge_heights) {
        edge_heights.push_back(static_cast<float>(height - parts.middle_height));
    }
    std::vector<std::uint32_t> edges;
    for (const std::size_t edge : surface.edges) {
        edges.push_back(number(edge));
    }
    std::vector<std::complex<float>> transfer;
    for (const auto& value : parts.transfer.values()) {
        transfer.emplace_back(value);
    }
    const vulkan::Buffer point_buffer = buffer_with(device, of_points), edge_buffer = buffer_with(device, edges),
                         height_buffer = buffer_with(device, edge_heights),
                         transfer_buffer = buffer_with(device, transfer);
    const std::size_t plane = points * sizeof(std::complex<float>);
    const std::size_t most = std::min<std::uint64_t>(device.report().max_storage_buffer_bytes, std::size_t{1} << 29);
    const int nodes = parts.transfer.nodes();
    const int planes = static_cast<int>(std::clamp<std::size_t>(most / plane, 1, static_cast<std::size_t>(nodes)));
    const vulkan::Buffer waves(device, static_cast<std::size_t>(planes) * plane, Memory::device, memory_remedy);
    const vulkan::FourierPlanes forward(device, waves, grid.columns, grid.rows, planes,
                                        vulkan::FourierPlanes::Direction::forward);
    const vulkan::FourierPlanes inverse(device, waves, grid.columns, grid.rows, planes,
                                        vulkan::FourierPlanes::Direction::inverse);
    const auto kernel = [&](const char* name, std::span<const std::uint32_t> code) {
        return vulkan::Kernel(device, name, code,
                              {{kernels::FIELDS_BINDING_WAVES, vulkan::BindingKind::storage_buffer}},
                              sizeof(FieldBatch));
    };
    const vulkan::Kernel reflect = kernel("fields_reflect", fields_reflect),
                         mean_of_edges = kernel("fields_edges", fields_edges),
                         filter = kernel("fields_transfer", fields_transfer),
                         to_pixels = kernel("fields_pixels", fields_pixels);
    const std::array<vulkan::Binding, 1> bindings = {{{kernels::FIELDS_BINDING_WAVES, &waves}}};
    const double steps_a_cycle = parts.transfer.steps() / parts.transfer.cutoff();
    FieldBatch batch{.points = point_buffer.address(),
                     .edges = edge_buffer.address(),
                     .heights = height_buffer.address(),
                     .transfer = transfer_buffer.address(),
                     .pixels = pixels.address(),
                     .columns = static_cast<std::uint32_t>(grid.columns),
                     .rows = static_cast<std::uint32_t>(grid.rows),
                     .edge_count = number(edges.size()),
                     .first = 0,
                     .planes = 0,
                     .nodes = static_cast<std::uint32_t>(nodes),
                     .steps = static_cast<std::uint32_t>(parts.transfer.steps()),
                     .first_turns = static_cast<float>(parts.transfer.wave_number(0) / (2 * pi)),
                     .turns =
                         static_cast<float>((parts.transfer.wave_number(1) - parts.transfer.wave_number(0)) / (2 * pi)),
                     .steps_a_column = static_cast<float>(steps_a_cycle / (grid.columns * grid.pitch)),
                     .steps_a_row = static_cast<float>(steps_a_cycle / (grid.rows * grid.pitch)),
                     .pitch = static_cast<float>(grid.pitch),
                     .tilt_x = static_cast<float>(parts.tilt.x),
                     .tilt_y = static_cast<float>(parts.tilt.y),
                     .pixel_columns = static_cast<std::uint32_t>(grid.pixels.columns),
                     .pixel_rows = static_cast<std::uint32_t>(grid.pixels.rows),
                     .parts = static_cast<std::uint32_t>(grid.parts),
                     .margin_x = static_cast<std::uint32_t>(grid.margin_x),
                     .margin_y = static_cast<std::uint32_t>(grid.margin_y),
                     .centre_x = static_cast<float>(grid.margin_x + 0.5 * (grid.pixels.columns * grid.parts - 1)),
                     .centre_y = static_cast<float>(grid.margin_y + 0.5 * (grid.pixels.rows * grid.parts - 1))};
    vulkan::Commands commands(device);
    for (int first = 0; first < nodes; first += planes) {
        batch.first = static_cast<std::uint32_t>(first);
        batch.planes = static_cast<std::uint32_t>(std::min(planes, nodes - first));
        dispatch(commands, reflect, bindings, batch, points * batch.planes);
        dispatch(commands, mean_of_edges, bindings, batch, edges.size() * batch.planes);
        forward.record(commands);
        commands.barrier();
        dispatch(commands, filter, bindings, batch, points * batch.planes);
        inverse.record(commands);
        commands.barrier();
        dispatch(commands, to_pixels, bindings, batch, grid.pixels.count() * batch.planes);
    }
    commands.submit_and_wait();
}

// Images at up to FIELDS_FRAMES focal heights, made by one dispatch once the group is full or one of them is wanted.
class FrameGroup {
  public:
    FrameGroup(const vulkan::Device& device, const vulkan::Kernel& kernel, FieldFrames frames,
               std::shared_ptr<vulkan::Buffer> images)
        : device_(device), kernel_(kernel), frames_(frames), images_(std::move(images)),
          phases_(device, std::size_t{frames.nodes} * FIELDS_FRAMES * sizeof(std::complex<float>), Memory::host) {}

    // phases: of each node.
    std::size_t add(std::vector<std::complex<float>> phases) {
        of_frames_.push_back(std::move(phases));
        return of_frames_.size() - 1;
    }
    bool full() const { return of_frames_.size() == FIELDS_FRAMES; }
    bool begun() const { return commands_.has_value(); }

    void begin() {
        std::vector<std::complex<float>> phases(std::size_t{frames_.nodes} * FIELDS_FRAMES);
        for (std::size_t node = 0; node < frames_.nodes; ++node) {
            for (std::size_t frame = 0; frame < of_frames_.size(); ++frame) {
                phases[node * FIELDS_FRAMES + frame] = of_frames_[frame][node];
            }
        }
        phases_.write_values(std::span<const std::complex<float>>(phases));
        frames_.phases = phases_.address();
        frames_.images = images_->address();
        frames_.frames = number(of_frames_.size());
        commands_.emplace(device_, 2);
        commands_->timestamp();
        const auto groups = vulkan::groups_of(frames_.pixels, kernels::FIELDS_WORKGROUP);
        commands_->dispatch(kernel_, {}, frames_, groups.x, groups.y);
        commands_->barrier();
        commands_->timestamp();
        commands_->submit();
    }
    // The pixels of an image, when it is there.
    std::span<const float> values(std::size_t frame) {
        const std::lock_guard lock(waiting_); // images of a group may be asked for by several threads
        commands_->wait();
        return images_->values<float>(frames_.pixels, frame * frames_.pixels * sizeof(float));
    }
    double seconds_of_frame() {
        const std::lock_guard lock(waiting_);
        return commands_->seconds().back() / static_cast<double>(of_frames_.size());
    }

  private:
    const vulkan::Device& device_;
    const vulkan::Kernel& kernel_;
    FieldFrames frames_;
    std::shared_ptr<vulkan::Buffer> images_;
    vulkan::Buffer phases_;
    std::vector<std::vector<std::complex<float>>> of_frames_;
    std::optional<vulkan::Commands> commands_;
    std::mutex waiting_;
};

class DeviceInterferometer final : public trace::Tracer {
  public:
    DeviceInterferometer(std::shared_ptr<const vulkan::Device> device, FieldParts parts, FocalRange range,
                         trace::TracerIdentity identity, bool fields_by_device)
        : device_(std::move(device)), identity_(std::move(identity)), range_(range), exposed_(parts.fields),
          kernel_(*device_, "fields_frames", fields_frames, {}, sizeof(FieldFrames)),
          fields_(*device_, field_bytes(parts), Memory::device, memory_remedy),
          background_(buffer_with(*device_, parts.fields.background.values)) {
        if (fields_by_device) {
            make_fields(*device_, parts, fields_);
        } else {
            add_nodes(parts);
            std::size_t node = 0;
            for (const auto& field : parts.fields.nodes) {
                fields_.write_values(std::span<const std::complex<float>>(field.values), node++ * field.values.size());
            }
        }
        for (int k = 0; k < groups_under_way; ++k) {
            free_.push_back(std::make_shared<vulkan::Buffer>(*device_, FIELDS_FRAMES * pixels() * sizeof(float),
                                                             Memory::host, memory_remedy));
        }
    }

    trace::Image expose(trace::FocalPosition position, std::uint32_t image) const override {
        return begin(position, image).get();
    }

    std::future<trace::Image>
    begin(trace::FocalPosition position, std::uint32_t /*image*/,
          std::shared_ptr<const trace::Checkpoints> /*checkpoints*/ = nullptr) const override {
        const auto begun = std::chrono::steady_clock::now();
        require_in_range(range_, position);
        std::vector<std::complex<float>> phases;
        for (const double q : exposed_.wave_numbers) {
            phases.emplace_back(std::polar(1.0, q * (position.height - exposed_.height_offset)));
        }
        const std::lock_guard lock(mutex_);
        if (!filling_) {
            filling_ = std::make_shared<FrameGroup>(*device_, kernel_, frames(), room());
        }
        const auto group = filling_;
        const std::size_t frame = group->add(std::move(phases));
        if (group->full()) {
            group->begin();
            filling_.reset();
        }
        return std::async(std::launch::deferred, [this, group, frame, begun] {
            {
                const std::lock_guard again(mutex_);
                if (!group->begun()) {
                    group->begin();
                    filling_.reset();
                }
            }
            const auto values = group->values(frame);
            Grid<double> flux(exposed_.pixels.columns, exposed_.pixels.rows);
            parallel_rows(flux.columns, flux.rows, [&](int first, int end) {
                const std::size_t from = flux.index(0, first), count = flux.index(0, end) - from;
                std::ranges::copy(values.subspan(from, count), flux.values.begin() + static_cast<std::ptrdiff_t>(from));
            });
            trace::Image image = exposure_image(exposed_, std::move(flux));
            image.device_seconds = image.longest_submission = group->seconds_of_frame();
            image.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
            return image;
        });
    }

    int most_under_way() const override { return groups_under_way * static_cast<int>(FIELDS_FRAMES); }
    std::string description() const override {
        return fmt::format("{}, fields of {} wave numbers", device_->choice(), exposed_.wave_numbers.size());
    }
    trace::TracerIdentity identity() const override { return identity_; }
    std::shared_ptr<const vulkan::Device> device() const override { return device_; }

  private:
    static std::size_t field_bytes(const FieldParts& parts) {
        return static_cast<std::size_t>(parts.transfer.nodes()) * parts.fields.pixels.count() *
               sizeof(std::complex<float>);
    }
    std::size_t pixels() const { return exposed_.pixels.count(); }
    FieldFrames frames() const {
        return {.fields = fields_.address(),
                .phases = 0,
                .background = background_.address(),
                .images = 0,
                .pixels = number(pixels()),
                .nodes = number(exposed_.wave_numbers.size()),
                .frames = 0,
                .signal = static_cast<float>(exposed_.signal)};
    }
    // Memory for a group's images that no other group holds any more.
    std::shared_ptr<vulkan::Buffer> room() const {
        for (const auto& buffer : free_) {
            if (buffer.use_count() == 1) {
                return buffer;
            }
        }
        return free_.emplace_back(
            std::make_shared<vulkan::Buffer>(*device_, FIELDS_FRAMES * pixels() * sizeof(float), Memory::host));
    }

    std::shared_ptr<const vulkan::Device> device_;
    trace::TracerIdentity identity_;
    FocalRange range_;
    FringeFields exposed_; // without the nodes' fields, which are in the device's memory
    vulkan::Kernel kernel_;
    vulkan::Buffer fields_;
    vulkan::Buffer background_;
    mutable std::mutex mutex_;
    mutable std::vector<std::shared_ptr<vulkan::Buffer>> free_;
    mutable std::shared_ptr<FrameGroup> filling_;
};

} // namespace

std::unique_ptr<trace::Tracer> make_device_interferometer(const vulkan::OpenedDevice& opened,
                                                          const optics::Instrument& instrument,
                                                          const optics::InstrumentDescription& description,
                                                          const specimen::Specimen& specimen, const ReferenceArm& arm,
                                                          FocalRange range, FieldsBy by) {
    FieldParts parts = field_parts(instrument, description, specimen, arm, range);
    auto device = opened.get();
    const bool by_device =
        by == FieldsBy::device || (by == FieldsBy::automatic && !vulkan::is_software(device->report()));
    auto identity = trace::device_identity(device->report(), "", instrument, {});
    identity.fourier = by_device ? vulkan::fourier_library() : "";
    return std::make_unique<DeviceInterferometer>(std::move(device), std::move(parts), range, std::move(identity),
                                                  by_device);
}

} // namespace vkfv::fields
