#include "optics/instrument.hpp"

#include "core/error.hpp"
#include "core/units.hpp"
#include "optics/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vkfv::optics {

namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;
using physics::f64::real3;
using physics::f64::Surface;

[[noreturn]] void refuse(std::string key, std::string found, std::string expected, std::string remedy,
                         const std::filesystem::path& file = {}) {
    throw InputError({.where = {.file = file},
                      .key = std::move(key),
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

void require_positive(double value, const char* key) {
    if (!(value > 0 && std::isfinite(value))) {
        refuse(key, fmt::format("{}", value), "a finite number > 0", "Correct it.");
    }
}

std::vector<Surface> train_of(const Prescription& prescription, double wavelength_um) {
    std::vector<Surface> train;
    double index = prescription.medium_before.index(wavelength_um);
    double distance = 0;
    for (const auto& prescribed : prescription.surfaces) {
        Surface surface{};
        surface.curvature = prescribed.curvature;
        surface.conic = prescribed.conic;
        surface.distance = distance;
        surface.index_before = index;
        surface.index_after = prescribed.medium_after.index(wavelength_um);
        surface.a4 = prescribed.aspheric[0];
        surface.a6 = prescribed.aspheric[1];
        surface.a8 = prescribed.aspheric[2];
        surface.a10 = prescribed.aspheric[3];
        surface.a12 = prescribed.aspheric[4];
        surface.a14 = prescribed.aspheric[5];
        surface.a16 = prescribed.aspheric[6];
        if (std::any_of(prescribed.aspheric.begin(), prescribed.aspheric.end(),
                        [](double coefficient) { return coefficient != 0; })) {
            surface.flags |= physics::f64::SURFACE_ASPHERIC;
        }
        if (prescribed.semi_diameter) {
            surface.semi_diameter_squared = *prescribed.semi_diameter * *prescribed.semi_diameter;
            surface.flags |= physics::f64::SURFACE_CLIPPED;
        }
        train.push_back(surface);
        index = surface.index_after;
        distance = prescribed.thickness;
    }
    return train;
}

// A part as a train by itself, with its paraxial transfer. Throws unless it stands in air and is not afocal.
struct Part {
    std::vector<Surface> train;
    RayTransfer transfer;
};

Part make_part(const Prescription& prescription, double wavelength_um, const char* key) {
    if (prescription.surfaces.empty()) {
        refuse(key, prescription.name, "a prescription with surfaces", "Add a [[surface]].",
               prescription.file);
    }
    Part part{.train = train_of(prescription, wavelength_um), .transfer = {}};
    if (part.train.front().index_before != 1 || part.train.back().index_after != 1) {
        refuse(key, prescription.name, "a part that stands in air",
               "Remove medium_before and the medium of the last surface.", prescription.file);
    }
    part.transfer = transfer_of_train(part.train);
    return part;
}

std::optional<std::size_t> surface_with_role(const Prescription& prescription, PrescribedSurface::Role role) {
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        if (prescription.surfaces[i].role == role) {
            return i;
        }
    }
    return std::nullopt;
}

std::string role_suffix(PrescribedSurface::Role role) {
    switch (role) {
    case PrescribedSurface::Role::aperture_stop:
        return ", aperture stop";
    case PrescribedSurface::Role::field_stop:
        return ", field stop";
    case PrescribedSurface::Role::refracting:
        break;
    }
    return "";
}

// "imaging 3 (10x_0.28 3, aperture stop)": the place in the train, and in the prescription as its file
// counts.
void name_surfaces(std::vector<std::string>& names, const char* train, std::size_t& place,
                   const Prescription& prescription, bool backward) {
    const std::size_t count = prescription.surfaces.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t own = backward ? count - 1 - i : i;
        names.push_back(fmt::format("{} {} ({} {}{})", train, ++place, prescription.name, own + 1,
                                    role_suffix(prescription.surfaces[own].role)));
    }
}

void append(std::vector<Surface>& train, const std::vector<Surface>& part, double distance) {
    const std::size_t first = train.size();
    train.insert(train.end(), part.begin(), part.end());
    train[first].distance = distance;
}

// The largest t of [0, limit] at which the predicate holds, to rounding: looked for inward in steps of limit / 32, then
// by bisection. Where it holds only between two steps, and not at 0, it is not found. None: it holds at no step.
template <class Predicate>
std::optional<double> farthest(double limit, Predicate holds) {
    constexpr int steps = 32;
    constexpr int bisections = 45; // 2^-45 of a step
    for (int step = steps; step >= 0; --step) {
        double inside = limit * step / steps;
        if (!holds(inside)) {
            continue;
        }
        double outside = limit * std::min(step + 1, steps) / steps;
        for (int i = 0; i < bisections; ++i) {
            const double middle = 0.5 * (inside + outside);
            (holds(middle) ? inside : outside) = middle;
        }
        return inside;
    }
    return std::nullopt;
}

// Everything that decides where light from the specimen lands.
struct Imaging {
    std::vector<Surface> train;
    double working_distance = 0;
    double detector_distance = 0;
    double pupil_curvature = 0; // of EntrancePupil, from the paraxial object plane

    // Detector coordinates of light from (x, y) at `height` above the paraxial object plane, with direction
    // cosines l and m. None: it does not come so far.
    std::optional<glm::dvec2> trace(glm::dvec2 position, double height, glm::dvec2 cosines,
                                    unsigned apertures = 1u) const {
        const double axial_squared = 1 - glm::dot(cosines, cosines);
        if (axial_squared <= 0) {
            return std::nullopt;
        }
        Ray ray{};
        ray.position = real3(position, height - working_distance);
        ray.direction = real3(cosines, std::sqrt(axial_squared));
        const auto result =
            physics::f64::trace_train(TrainScene{train}, 0, static_cast<int>(train.size()), ray, apertures);
        if (result.status != PATH_ALIVE) {
            return std::nullopt;
        }
        const auto arrived = physics::f64::fly_to_plane(result.ray, detector_distance, 1.0);
        return glm::dvec2(arrived.position.x, arrived.position.y);
    }

    // Direction cosines through the paraxial centre of the pupil.
    glm::dvec2 chief_cosines(glm::dvec2 position) const {
        const glm::dvec2 slope = -pupil_curvature * position;
        return slope / std::sqrt(1 + glm::dot(slope, slope));
    }
};

// The outline of the cone of light that passes all apertures from a point of the paraxial object plane, as
// radii in direction cosines about the chief ray; by symmetry over half a turn, for points on the x axis.
struct Outline {
    glm::dvec2 position;
    glm::dvec2 centre;         // direction cosines
    std::vector<double> radii; // at azimuths (i + 1/2) * step: midpoints, for integrals
    double step = 0;

    glm::dvec2 cosines(std::size_t azimuth, double radius) const {
        const double angle = (static_cast<double>(azimuth) + 0.5) * step;
        return centre + radius * glm::dvec2(std::cos(angle), std::sin(angle));
    }
    double area() const { // in direction cosines, of both halves
        double sum = 0;
        for (const double radius : radii) {
            sum += radius * radius * step;
        }
        return sum;
    }
};

Outline outline_at(const Imaging& imaging, double x) {
    constexpr std::size_t azimuths = 24;
    Outline outline{
        .position = {x, 0}, .centre = imaging.chief_cosines({x, 0}), .radii = {}, .step = pi / azimuths};
    for (std::size_t i = 0; i < azimuths; ++i) {
        // Beyond 1 + |centre| no direction cosines exist.
        const auto radius = farthest(1 + glm::length(outline.centre), [&](double candidate) {
            return imaging.trace(outline.position, 0, outline.cosines(i, candidate)).has_value();
        });
        outline.radii.push_back(radius.value_or(0));
    }
    return outline;
}

// Height above the paraxial plane at which the RMS distance of the outline's light from its centroid on the
// detector is least. The cone is that of the paraxial plane. The landing points are all but linear in the
// height, so Gauss and Newton's method on their deviations from the centroid converges in two steps; three
// leave rounding.
double best_focus(const Imaging& imaging, const Outline& outline) {
    // Gauss-Legendre over [-1, 1] (Abramowitz and Stegun, table 25.4) in the share of the cone that a ring
    // encloses: exact for squared aberrations up to the 30th power of the pupil's radius.
    constexpr std::array<std::pair<double, double>, 8> rings = {{{-0.9602898564975363, 0.1012285362903763},
                                                                 {-0.7966664774136267, 0.2223810344533745},
                                                                 {-0.5255324099163290, 0.3137066458778873},
                                                                 {-0.1834346424956498, 0.3626837833783620},
                                                                 {0.1834346424956498, 0.3626837833783620},
                                                                 {0.5255324099163290, 0.3137066458778873},
                                                                 {0.7966664774136267, 0.2223810344533745},
                                                                 {0.9602898564975363, 0.1012285362903763}}};
    // mm, for the central difference: landing points curve far less than rounding over a micrometre.
    constexpr double difference = 1e-3;
    struct Sample {
        glm::dvec2 landing;
        glm::dvec2 rate; // of the landing with the height
        double weight;
    };
    double height = 0;
    for (int step = 0; step < 3; ++step) {
        std::vector<Sample> samples;
        // Only along x: the other half of the cone has the same x and the opposite y.
        double total = 0;
        double centroid = 0;
        double centroid_rate = 0;
        for (std::size_t i = 0; i < outline.radii.size(); ++i) {
            for (const auto& [node, node_weight] : rings) {
                const glm::dvec2 cosines = outline.cosines(i, outline.radii[i] * std::sqrt(0.5 * (1 + node)));
                const auto below = imaging.trace(outline.position, height - difference, cosines, 0u);
                const auto above = imaging.trace(outline.position, height + difference, cosines, 0u);
                if (!below || !above) {
                    continue;
                }
                const Sample sample{.landing = 0.5 * (*below + *above),
                                    .rate = (*above - *below) / (2 * difference),
                                    .weight = node_weight * outline.radii[i] * outline.radii[i]};
                samples.push_back(sample);
                total += sample.weight;
                centroid += sample.weight * sample.landing.x;
                centroid_rate += sample.weight * sample.rate.x;
            }
        }
        double numerator = 0;
        double denominator = 0;
        for (const Sample& sample : samples) {
            const glm::dvec2 deviation = sample.landing - glm::dvec2(centroid / total, 0);
            const glm::dvec2 rate = sample.rate - glm::dvec2(centroid_rate / total, 0);
            numerator += sample.weight * glm::dot(deviation, rate);
            denominator += sample.weight * glm::dot(rate, rate);
        }
        height -= denominator > 0 ? numerator / denominator : 0;
    }
    return height;
}

// What is found in the finite places that are searched may be exceeded between them: by less than this share,
// as outlines of pupils are smooth but for the corners where two edges meet.
constexpr double search_margin = 1.02;

// The gate: a ray of position x and slope s on a plane at height t above the paraxial one crosses the
// paraxial entrance pupil at p x + (1 + p t) s, up to a factor, where x now stands on the paraxial plane and
// p is the pupil's curvature. Light that reaches the detector comes from within the field; of all of it, over
// field, azimuth and |t| <= greatest_defocus, the largest such crossing is the gate's radius. The crossing is
// convex in s and t, so the rim of each cone and the two ends of t hold the largest.
double gate_radius(const Imaging& imaging, double field_radius, double lowest, double highest) {
    constexpr int field_points = 12;
    double largest = 0;
    for (int i = 0; i <= field_points; ++i) {
        const Outline outline = outline_at(imaging, field_radius * i / field_points);
        for (std::size_t azimuth = 0; azimuth < outline.radii.size(); ++azimuth) {
            if (outline.radii[azimuth] == 0) {
                continue;
            }
            const glm::dvec2 cosines = outline.cosines(azimuth, outline.radii[azimuth]);
            const glm::dvec2 slope = cosines / std::sqrt(1 - glm::dot(cosines, cosines));
            for (const double t : {lowest, highest}) {
                largest = std::max(largest, glm::length(imaging.pupil_curvature * outline.position +
                                                        (1 + imaging.pupil_curvature * t) * slope));
            }
        }
    }
    return search_margin * largest;
}

// Sine of the largest angle at which light leaves the source and passes the train. From each point of the
// source the rim is looked for about the direction that aims at the centre of the field stop: `towards_stop`
// leads from the source to there.
double emission_sine(const std::vector<Surface>& train, double source_radius, double source_distance,
                     const RayTransfer& towards_stop) {
    const auto largest_from = [&](double x) {
        constexpr int azimuths = 13;
        const double slope = -towards_stop.a / towards_stop.b * x;
        const glm::dvec2 centre(slope / std::sqrt(1 + slope * slope), 0);
        double largest = 0;
        for (int i = 0; i < azimuths; ++i) {
            const double angle = pi * i / (azimuths - 1);
            const auto cosines = [&](double radius) {
                return centre + radius * glm::dvec2(std::cos(angle), std::sin(angle));
            };
            const auto radius = farthest(1 + std::abs(centre.x), [&](double candidate) {
                const glm::dvec2 direction = cosines(candidate);
                const double axial_squared = 1 - glm::dot(direction, direction);
                if (axial_squared <= 0) {
                    return false;
                }
                Ray ray{};
                ray.position = real3(x, 0, -source_distance);
                ray.direction = real3(direction, std::sqrt(axial_squared));
                return physics::f64::trace_train(TrainScene{train}, 0, static_cast<int>(train.size()), ray,
                                                 1u)
                           .status == PATH_ALIVE;
            });
            largest = radius ? std::max(largest, glm::length(cosines(*radius))) : largest;
        }
        return largest;
    };
    // The angle grows towards the rim of what the pupil sees of the source, then light stops: two finer
    // rounds about the best point so far close in on it to 1/50 of the source.
    constexpr int points = 6;
    double low = 0;
    double high = source_radius;
    double best = 0;
    double largest = 0;
    for (int round = 0; round < 3; ++round) {
        const double step = (high - low) / points;
        for (int i = 0; i <= points; ++i) {
            const double x = low + i * step;
            if (const double sine = largest_from(x); sine > largest) {
                largest = sine;
                best = x;
            }
        }
        low = std::max(0.0, best - step);
        high = std::min(source_radius, best + step);
    }
    return std::min(1.0, search_margin * largest);
}

} // namespace

