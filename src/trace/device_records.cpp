#include "trace/device_records.hpp"

#include "core/error.hpp"

#include <string>

namespace vkfv::trace {

// The device reads these buffers in scalar layout: every member is four bytes and nothing is padded. The probe
// kernel probe_records shows that the shaders see the same fields.
static_assert(sizeof(physics::f32::Surface) == 14 * 4);
static_assert(sizeof(physics::f32::Instrument) == 14 * 4);
static_assert(sizeof(physics::f32::SpecimenRecord) == 19 * 4);
static_assert(sizeof(physics::f32::Exposure) == 4 * 4);
static_assert(sizeof(physics::f32::Survivor) == 6 * 4);
static_assert(sizeof(Parameters) ==
              sizeof(physics::f32::Instrument) + sizeof(physics::f32::SpecimenRecord) + sizeof(physics::f32::Exposure));

namespace {

physics::f32::Surface to_float(const physics::f64::Surface& surface) {
    physics::f32::Surface result{};
    result.curvature = static_cast<float>(surface.curvature);
    result.conic = static_cast<float>(surface.conic);
    result.semi_diameter_squared = static_cast<float>(surface.semi_diameter_squared);
    result.distance = static_cast<float>(surface.distance);
    result.index_before = static_cast<float>(surface.index_before);
    result.index_after = static_cast<float>(surface.index_after);
    result.a4 = static_cast<float>(surface.a4);
    result.a6 = static_cast<float>(surface.a6);
    result.a8 = static_cast<float>(surface.a8);
    result.a10 = static_cast<float>(surface.a10);
    result.a12 = static_cast<float>(surface.a12);
    result.a14 = static_cast<float>(surface.a14);
    result.a16 = static_cast<float>(surface.a16);
    result.flags = surface.flags;
    return result;
}

} // namespace

std::vector<physics::f32::Surface> surface_block(const optics::Instrument& instrument) {
    constexpr std::size_t capacity = physics::f32::SURFACE_CAPACITY;
    if (instrument.surfaces.size() > capacity) {
        throw InputError({.where = {},
                          .key = "surfaces of illumination and imaging together",
                          .found = std::to_string(instrument.surfaces.size()),
                          .expected = "at most " + std::to_string(capacity),
                          .remedy = "Use prescriptions of fewer surfaces, or the host (--device host)."});
    }
    std::vector<physics::f32::Surface> block(capacity);
    for (std::size_t k = 0; k < instrument.surfaces.size(); ++k) {
        block[k] = to_float(instrument.surfaces[k]);
    }
    return block;
}

physics::f32::Instrument to_float(const physics::f64::Instrument& instrument) {
    physics::f32::Instrument result{};
    result.source_radius = static_cast<float>(instrument.source_radius);
    result.source_distance = static_cast<float>(instrument.source_distance);
    result.emission_sine = static_cast<float>(instrument.emission_sine);
    result.magnification = static_cast<float>(instrument.magnification);
    result.detector_distance = static_cast<float>(instrument.detector_distance);
    result.detector_half_size = static_cast<float>(instrument.detector_half_size);
    result.gate_position = static_cast<float>(instrument.gate_position);
    result.gate_slope = static_cast<float>(instrument.gate_slope);
    result.gate_radius = static_cast<float>(instrument.gate_radius);
    result.illumination_first = instrument.illumination_first;
    result.illumination_count = instrument.illumination_count;
    result.imaging_first = instrument.imaging_first;
    result.imaging_count = instrument.imaging_count;
    result.detector_pixels = instrument.detector_pixels;
    return result;
}

physics::f32::Exposure to_float(const physics::f64::Exposure& exposure) {
    physics::f32::Exposure result{};
    result.top_distance = static_cast<float>(exposure.top_distance);
    result.seed = exposure.seed;
    result.image = exposure.image;
    result.unused = exposure.unused;
    return result;
}

} // namespace vkfv::trace
