#include "trace/interface/backward_image.hpp"

#include "core/mathematics/units.hpp"
#include "trace/interface/lattice_generators.hpp"
#include "trace/interface/ledger.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace vkfv::trace {

namespace {

// Radius of the disc in which paths start. Where the pupil's rim encloses m of n equal shares of the disc's area, m of
// the n points of each shifted lattice are within the pupil, whatever the shift: the rim, beyond which there is no
// light, then adds no noise.
double start_radius(const optics::TurnedInstrument& turned, const BackwardPlan& plan) {
    const double holds_all = turned.optics.pupil_radius;
    const double share = turned.pupil_rim / holds_all;
    const double within = std::floor(plan.points * share * share);
    constexpr double least_share = 0.85; // share of the points: 7 of 8 lower the variance, fewer were not tested
    return within >= least_share * plan.points ? turned.pupil_rim * std::sqrt(plan.points / within) : holds_all;
}

} // namespace

BackwardPlan backward_plan(std::uint64_t rays, ImageSize detector_pixels) {
    const std::uint64_t pixels = detector_pixels.count();
    const std::uint64_t per_pixel = (rays + pixels - 1) / pixels;
    BackwardPlan plan;
    const std::uint64_t most = std::uint64_t{1} << (lattice_generators.size() - 1);
    plan.points = static_cast<std::uint32_t>(
        std::min(most, std::bit_ceil((per_pixel + plan.randomisations - 1) / plan.randomisations)));
    plan.randomisations = static_cast<std::uint32_t>(
        std::max<std::uint64_t>(plan.randomisations, (per_pixel + plan.points - 1) / plan.points));
    return plan;
}

std::uint64_t backward_rays(std::uint64_t rays, ImageSize detector_pixels) {
    return backward_plan(rays, detector_pixels).rays_per_pixel() * detector_pixels.count();
}

physics::f64::Lattice BackwardPlan::lattice() const {
    const auto bits = static_cast<std::uint32_t>(std::bit_width(points) - 1);
    const auto& z = lattice_generators[bits];
    return {bits, z[0], z[1], z[2], z[3], z[4], z[5], z[6], z[7]};
}

physics::f64::BackwardOptics backward_optics(const optics::Instrument& instrument,
                                             const physics::f64::Material& material, const BackwardPlan& plan) {
    using namespace physics::f64;
    BackwardOptics optics = instrument.turned.value().optics;
    optics.pupil_radius = start_radius(*instrument.turned, plan);
    // `peak` is the largest share of light that a lobe would send into the source's cone along its mirror direction, if
    // its BSDF were flat over the cone.
    double peak = 0;
    const bool is_ring = (instrument.features & FEATURE_RING) != 0;
    const double solid_angle = is_ring ? optics.ring_area / (optics.ring.distance * optics.ring.distance)
                                       : pi * optics.source_outer * optics.source_outer;
    for (const Lobe& lobe : {material.lobe_0, material.lobe_1, material.lobe_2, material.lobe_3}) {
        if (lobe.weight > 0) {
            const real3 up(0, 0, 1);
            const double bsdf =
                lobe_has_numbers(lobe) ? lobe.table[4] : scatter_bsdf(material_of_lobe(lobe), -up, up, up);
            peak = std::max(peak, bsdf * solid_angle);
        }
    }
    // A lobe much narrower than the cone is sampled by drawing from the lobe, not from the cone.
    optics.lobe_candidates = peak > 2 ? 1 : 0;
    const bool has_rim = !is_ring && optics.source_inner > 0 && optics.lobe_candidates == 0;
    constexpr std::uint32_t rim_period = 4;
    optics.rim_period = has_rim ? std::min(rim_period, plan.points) : 0;
    // Where the source is seen for sure, more directions lower the variance. Where its rim is among them and a lobe
    // changes little over the cone, one direction keeps the lattice whole, which a choice among several does not.
    // Measured signal to noise of the middle 100 x 100 pixels of bench_paper_chain at 1024 paths each: for g = 0.3
    // (peak 0.06), 753 with the rim, without it 976 with one direction, 1330 with four, 1348 with eight; for g = 0.8
    // (peak 1.2), 104, and with four, eight and sixteen 170, 200 and 206.
    optics.cone_candidates = peak < 0.3 ? 1 : 8;
    optics.sure_candidates = peak < 0.3 ? 4 : 8;
    return optics;
}

BackwardAccounts::BackwardAccounts(const optics::Instrument& instrument, const BackwardPlan& plan)
    : plan_(plan), flux_(instrument.flux), pixels_(instrument.detector_pixels()) {
    const auto& constants = instrument.constants;
    const bool is_ring = (instrument.features & physics::f64::FEATURE_RING) != 0;
    const bool is_rectangle = (instrument.features & physics::f64::FEATURE_RECTANGLE) != 0;
    const double area = is_ring        ? physics::f64::ring_area(constants.ring)
                        : is_rectangle ? 4 * constants.source_half_width * constants.source_half_height
                                       : pi * constants.source_radius * constants.source_radius;
    const double radiance = instrument.flux / (pi * area);
    const double pitch = 2 * constants.detector_half_width / pixels_.columns;
    const double side = std::min(2 * constants.pixel_reach, 1.0);
    const double sensitive = side * side; // sensitive share of a pixel
    const double pupil_radius = start_radius(instrument.turned.value(), plan);
    scale_ = radiance * pitch * pitch * sensitive * (pi * pupil_radius * pupil_radius) *
             instrument.splitter_reflectance * instrument.splitter_transmittance;
}

estimate::EstimateRule BackwardAccounts::rule() const {
    return {.kind = estimate::ESTIMATE_RANDOMISATIONS,
            .scale = scale_,
            .unit = 1.0 / (static_cast<double>(physics::f64::BACKWARD_UNIT) * plan_.points),
            .unit_of_squares = 0,
            .count = static_cast<double>(plan_.randomisations)};
}

double BackwardAccounts::power_per_number() const {
    return scale_ / (static_cast<double>(physics::f64::BACKWARD_UNIT) * static_cast<double>(plan_.rays_per_pixel()));
}

Image BackwardAccounts::image(PixelLight pixels, double detected) const {
    Image image;
    image.flux = std::move(pixels.flux);
    image.standard_error = std::move(pixels.standard_error);
    image.rays = plan_.rays_per_pixel() * pixels_.count();
    image.detected = image.rays;
    image.ledger.emitted = flux_;
    image.ledger.entries = {plain_entry(Ledger::Status::detected, detected, image.rays),
                            plain_entry(Ledger::Status::not_followed_backward, flux_ - detected, 0)};
    return image;
}

} // namespace vkfv::trace