Instrument assemble(const InstrumentDescription& description) {
    require_positive(description.source_radius, "source.radius_mm");
    require_positive(description.flux, "source.flux_W");
    require_positive(description.wavelength_um, "source.wavelength_um");
    require_positive(description.detector_size, "detector.size_mm");
    require_positive(description.detector_pixels, "detector.pixels");

    const double wavelength = description.wavelength_um;
    const Part objective = make_part(description.objective, wavelength, "objective.prescription");
    const Part tube_lens = make_part(description.tube_lens, wavelength, "tube_lens.prescription");
    Prescription illumination = description.illumination;
    if (description.field_stop_radius) {
        require_positive(*description.field_stop_radius, "illumination.field_stop_radius_mm");
        const auto given_stop = surface_with_role(illumination, PrescribedSurface::Role::field_stop);
        if (!given_stop) {
            refuse("illumination.field_stop_radius_mm", fmt::format("{}", *description.field_stop_radius),
                   fmt::format("an illuminator with a field stop, which {} has not", illumination.name),
                   "Leave the radius out, or mark a surface with role = \"field stop\".", illumination.file);
        }
        illumination.surfaces[*given_stop].semi_diameter = description.field_stop_radius;
    }
    const Part illuminator = make_part(illumination, wavelength, "illumination.prescription");

    Instrument instrument{};
    instrument.flux = description.flux;
    instrument.splitter_reflectance = description.splitter_reflectance;
    FirstOrder& first_order = instrument.first_order;
    auto& constants = instrument.constants;

    // Imaging: the object in the objective's front focal plane, the detector in the tube lens' back focal
    // plane.
    first_order.efl_objective = focal_length(objective.transfer);
    first_order.efl_tube_lens = focal_length(tube_lens.transfer);
    first_order.working_distance = front_focal_distance(objective.transfer);
    const double detector_distance = back_focal_distance(tube_lens.transfer);
    if (!(first_order.working_distance > 0 && std::isfinite(first_order.working_distance))) {
        refuse("objective.prescription", description.objective.name,
               "an objective whose front focal point lies in front of its first surface",
               "List it from the specimen to the back.", description.objective.file);
    }
    if (!(detector_distance > 0 && std::isfinite(detector_distance))) {
        refuse("tube_lens.prescription", description.tube_lens.name,
               "a tube lens whose back focal point lies behind its last surface",
               "List it from the objective to the detector.", description.tube_lens.file);
    }
    if (!(description.objective_to_tube_lens >= 0)) {
        refuse("tube_lens.distance_mm", fmt::format("{}", description.objective_to_tube_lens),
               "a number >= 0", "Correct it.");
    }
    first_order.magnification = -first_order.efl_tube_lens / first_order.efl_objective;
    const double absolute_magnification = std::abs(first_order.magnification);
    const double field_half_side = 0.5 * description.detector_size / absolute_magnification;
    const double field_half_diagonal = std::sqrt(2.0) * field_half_side;
    first_order.pixel_pitch =
        description.detector_size / description.detector_pixels / absolute_magnification;
    first_order.field_edge = field_half_side;

    const auto aperture_stop =
        surface_with_role(description.objective, PrescribedSurface::Role::aperture_stop);
    if (!aperture_stop || !description.objective.surfaces[*aperture_stop].semi_diameter) {
        refuse("objective.prescription", description.objective.name,
               "one surface that is the aperture stop and has a semi-diameter",
               "Mark the surface that limits the cone with role = \"aperture stop\".",
               description.objective.file);
    }
    const EntrancePupil pupil = entrance_pupil(
        free_space(first_order.working_distance).then(transfer_to_surface(objective.train, *aperture_stop)));

    Imaging imaging{.train = objective.train,
                    .working_distance = first_order.working_distance,
                    .detector_distance = detector_distance,
                    .pupil_curvature = pupil.curvature};
    append(imaging.train, tube_lens.train, description.objective_to_tube_lens);

    const Outline on_axis = outline_at(imaging, 0);
    first_order.numerical_aperture = on_axis.radii.front();
    if (!(first_order.numerical_aperture > 0)) {
        refuse("objective.prescription", description.objective.name,
               "an objective and a tube lens through which the axial ray passes",
               "Check media, radii and semi-diameters.", description.objective.file);
    }
    first_order.depth_of_field =
        wavelength * mm_per_um / (first_order.numerical_aperture * first_order.numerical_aperture);
    first_order.best_focus_offset = best_focus(imaging, on_axis);
    first_order.field_curvature =
        best_focus(imaging, outline_at(imaging, field_half_side)) - first_order.best_focus_offset;
    instrument.front_vertex_height = first_order.working_distance - first_order.best_focus_offset;

    const Outline at_corner = outline_at(imaging, field_half_diagonal);
    const double relative_light = at_corner.area() / on_axis.area();
    if (relative_light < 0.9) {
        instrument.warnings.push_back(fmt::format(
            "The corners of the detector's field receive {:.0f} % of the axial light: lens edges clip "
            "their cones.",
            100 * relative_light));
    }

    // Illumination: the source is imaged into the objective's pupil, as it is seen from the back.
    const std::optional<double> source_distance =
        description.source_distance ? description.source_distance : illumination.source_distance;
    if (!source_distance || !(*source_distance >= 0)) {
        refuse("source.distance_mm", source_distance ? fmt::format("{}", *source_distance) : "",
               "the distance from the source to the illuminator, >= 0",
               "Give it, or source_distance_mm in the prescription.", illumination.file);
    }
    const ParaxialImage source_image = image_of(illuminator.transfer, *source_distance);
    const std::vector<Surface> objective_backward = train_of(description.objective.reversed(), wavelength);
    const RayTransfer back_to_stop =
        transfer_to_surface(objective_backward, objective_backward.size() - 1 - *aperture_stop);
    const EntrancePupil back_pupil = entrance_pupil(back_to_stop);
    const double stop_radius = *description.objective.surfaces[*aperture_stop].semi_diameter;
    // The stop's image has 1 / a its size; a = 0 has none.
    const double back_pupil_distance = 1 / back_pupil.curvature;
    const double back_pupil_radius = stop_radius / std::abs(back_to_stop.a);
    if (description.illumination_to_objective) {
        first_order.illumination_to_objective = *description.illumination_to_objective;
    } else {
        first_order.illumination_to_objective = source_image.distance - back_pupil_distance;
    }
    if (!(first_order.illumination_to_objective >= 0 &&
          std::isfinite(first_order.illumination_to_objective))) {
        refuse("illumination.objective_distance_mm",
               fmt::format("{:.6g}", first_order.illumination_to_objective),
               fmt::format("room between {} and {} so that the source is imaged into the pupil",
                           illumination.name, description.objective.name),
               "Give a distance >= 0, or move the source nearer to the illuminator's focal plane.",
               illumination.file);
    }
    const double source_magnification = std::abs(source_image.magnification);
    first_order.pupil_radius_in_source = back_pupil_radius / source_magnification;
    if (description.source_radius < 0.98 * first_order.pupil_radius_in_source) {
        instrument.warnings.push_back(fmt::format(
            "The source does not fill the objective's pupil: its radius is {:.4g} mm, filling takes "
            "{:.4g} mm.",
            description.source_radius, first_order.pupil_radius_in_source));
    }
    const double image_to_pupil =
        first_order.illumination_to_objective + back_pupil_distance - source_image.distance;
    if (!(std::abs(image_to_pupil) < 0.05 * first_order.efl_objective)) {
        instrument.warnings.push_back(fmt::format(
            "The source is imaged {:.3g} mm in front of the objective's pupil instead of into it.",
            image_to_pupil));
    }

    std::vector<Surface> illumination_train = illuminator.train;
    append(illumination_train, objective_backward, first_order.illumination_to_objective);
    const auto field_stop = surface_with_role(illumination, PrescribedSurface::Role::field_stop);
    if (field_stop && illumination.surfaces[*field_stop].semi_diameter) {
        const RayTransfer before = transfer_to_surface(illumination_train, *field_stop);
        const RayTransfer whole =
            transfer_of_train(illumination_train).then(free_space(first_order.working_distance));
        // whole = after * before, so after = whole * before^-1; its first element is the stop's
        // magnification.
        const double magnification = whole.a * before.d - whole.b * before.c;
        const double lit_radius = std::abs(magnification) * *illumination.surfaces[*field_stop].semi_diameter;
        if (lit_radius < field_half_diagonal) {
            instrument.warnings.push_back(fmt::format(
                "The field stop's image, {:.4g} mm in radius on the specimen, does not cover the detector's "
                "field, {:.4g} mm to its corners.",
                lit_radius, field_half_diagonal));
        }
    }
    // Without a field stop the last surface limits the field as well as any.
    const double sine = emission_sine(
        illumination_train, description.source_radius, *source_distance,
        free_space(*source_distance)
            .then(transfer_to_surface(illuminator.train, field_stop.value_or(illuminator.train.size() - 1))));
    if (!(sine > 0)) {
        refuse("illumination.prescription", illumination.name,
               "an illuminator whose light passes the objective", "Check distances and semi-diameters.",
               illumination.file);
    }

    std::size_t place = 0;
    name_surfaces(instrument.surface_names, "illumination", place, illumination, false);
    name_surfaces(instrument.surface_names, "illumination", place, description.objective, true);
    place = 0;
    name_surfaces(instrument.surface_names, "imaging", place, description.objective, false);
    name_surfaces(instrument.surface_names, "imaging", place, description.tube_lens, false);

    constants.source_radius = description.source_radius;
    constants.source_distance = *source_distance;
    constants.emission_sine = description.directed_emission ? sine : 1;
    constants.magnification = first_order.magnification;
    constants.detector_distance = detector_distance;
    constants.detector_half_size = 0.5 * description.detector_size;
    constants.gate_position = pupil.curvature;
    constants.gate_slope = 1;
    // A little more than the field: aberrations let the detector see past its paraxial edge.
    constants.gate_radius = gate_radius(imaging, 1.05 * field_half_diagonal,
                                        first_order.best_focus_offset - description.greatest_defocus,
                                        first_order.best_focus_offset + description.greatest_defocus);
    constants.illumination_first = 0;
    constants.illumination_count = static_cast<int>(illumination_train.size());
    constants.imaging_first = constants.illumination_count;
    constants.imaging_count = static_cast<int>(imaging.train.size());
    constants.detector_pixels = description.detector_pixels;
    instrument.illumination_surfaces_before_splitter = static_cast<int>(illuminator.train.size());
    instrument.imaging_surfaces_before_splitter = static_cast<int>(objective.train.size());
    instrument.surfaces = std::move(illumination_train);
    instrument.surfaces.insert(instrument.surfaces.end(), imaging.train.begin(), imaging.train.end());
    return instrument;
}

} // namespace vkfv::optics
