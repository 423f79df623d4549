// Data that every trace on a device needs: device, specimen, instrument, bindings.
#pragma once

#include "optics/instrument/room.hpp"
#include "specimen/description.hpp"
#include "trace/device/device_specimen.hpp"
#include "trace/device/scene_waves.hpp"
#include "trace/interface/device_records.hpp"
#include "trace/interface/emission_order.hpp"
#include "trace/interface/ledger.hpp"
#include "trace/interface/tracer_identity.hpp"
#include "vulkan/kernel.hpp"

#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::trace {

// Boxes in float, rounded outward: of the elements that are surfaces, then of the facets of the mesh elements.
std::vector<vulkan::Box> boxes_of(const optics::Room& room);

// The elements of non-sequential paths, in a device's memory.
struct ElementBuffers {
    vulkan::Buffer elements;
    vulkan::Buffer order;  // element or facet in each box
    vulkan::Buffer facets; // facets of all meshes
};

// Number of exposures that a device is given at a time: it has others to do while the host takes one.
inline constexpr std::size_t most_exposures = 3;

// The order of forward paths and its tables in a device's memory.
struct EmissionBuffers {
    EmissionOrder order;
    vulkan::Buffer given;       // given bits of each cell
    vulkan::Buffer first_paths; // first path of each cell, for the exposure under way on the device
};

// The device's memory of one exposure. Each exposure has its own, so that the host can write the next exposure's while
// the device traces this one.
struct ExposureMemory {
    vulkan::Buffer parameters;                 // the scene's constants with the exposure's own
    std::optional<vulkan::Buffer> first_paths; // first path of each emission cell; only for sequential forward paths
};

// SPIR-V of one kernel, for each traversal.
struct KernelVariants {
    std::span<const std::uint32_t> quadtree;
    std::span<const std::uint32_t> software; // the quadtree's form that is faster on software devices (VKFV_LEAVE_IF)
    std::span<const std::uint32_t> ray_query;
    std::span<const std::uint32_t> bvh;
};

// The scene on a device, made by make_device_scene(). The instrument must outlive it.
struct DeviceScene {
    // Sets the order in which the paths of an image begin on the source; `paths`: number of paths of an image. Memories
    // of exposures that are made afterwards hold this order.
    void order_emission(std::uint64_t paths);
    ExposureMemory exposure_memory() const;
    // The memories of all exposures that may be traced at a time.
    std::vector<ExposureMemory> exposure_memories() const;
    // Writes an exposure into its memory. All commands that were recorded with the memory before must have ended.
    void write_exposure(ExposureMemory& memory, FocalPosition position, std::uint32_t image) const;
    // Called before tracing goes on: throws RunError or DeviceError if it is known that no wave image can be made.
    void require_waves() const;
    // Clears the light that is sorted for waves, before an image's first path.
    void clear_sorted_light(vulkan::Commands& commands) const;
    // Makes the wave image of that light after an image's last path, if the device makes it.
    void make_wave_image(ExposureWork& work) const;
    // Copies the order of paths to the device, before the first submission of an exposure; for forward paths alone.
    void give_emission_order(vulkan::Commands& commands, const ExposureMemory& memory) const;
    // Buffers of the light that is sorted for waves; empty if it is not sorted.
    std::vector<const vulkan::Buffer*> light_buffers() const;

    // The scene's bindings, those of an exposure, and the further ones given.
    std::vector<vulkan::Binding> bindings(const ExposureMemory& memory,
                                          std::initializer_list<vulkan::Binding> further) const;
    std::vector<vulkan::BindingDeclaration> declarations(std::initializer_list<std::uint32_t> further) const;

    // Constants of all kernels: the specimen's, the number of ledger slots, the features.
    std::vector<vulkan::SpecializationConstant> kernel_constants() const;
    // Constants of kernels that know the instrument: those of all kernels, and those of
    // shaders/device/prescription.glsl for the surfaces first ... first + count - 1 that the kernel traces through.
    std::vector<vulkan::SpecializationConstant> specialised_constants(int first, int count) const;
    // Constants of shaders/device/train_polynomials.glsl; empty where the illumination is traced surface by surface.
    std::vector<vulkan::SpecializationConstant> illumination_polynomials() const;

    // The kernel's SPIR-V for the scene's traversal and device.
    std::span<const std::uint32_t> variant(const KernelVariants& kernel) const;
    // The identity of a tracer of the instrument that this scene's paths run through.
    TracerIdentity identity() const;
    std::optional<optics::PupilFilter> filter() const; // filter of wave images; empty: images of rays
    // Number of exposures that may be under way.
    std::size_t exposures_at_a_time() const { return waves && !waves->on_device() ? 1 : most_exposures; }
    bool software() const { return vulkan::is_software(device->report()); }

    std::shared_ptr<const vulkan::Device> device; // buffers point to it
    const optics::Instrument& instrument;
    std::uint32_t seed;
    std::uint64_t rays; // number of rays of an image
    bool specialised;   // true: forward and backward kernels have the instrument as constants
    bool for_software;  // true: these and the quadtree's kernels are of the form for software devices
    optics::Room room;  // empty for sequential paths
    Accounts accounts;
    std::uint32_t features;                                     // FEATURE_* of instrument, trace and specimen
    std::optional<physics::f64::TrainPolynomials> illumination; // polynomials in place of the illumination's surfaces
    ChosenTraversal traversal;
    DeviceSpecimen device_specimen;
    kernels::Parameters constants;            // parameters without those of the exposure
    physics::f64::SpecimenRecord host_record; // record with the top plane rounded to float, as the kernels have it
    vulkan::Buffer surfaces;
    vulkan::Buffer spectrum;
    vulkan::Buffer light_points;             // grid of the light field
    std::optional<ElementBuffers> elements;  // only for non-sequential paths
    std::optional<EmissionBuffers> emission; // only for sequential forward paths
    std::unique_ptr<SceneWaves> waves;       // only for wave images
};

// The options' device; it is opened from now on if it was not before.
vulkan::OpenedDevice opened_by(const TraceOptions& options);

// Makes the scene. seen: the instrument, not reversed, by whose pupil light is sorted if the options ask for waves;
// null: it is not sorted. Throws DeviceError (no usable device, too little memory) or InputError (a traversal that
// specimen or device does not admit, too many surfaces).
DeviceScene make_device_scene(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                              const TraceOptions& options, const optics::Instrument* seen = nullptr);

} // namespace vkfv::trace
