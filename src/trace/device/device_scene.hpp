// What every use of the trace on a device shares: device, specimen, instrument, bindings.
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

// Boxes in float, rounded outward: of the elements that are surfaces, then of the facets of the others.
std::vector<vulkan::Box> boxes_of(const optics::Room& room);

// The elements of non-sequential paths in a device's memory.
struct ElementBuffers {
    vulkan::Buffer elements;
    vulkan::Buffer order;  // of their boxes
    vulkan::Buffer facets; // of those that are meshes
};

// Exposures that a device is given at a time: while the host takes one, the device has another.
inline constexpr std::size_t most_exposures = 3;

// The order of forward paths.
struct EmissionBuffers {
    EmissionOrder order;
    vulkan::Buffer given;       // of each cell
    vulkan::Buffer first_paths; // of each cell, of the exposure under way on the device
};

// The device's memory of one exposure. Each exposure has its own, so that the host can write the next one's while this
// one is traced.
struct ExposureMemory {
    vulkan::Buffer parameters;                 // the scene's constants with the exposure's own
    std::optional<vulkan::Buffer> first_paths; // of each emission cell; only for forward paths that are sequential
};

// SPIR-V of one kernel.
struct KernelVariants {
    std::span<const std::uint32_t> quadtree;
    std::span<const std::uint32_t> software; // the quadtree as software devices run it faster (VKFV_LEAVE_IF)
    std::span<const std::uint32_t> ray_query;
    std::span<const std::uint32_t> bvh;
};

// make_device_scene() makes it. The instrument must outlive it.
struct DeviceScene {
    // Orders where the paths of an image begin on the source; `paths` is how many an image has. Memories of exposures
    // that are made from now on hold this order.
    void order_emission(std::uint64_t paths);
    ExposureMemory exposure_memory() const;
    // The memories of all exposures that may be traced at a time.
    std::vector<ExposureMemory> exposure_memories() const;
    // All commands that were recorded with the memory before must have ended.
    void write_exposure(ExposureMemory& memory, FocalPosition position, std::uint32_t image) const;
    // Before more is traced: throws where waves cannot be made of it, as far as is known.
    void require_waves() const;
    // Of an image before its first path: the light that is sorted for waves.
    void clear_sorted_light(vulkan::Commands& commands) const;
    // After its last path: what waves make of that light, where the device does.
    void make_wave_image(ExposureWork& work) const;
    // Before what an exposure submits first: the order of its paths, for the device. Forward alone.
    void give_emission_order(vulkan::Commands& commands, const ExposureMemory& memory) const;
    // Where light is sorted for waves; none: it is not.
    std::vector<const vulkan::Buffer*> light_buffers() const;

    // The scene's bindings with an exposure's, and those given.
    std::vector<vulkan::Binding> bindings(const ExposureMemory& memory,
                                          std::initializer_list<vulkan::Binding> further) const;
    std::vector<vulkan::BindingDeclaration> declarations(std::initializer_list<std::uint32_t> further) const;

    // Of all kernels: the specimen's, the number of ledger slots, the features.
    std::vector<vulkan::SpecializationConstant> kernel_constants() const;
    // For kernels that have the instrument as constants: those of all kernels and of shaders/device/prescription.glsl,
    // for the surfaces first ... first + count - 1 that the kernel traces through.
    std::vector<vulkan::SpecializationConstant> specialised_constants(int first, int count) const;
    // Of shaders/device/train_polynomials.glsl; empty where the illumination is traced surface by surface.
    std::vector<vulkan::SpecializationConstant> illumination_polynomials() const;

    // That for the traversal, and for the device.
    std::span<const std::uint32_t> variant(const KernelVariants& kernel) const;
    // Of an instrument that paths run through in this scene's direction.
    TracerIdentity identity() const;
    std::optional<optics::PupilFilter> filter() const; // of images as waves make them
    // Exposures that may be under way.
    std::size_t exposures_at_a_time() const { return waves && !waves->on_device() ? 1 : most_exposures; }
    bool software() const { return vulkan::is_software(device->report()); }

    std::shared_ptr<const vulkan::Device> device; // buffers point to it
    const optics::Instrument& instrument;
    std::uint32_t seed;
    std::uint64_t rays; // of an image
    bool specialised;   // forward and backward kernels have the instrument as constants
    bool for_software;  // and those by the quadtree are of the form for software devices
    optics::Room room;  // of elements; without any for sequential paths
    Accounts accounts;
    std::uint32_t features;                                     // FEATURE_* of instrument, trace and specimen
    std::optional<physics::f64::TrainPolynomials> illumination; // in place of its surfaces
    ChosenTraversal traversal;
    DeviceSpecimen device_specimen;
    kernels::Parameters constants;            // but for the exposure
    physics::f64::SpecimenRecord host_record; // with the top plane that the kernels mean: rounded to float
    vulkan::Buffer surfaces;
    vulkan::Buffer spectrum;
    vulkan::Buffer light_points;             // of the light field's grid
    std::optional<ElementBuffers> elements;  // only for non-sequential paths
    std::optional<EmissionBuffers> emission; // only for forward ones that are sequential
    std::unique_ptr<SceneWaves> waves;       // only for images as waves make them
};

// The options' device, which opens from now on if it did not before.
vulkan::OpenedDevice opened_by(const TraceOptions& options);

// Throws DeviceError (no usable device, too little memory) or InputError (a traversal that specimen or device does not
// admit, too many surfaces).
// seen: the instrument, not turned round, by whose pupil light is sorted if the options ask for waves; none: it is not.
DeviceScene make_device_scene(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                              const TraceOptions& options, const optics::Instrument* seen = nullptr);

} // namespace vkfv::trace
