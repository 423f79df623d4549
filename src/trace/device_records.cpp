#include "trace/device_records.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <string>

namespace vkfv::trace {

// The device reads these buffers in scalar layout: every member is four bytes and nothing is padded. The probe
// kernel probe_records shows that the shaders see the same fields.
static_assert(sizeof(physics::f32::Surface) == 42 * 4);
static_assert(sizeof(physics::f32::SpectralBin) == 4 * 4);
static_assert(sizeof(physics::f32::Instrument) == 32 * 4);
static_assert(sizeof(physics::f32::SpecimenRecord) == 94 * 4);
static_assert(sizeof(physics::f32::Exposure) == 5 * 4);
static_assert(sizeof(physics::f32::Survivor) == 8 * 4);
static_assert(sizeof(physics::f32::Element) == (42 + 18) * 4);
static_assert(sizeof(physics::f32::SourceFrame) == 12 * 4);
static_assert(sizeof(Parameters) ==
              sizeof(physics::f32::Instrument) + sizeof(physics::f32::SpecimenRecord) + sizeof(physics::f32::Exposure));

namespace {

physics::f32::Dispersion to_float(const physics::f64::Dispersion& dispersion) {
    return {static_cast<float>(dispersion.c1), static_cast<float>(dispersion.c2), static_cast<float>(dispersion.c3),
            static_cast<float>(dispersion.c4), static_cast<float>(dispersion.c5), static_cast<float>(dispersion.c6)};
}

physics::f32::RingLight to_float(const physics::f64::RingLight& ring) {
    physics::f32::RingLight result{};
    result.aim_distance = static_cast<float>(ring.aim_distance);
    result.distance = static_cast<float>(ring.distance);
    result.elevation_sine = static_cast<float>(ring.elevation_sine);
    result.elevation_cosine = static_cast<float>(ring.elevation_cosine);
    result.half_width = static_cast<float>(ring.half_width);
    result.fill = static_cast<float>(ring.fill);
    result.segments = ring.segments;
    result.switched_on = ring.switched_on;
    return result;
}

} // namespace

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
    result.decentre_x = static_cast<float>(surface.decentre_x);
    result.decentre_y = static_cast<float>(surface.decentre_y);
    result.rotation_xx = static_cast<float>(surface.rotation_xx);
    result.rotation_xy = static_cast<float>(surface.rotation_xy);
    result.rotation_xz = static_cast<float>(surface.rotation_xz);
    result.rotation_yx = static_cast<float>(surface.rotation_yx);
    result.rotation_yy = static_cast<float>(surface.rotation_yy);
    result.rotation_yz = static_cast<float>(surface.rotation_yz);
    result.rotation_zx = static_cast<float>(surface.rotation_zx);
    result.rotation_zy = static_cast<float>(surface.rotation_zy);
    result.rotation_zz = static_cast<float>(surface.rotation_zz);
    result.power = static_cast<float>(surface.power);
    result.reflectance = static_cast<float>(surface.reflectance);
    result.layer_index = static_cast<float>(surface.layer_index);
    result.layer_thickness = static_cast<float>(surface.layer_thickness);
    // Of spheres alone: elsewhere the curvature that bends is the ray's own.
    if (surface.conic == 0 && (surface.flags & physics::f64::SURFACE_ASPHERIC) == 0) {
        const float bend = result.curvature * (result.index_after - result.index_before);
        result.bend_residual = static_cast<float>(surface.curvature * (surface.index_after - surface.index_before) -
                                                  static_cast<double>(bend));
    }
    result.dispersion_before = to_float(surface.dispersion_before);
    result.dispersion_after = to_float(surface.dispersion_after);
    result.flags = surface.flags;
    return result;
}

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

std::vector<physics::f32::SpectralBin> spectrum_block(const optics::Instrument& instrument) {
    std::vector<physics::f32::SpectralBin> block(physics::f32::SPECTRUM_CAPACITY);
    std::ranges::transform(instrument.spectral_bins, block.begin(), [](const physics::f64::SpectralBin& bin) {
        return physics::f32::SpectralBin{static_cast<float>(bin.cumulative), static_cast<float>(bin.start),
                                         static_cast<float>(bin.stop), static_cast<float>(bin.tilt)};
    });
    return block;
}

physics::f32::Element to_float(const physics::f64::Element& element) {
    physics::f32::Element result{};
    result.surface = to_float(element.surface);
    result.origin = glm::vec3(element.origin);
    result.axis_x = glm::vec3(element.axis_x);
    result.axis_y = glm::vec3(element.axis_y);
    result.axis_z = glm::vec3(element.axis_z);
    result.rim_radius = static_cast<float>(element.rim_radius);
    result.rim_height = static_cast<float>(element.rim_height);
    result.outer_radius = static_cast<float>(element.outer_radius);
    result.barrel_length = static_cast<float>(element.barrel_length);
    result.transmittance = static_cast<float>(element.transmittance);
    result.kind = element.kind;
    return result;
}

physics::f32::SourceFrame to_float(const physics::f64::SourceFrame& frame) {
    return {glm::vec3(frame.origin), glm::vec3(frame.axis_x), glm::vec3(frame.axis_y), glm::vec3(frame.axis_z)};
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
    result.spectrum_centre = static_cast<float>(instrument.spectrum_centre);
    result.spectrum_half_width = static_cast<float>(instrument.spectrum_half_width);
    result.specimen_index = static_cast<float>(instrument.specimen_index);
    result.specimen_dispersion = to_float(instrument.specimen_dispersion);
    result.ring = to_float(instrument.ring);
    result.spectral_bins = instrument.spectral_bins;
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
    result.top_distance_residual = static_cast<float>(exposure.top_distance - static_cast<double>(result.top_distance));
    result.seed = exposure.seed;
    result.image = exposure.image;
    result.focal_height = static_cast<float>(exposure.focal_height);
    return result;
}

} // namespace vkfv::trace
