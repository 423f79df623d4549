#include "optics/instrument/assembly.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::optics {

namespace {

// The sine of a cone about the band's normal that contains, from any point of the band, the ball around the lit region:
// the ball's centre is off the normal by at most the half width, and no point of the ball is nearer than `nearest`. A
// cover glass shifts light sideways by less than its thickness if it is the denser medium; a rarer one shifts light
// near total reflection by any length, so then the whole hemisphere serves.
double ring_emission_sine(const InstrumentDescription& description, const AxialLayout& layout) {
    const RingLightDescription& ring = *description.source.ring;
    const Spectrum& spectrum = description.spectrum;
    constexpr double margin = 1.5; // factor on the detector's field
    const double lit_radius =
        std::hypot(ring.lit_radius.value_or(margin * layout.seen_half_diagonal()), description.greatest_defocus);
    const double nearest = ring.distance - lit_radius;
    const double aside = lit_radius + 0.5 * ring.width;
    const double shift = layout.cover.empty() ? 0 : description.cover_glass->thickness;
    const auto is_rarer_at = [&](double wavelength_um) {
        return description.cover_glass->glass.index(wavelength_um) <
               layout.objective_lens.medium_before.index(wavelength_um);
    };
    const bool may_reflect_totally =
        !layout.cover.empty() && (is_rarer_at(spectrum.shortest_um) || is_rarer_at(spectrum.longest_um));
    const double distance = std::hypot(nearest, aside);
    if (may_reflect_totally || !(nearest > 0 && shift < distance)) {
        return 1;
    }
    // A ray that the cover glass shifts aims past its target at the distance `shift`.
    const double angle = std::atan2(aside, nearest) + std::asin(shift / distance);
    return angle < 0.5 * pi ? std::sin(angle) : 1;
}

// aim_distance: mm, from the plane of best focus to the frame in which light enters the train.
physics::f64::RingLight ring_constants(const RingLightDescription& ring, double aim_distance) {
    physics::f64::RingLight constants{};
    constants.aim_distance = aim_distance;
    constants.distance = ring.distance;
    constants.elevation_sine = std::sin(ring.elevation);
    constants.elevation_cosine = std::cos(ring.elevation);
    constants.half_width = 0.5 * ring.width;
    constants.fill = ring.fill;
    constants.segments = ring.segments;
    for (std::size_t segment = 0; segment < ring.on.size(); ++segment) {
        constants.switched_on |= ring.on[segment] ? 1u << segment : 0u;
    }
    return constants;
}

void check_ring(const SourceDescription& source, const physics::f64::RingLight& constants, bool has_cover) {
    const RingLightDescription& ring = *source.ring;
    if (ring.segments < 1 || ring.segments > physics::f64::RING_CAPACITY ||
        ring.on.size() != static_cast<std::size_t>(ring.segments) || constants.switched_on == 0) {
        refuse(source.key + ".segments", fmt::format("{} segments", ring.segments),
               fmt::format("1 to {} segments, at least one of them on", physics::f64::RING_CAPACITY),
               "Switch a segment on.");
    }
    if (!(ring.distance > 0 && ring.width > 0 && ring.elevation > 0 && ring.elevation < 0.5 * pi &&
          0.5 * ring.width * std::tan(ring.elevation) < ring.distance)) {
        refuse(source.key + ".width_mm", fmt::format("{} mm wide, {} mm away", ring.width, ring.distance),
               "a band that does not reach the axis", "Choose a smaller width or elevation.");
    }
    if (has_cover && !(ring.distance * constants.elevation_sine - constants.half_width * constants.elevation_cosine >
                       constants.aim_distance)) {
        refuse(source.key + ".distance_mm", fmt::format("{} mm", ring.distance),
               fmt::format("a ring above the cover glass, whose upper face is {:.6g} mm over the focus",
                           constants.aim_distance),
               "Move the ring farther away, or the cover glass nearer to the specimen.");
    }
}

} // namespace

Illumination place_ring(const InstrumentDescription& description, const AxialLayout& layout,
                        const MeasuredImaging& measured) {
    Illumination result;
    result.train = reversed(layout.cover);
    const Pose entry = result.train.empty() ? layout.front.half_turn() : result.train.front().pose;
    link(result.train, entry);
    result.ring = ring_constants(*description.source.ring, entry.origin.z - measured.best_focus_offset);
    check_ring(description.source, result.ring, !layout.cover.empty());
    result.aim.sine = ring_emission_sine(description, layout);
    result.source_pose = downward(0);
    return result;
}

} // namespace vkfv::optics
