#include "trace/interface/device_records.hpp"
#include "trace/structures/outward.hpp"

#include "core/messages/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace vkfv::trace {

// The device reads these buffers in scalar layout: every member is four bytes, so nothing is padded. The probe kernel
// probe_records shows that the shaders see the same fields.
static_assert(alignof(kernels::Parameters) == 4 && alignof(physics::f32::Surface) == 4 &&
              alignof(physics::f32::SpectralBin) == 4 && alignof(physics::f32::Survivor) == 4 &&
              alignof(physics::f32::Element) == 4 && alignof(physics::f32::Facet) == 4 &&
              alignof(kernels::NonsequentialBatch) == 4 && alignof(kernels::BackwardBlock) == 4);

namespace {

float to_float(double value) {
    return static_cast<float>(value);
}
glm::vec3 to_float(const glm::dvec3& vector) {
    return glm::vec3(vector);
}
std::int32_t to_float(std::int32_t number) {
    return number;
}
std::uint32_t to_float(std::uint32_t number) {
    return number;
}

#define VKFV_ROUND(type, name) result.name = to_float(record.name);
#define VKFV_ROUND_KNOWN(k, place, type, name) result.name = to_float(record.name);
#define VKFV_ROUND_ARRAY(type, name, size)                                                                             \
    for (int i = 0; i < physics::f32::size; ++i) {                                                                     \
        result.name[i] = to_float(record.name[i]);                                                                     \
    }
#define VKFV_TO_FLOAT(Record, FIELDS)                                                                                  \
    physics::f32::Record to_float(const physics::f64::Record& record) {                                                \
        physics::f32::Record result{};                                                                                 \
        FIELDS(VKFV_ROUND)                                                                                             \
        return result;                                                                                                 \
    }

VKFV_TO_FLOAT(Dispersion, VKFV_DISPERSION_FIELDS)
VKFV_TO_FLOAT(RingLight, VKFV_RING_LIGHT_FIELDS)
VKFV_TO_FLOAT(SpectralBin, VKFV_SPECTRAL_BIN_FIELDS)
VKFV_TO_FLOAT(Pattern, VKFV_PATTERN_FIELDS)
VKFV_TO_FLOAT(LightField, VKFV_LIGHT_FIELD_FIELDS)

physics::f32::Lobe to_float(const physics::f64::Lobe& record) {
    physics::f32::Lobe result{};
    VKFV_LOBE_FIELDS(VKFV_ROUND, VKFV_ROUND_ARRAY)
    return result;
}

VKFV_TO_FLOAT(Material, VKFV_MATERIAL_FIELDS)

} // namespace

physics::f32::Surface to_float(const physics::f64::Surface& record) {
    physics::f32::Surface result{};
    VKFV_SURFACE_FIELDS(VKFV_ROUND, VKFV_ROUND_KNOWN, 0)
    // The residual is for spheres alone: elsewhere the curvature that refracts is the local one.
    if (record.conic == 0 && (record.flags & physics::f64::SURFACE_ASPHERIC) == 0) {
        const float bend = result.curvature * (result.index_after - result.index_before);
        result.bend_residual = static_cast<float>(record.curvature * (record.index_after - record.index_before) -
                                                  static_cast<double>(bend));
    }
    return result;
}

VKFV_TO_FLOAT(Element, VKFV_ELEMENT_FIELDS)
VKFV_TO_FLOAT(Facet, VKFV_FACET_FIELDS)
VKFV_TO_FLOAT(SourceFrame, VKFV_SOURCE_FRAME_FIELDS)
VKFV_TO_FLOAT(Instrument, VKFV_INSTRUMENT_FIELDS)
VKFV_TO_FLOAT(BackwardOptics, VKFV_BACKWARD_OPTICS_FIELDS)
VKFV_TO_FLOAT(Lattice, VKFV_LATTICE_FIELDS)
VKFV_TO_FLOAT(PupilCells, VKFV_PUPIL_CELLS_FIELDS)

physics::f32::SpecimenRecord to_float(const physics::f64::SpecimenRecord& record) {
    physics::f32::SpecimenRecord result{};
    VKFV_SPECIMEN_RECORD_FIELDS(VKFV_ROUND)
    result.bottom = result.bottom > record.bottom ? next_below(result.bottom) : result.bottom;
    result.top = result.top < record.top ? next_above(result.top) : result.top;
    result.lipschitz = next_above(result.lipschitz);
    return result;
}

physics::f32::Exposure to_float(const physics::f64::Exposure& record) {
    physics::f32::Exposure result{};
    VKFV_EXPOSURE_FIELDS(VKFV_ROUND)
    result.top_distance_residual = static_cast<float>(record.top_distance - static_cast<double>(result.top_distance));
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
    std::ranges::transform(instrument.spectral_bins, block.begin(),
                           [](const physics::f64::SpectralBin& bin) { return to_float(bin); });
    return block;
}

} // namespace vkfv::trace
