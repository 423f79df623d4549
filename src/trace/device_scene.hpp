// What every use of the trace on a device shares: device, specimen, instrument, bindings.
#pragma once

#include "optics/room.hpp"
#include "specimen/description.hpp"
#include "trace/device_records.hpp"
#include "trace/device_specimen.hpp"
#include "trace/host_tracer.hpp"
#include "trace/ledger.hpp"
#include "vulkan/kernel.hpp"

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkfv::trace {

// Elements' boxes in float, rounded outward.
std::vector<vulkan::Box> boxes_of(const optics::Room& room);

// Device, buffers and bindings that every use of the trace on a device shares.
class DeviceScene {
  public:
    DeviceScene(const optics::Instrument& instrument, const specimen::Specimen& specimen, const TraceOptions& options)
        : instrument(instrument), device(vulkan::DeviceOptions{options.device}),
          room(options.nonsequential ? optics::furnish(instrument) : optics::Room{}),
          accounts(options.nonsequential ? Accounts(instrument, room.names)
                                         : Accounts(instrument, options.directed_scatter)),
          features(instrument.features | (options.directed_scatter ? physics::f32::FEATURE_DIRECTED_SCATTER : 0u)),
          traversal(choose_traversal(device.report(), specimen, options.traversal, reason, options.nonsequential)),
          device_specimen(device, specimen, traversal, boxes_of(room)),
          host_record(specimen::record(specimen, options.max_bounces)), seed(options.seed), rays(options.rays),
          instrument_in_constants(options.instrument_in_constants),
          surfaces(device, physics::f32::SURFACE_CAPACITY * sizeof(physics::f32::Surface)),
          parameters(device, sizeof(Parameters), vulkan::Buffer::Memory::host),
          spectrum(device, physics::f32::SPECTRUM_CAPACITY * sizeof(physics::f32::SpectralBin)) {
        spectrum.write_values(std::span<const physics::f32::SpectralBin>(spectrum_block(instrument)));
        surfaces.write_values(std::span<const physics::f32::Surface>(surface_block(instrument)));
        constants.instrument = to_float(instrument.constants);
        constants.specimen = device_specimen.record(options.max_bounces);
        if (!room.elements.empty()) {
            std::vector<physics::f32::Element> placed;
            placed.reserve(room.elements.size());
            for (const auto& element : room.elements) {
                placed.push_back(to_float(element));
            }
            elements.emplace(device, placed.size() * sizeof(placed[0]));
            elements->write_values(std::span<const physics::f32::Element>(placed));
            const auto& order = device_specimen.element_order();
            element_order.emplace(device, order.size() * sizeof(order[0]));
            element_order->write_values(std::span<const std::uint32_t>(order));
        }
        host_record.top = constants.specimen.top; // the plane that the kernels mean: rounded to float
    }

    void set_exposure(double focal_height, std::uint32_t image) {
        constants.exposure = to_float(make_exposure(instrument, host_record, focal_height, seed, image));
        parameters.write_values(std::span<const Parameters>(&constants, 1));
    }

    // The scene's bindings (0, 1, 8 to 16) and those given.
    std::vector<vulkan::Binding> bindings(std::initializer_list<vulkan::Binding> further) const {
        std::vector<vulkan::Binding> all = {{0, &surfaces}, {1, &parameters}, {14, &spectrum}};
        const auto of_specimen = device_specimen.bindings();
        all.insert(all.end(), of_specimen.begin(), of_specimen.end());
        if (elements) {
            all.push_back({15, &*elements});
            all.push_back({16, &*element_order});
        }
        all.insert(all.end(), further.begin(), further.end());
        return all;
    }
    std::vector<vulkan::BindingDeclaration> declarations(std::initializer_list<std::uint32_t> further) const {
        using enum vulkan::BindingKind;
        std::vector<vulkan::BindingDeclaration> all = {{0, uniform_buffer}, {1, uniform_buffer}, {14, uniform_buffer}};
        const auto of_specimen = device_specimen.declarations();
        all.insert(all.end(), of_specimen.begin(), of_specimen.end());
        if (elements) {
            all.push_back({15, storage_buffer});
            all.push_back({16, storage_buffer});
        }
        for (const std::uint32_t slot : further) {
            all.push_back({slot, storage_buffer});
        }
        return all;
    }

    // Of the kernels: the specimen's, and the forward trace's ledger slots and early end.
    std::vector<vulkan::SpecializationConstant> kernel_constants(std::uint32_t stop_after) const {
        auto all = device_specimen.constants();
        all.push_back({1, static_cast<std::uint32_t>(accounts.slots())});
        all.push_back({2, stop_after});
        all.push_back({3, features});
        return all;
    }

    // Whether the forward kernels have the instrument as constants: if it is small enough, and where that pays or is
    // asked for.
    bool is_specialised() const;
    // For such kernels: those of all kernels and of shaders/device/prescription.glsl, for the surfaces first ...
    // first + count - 1 that the kernel traces through.
    std::vector<vulkan::SpecializationConstant> specialised_constants(std::uint32_t stop_after, int first,
                                                                      int count) const;

    // The variant of a kernel for the traversal.
    std::span<const std::uint32_t> variant(std::span<const std::uint32_t> by_quadtree,
                                           std::span<const std::uint32_t> by_ray_query,
                                           std::span<const std::uint32_t> by_bvh) const {
        return traversal == Traversal::ray_query ? by_ray_query : traversal == Traversal::bvh ? by_bvh : by_quadtree;
    }
    // Of an instrument that paths run through in this scene's direction.
    TracerIdentity identity() const;
    bool software() const { return device.report().type == "CPU"; }

    const optics::Instrument& instrument;
    std::string reason; // of the traversal; before `traversal`, which sets it
    vulkan::Device device;
    optics::Room room; // of elements; without any for sequential paths
    Accounts accounts;
    std::uint32_t features; // FEATURE_* of instrument and trace
    Traversal traversal;
    DeviceSpecimen device_specimen;
    physics::f64::SpecimenRecord host_record;
    std::uint32_t seed;
    std::uint64_t rays;                          // of an image
    std::optional<bool> instrument_in_constants; // see TraceOptions
    vulkan::Buffer surfaces;
    vulkan::Buffer parameters;
    vulkan::Buffer spectrum;
    std::optional<vulkan::Buffer> elements; // only for non-sequential paths
    std::optional<vulkan::Buffer> element_order;
    Parameters constants{};
};

} // namespace vkfv::trace
