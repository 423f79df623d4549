// The reversed form of the instrument, for paths that start at the detector.
#include "optics/instrument/assembly.hpp"

#include "core/threads/parallel_list.hpp"
#include "optics/instrument/turning.hpp"
#include "optics/train/first_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;

namespace {

constexpr double outside_margin = 1.02; // outlines are sampled at finitely many places: see apertures.cpp
constexpr double inside_margin = 0.99;
// Towards the field's edge the region of crossings that certainly receive light may shrink to this share of its size on
// the axis.
constexpr double inside_share = 0.97;

// The position (mm) and slope on the detector of a ray on an outline's rim.
struct Rim {
    glm::dvec2 position;
    glm::dvec2 slope;
};

std::vector<Rim> rims_at_detector(const Imaging& imaging, const Outline& outline) {
    std::vector<Rim> rims;
    for (std::size_t azimuth = 0; azimuth < outline.radii.size(); ++azimuth) {
        if (outline.radii[azimuth] == 0) {
            continue;
        }
        // The factor keeps the ray within the rim, which rounding may put on either side of an edge.
        const glm::dvec2 cosines = outline.cosines(azimuth, (1 - 1e-9) * outline.radii[azimuth]);
        physics::f64::Ray ray{};
        ray.position = glm::dvec3(outline.position, -imaging.working_distance);
        ray.direction = glm::dvec3(cosines, std::sqrt(1 - glm::dot(cosines, cosines)));
        const auto traced = trace_through(imaging.train, ray, 1);
        const auto landed = physics::f64::fly_to_plane(traced.ray, imaging.detector_distance, traced.index);
        rims.push_back({glm::dvec2(landed.position), glm::dvec2(landed.direction) / landed.direction.z});
    }
    return rims;
}

// The smallest and the largest |curvature * position + slope| on a cone's rim; the smallest is 0 if part of the cone is
// dark.
std::pair<double, double> crossings(const Outline& outline, double curvature) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (std::size_t azimuth = 0; azimuth < outline.radii.size(); ++azimuth) {
        const glm::dvec2 cosines = outline.cosines(azimuth, outline.radii[azimuth]);
        const glm::dvec2 slope = cosines / std::sqrt(1 - glm::dot(cosines, cosines));
        const double crossing = glm::length(curvature * outline.position + slope);
        least = std::min(least, outline.radii[azimuth] > 0 ? crossing : 0.0);
        most = outline.radii[azimuth] > 0 ? std::max(most, crossing) : most;
    }
    return {least, most};
}

// The exit pupil as the detector sees it: a disc of slopes about per_position times the position on the detector.
struct ExitPupil {
    double per_position = 0; // 1/mm, slope of the chief ray per position on the detector
    double radius = 0;       // radius of the disc in slope; no light comes from outside
    double rim = 0;          // radius of the pupil's edge in slope; 0: no circle, or not the same all over the field
};

// The value of per_position that makes the rims' distances from the pupil's centre most equal, as those of a circle
// are. For small changes |slope - per_position position| is linear in per_position, so the differences are a linear
// fit.
double with_level_rims(double per_position, const std::vector<Rim>& rims) {
    double count = 0, distances = 0, rates = 0, products = 0, squares = 0;
    for (const Rim& rim : rims) {
        const glm::dvec2 crossing = rim.slope - per_position * rim.position;
        const double distance = glm::length(crossing);
        const double rate = -glm::dot(crossing, rim.position) / distance;
        count += 1;
        distances += distance;
        rates += rate;
        products += distance * rate;
        squares += rate * rate;
    }
    return per_position - (products - distances * rates / count) / (squares - rates * rates / count);
}

ExitPupil exit_pupil(const Imaging& imaging, double field_half_width, double field_radius, const DetectorHulls& hulls) {
    glm::dvec2 mean_position(0);
    glm::dvec2 mean_slope(0);
    const auto add = [&](glm::dvec2 field, double times) {
        for (const Rim& rim : rims_at_detector(imaging, outline_at(imaging, field))) {
            mean_position += times * rim.position;
            mean_slope += times * rim.slope;
        }
    };
    add({field_half_width, 0}, 1);
    if (!imaging.symmetric) {
        add({0, 0}, -1); // a tilted detector sees all pupils obliquely
    }
    ExitPupil pupil;
    pupil.per_position = glm::dot(mean_slope, mean_position) / glm::dot(mean_position, mean_position);
    constexpr int field_points = 12;
    std::vector<Rim> all;
    for (const glm::dvec2& direction : search_directions(imaging.symmetric)) {
        for (const std::vector<Rim>& rims : parallel_list(field_points + 1, [&](int i) {
                 return rims_at_detector(imaging, outline_at(imaging, direction * (field_radius * i / field_points)));
             })) {
            all.insert(all.end(), rims.begin(), rims.end());
        }
    }
    if (imaging.symmetric) {
        pupil.per_position = with_level_rims(pupil.per_position, all);
    }
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    double sum = 0;
    for (const Rim& rim : all) {
        const double distance = glm::length(rim.slope - pupil.per_position * rim.position);
        least = std::min(least, distance);
        most = std::max(most, distance);
        sum += distance;
    }
    const double hull = hulls.pupil_radius(pupil.per_position);
    pupil.radius = std::max(outside_margin * most, hull);
    if (hulls.spectral().radius() > 0) { // other wavelengths have other rims
        most = std::max(most, hull);
        least = std::min(least, hulls.least_pupil_rim(pupil.per_position, pupil.radius));
    }
    // The least ratio of smallest to largest rim at which the pupil counts as a circle. Otherwise the rim serves no
    // purpose and is left out: the disc contains all light anyway.
    constexpr double level = 0.99;
    pupil.rim = !all.empty() && least > level * most ? sum / static_cast<double>(all.size()) : 0;
    return pupil;
}

// The source as points of the specimen see it, in crossings of their rays (BackwardOptics).
struct SeenSource {
    double outer = 0;        // no light comes from outside this crossing
    double inner = 0;        // all light inside this crossing comes from the source
    double inner_radius = 0; // mm, radius of the field in which `inner` holds
};

SeenSource seen_source(const Imaging& seen, double seen_radius) {
    constexpr int field_points = 48;
    const double on_axis = crossings(outline_at(seen, {0, 0}), seen.pupil_curvature).first;
    double outer = 0;
    double inner = on_axis;
    int sure_points = field_points;
    for (const glm::dvec2& direction : search_directions(seen.symmetric)) {
        const auto crossed = parallel_list(field_points + 1, [&](int i) {
            return crossings(outline_at(seen, direction * (seen_radius * i / field_points)), seen.pupil_curvature);
        });
        for (int i = 0; i <= field_points; ++i) {
            const auto [least, most] = crossed[static_cast<std::size_t>(i)];
            outer = std::max(outer, outside_margin * most);
            if (least < inside_share * on_axis) {
                sure_points = std::min(sure_points, i - 1);
            } else if (i <= sure_points) {
                inner = std::min(inner, least);
            }
        }
    }
    return {.outer = outer,
            .inner = sure_points < 0 ? 0 : inside_margin * inner,
            .inner_radius = inside_margin * seen_radius * std::max(sure_points, 0) / field_points};
}

// Light between the specimen and the source, and its crossings, from slopes at the paraxial object plane:
// BackwardOptics.
class SourceLight {
  public:
    // The caller keeps to_source alive. reach: the approximate size of the crossing.
    SourceLight(const std::vector<Surface>& to_source, const AxialLayout& layout, const DetectorHulls& hulls,
                double source_position, double reach)
        : light_{.train = to_source,
                 .radius = 0,
                 .distance = {},
                 .spectral = hulls.spectral(),
                 .middle = glm::dvec2(0),
                 .towards = -source_position,
                 .reach = reach,
                 .symmetric = !has_displaced(to_source)},
          source_position_(source_position), working_distance_(layout.working_distance) {}

    // The largest crossing of light from within field_radius (mm) at any of the heights (mm).
    double largest_crossing(double field_radius, const Range& heights) const {
        return greatest_of(from(field_radius, heights), ConePart::rim,
                           [&](const PassingRay& ray) { return crossing(ray); });
    }
    // The least crossing on the rims of the cones from within field_radius (mm) on the object plane; no crossing
    // exceeds `largest`.
    double least_rim(double field_radius, double largest) const {
        return largest - greatest_of(from(field_radius, {}), ConePart::rim,
                                     [&](const PassingRay& ray) { return std::max(0.0, largest - crossing(ray)); });
    }

  private:
    DiscLight from(double field_radius, const Range& heights) const {
        DiscLight light = light_;
        light.radius = field_radius;
        light.distance = {working_distance_ - heights.high, working_distance_ - heights.low};
        return light;
    }
    double crossing(const PassingRay& ray) const {
        const glm::dvec2 place = ray.start + (ray.distance - working_distance_) * ray.start_slope;
        return glm::length(source_position_ * place + ray.start_slope);
    }

    DiscLight light_;
    double source_position_;
    double working_distance_;
};

// The train ends with the outline of a disc of this radius (mm); for a ring light it holds the cover glass at most.
PlacedSurfaces specimen_to_source(const InstrumentDescription& description, const AxialLayout& layout,
                                  const Illumination& illumination, double radius) {
    PlacedSurfaces train = reversed(illumination.train);
    if (description.source.ring) {
        link(train, layout.front);
        return train;
    }
    PlacedSurface source = dummy_plane(layout.air, illumination.source_pose.half_turn(), "source");
    source.surface.flags |= physics::f64::SURFACE_CLIPPED;
    source.surface.semi_diameter_squared = radius * radius;
    train.push_back(source);
    link(train, layout.front);
    return train;
}

// Sets the ring light from which backward paths draw points. A cover glass shifts light sideways by less than its
// thickness where it is the denser medium: a ring widened by that, all round, contains all points that emit.
void draw_ring(physics::f64::BackwardOptics& optics, const InstrumentDescription& description,
               const physics::f64::Instrument& constants, const std::vector<Surface>& to_source) {
    double from_front = 0; // distance to the frame in which light enters the train
    for (std::size_t i = 1; i < to_source.size(); ++i) {
        from_front += to_source[i].distance;
    }
    optics.object_distance = constants.ring.aim_distance - from_front;
    optics.ring = constants.ring;
    optics.ring_is_bare = to_source.empty() ? 1u : 0u;
    optics.ring_cosine = std::sqrt(1 - constants.emission_sine * constants.emission_sine);
    if (!to_source.empty()) {
        if (!can_turn_round(description)) {
            refuse("trace.estimator", "\"backward\"", "a cover glass denser than the immersion, under a ring light",
                   "Use estimator = \"forward\", or another glass.");
        }
        // The more grazing the light is at the band, the farther a sideways shift moves its point along the band.
        const double flattest = std::max(optics.ring_cosine, 1e-2);
        optics.ring.half_width += std::max(2.0, 1 / flattest) * description.cover_glass->thickness;
        optics.ring.fill = 1;
        optics.ring.segments = 1;
        optics.ring.switched_on = 1;
        optics.ring_cosine = 0;
    }
    optics.ring_area = physics::f64::ring_area(optics.ring);
}

} // namespace

TurnedInstrument turn_round(const InstrumentDescription& description, const AxialLayout& layout,
                            const ImagingTrain& imaging, const DetectorHulls& hulls, const Illumination& illumination,
                            const Instrument& instrument) {
    const std::vector<Surface>& to_specimen = imaging.from_detector;
    const SourceDescription& source = description.source;
    const auto to_disc = [&](double radius) {
        return surfaces_of(specimen_to_source(description, layout, illumination, radius));
    };
    const std::vector<Surface> to_source = to_disc(source.outer_radius());
    TurnedInstrument turned;
    turned.surfaces = to_specimen;
    turned.surfaces.insert(turned.surfaces.end(), to_source.begin(), to_source.end());
    turned.constants = instrument.constants;
    turned.constants.illumination_count = static_cast<int>(to_specimen.size());
    turned.constants.imaging_first = turned.constants.illumination_count;
    turned.constants.imaging_count = static_cast<int>(to_source.size());

    const double field_radius = 1.05 * layout.seen_half_diagonal();
    const ExitPupil pupil = exit_pupil(imaging.imaging, layout.field_corner.x, field_radius, hulls);
    auto& optics = turned.optics;
    optics.pupil_radius = pupil.radius;
    turned.pupil_rim = pupil.rim;
    // Half a turn about x and the opposite direction turn (x, y) into (x, -y) and slopes (s, t) into (-s, t): the
    // pupil's crossing, slope - per_position * position, only changes its sign.
    optics.pupil_position = pupil.per_position;

    if (description.source.ring) {
        draw_ring(optics, description, turned.constants, to_source);
        return turned;
    }
    const RayTransfer whole = free_space(layout.working_distance, layout.object_index.centre)
                                  .then(free_space(to_source.front().distance))
                                  .then(transfer_of_train(to_source));
    optics.source_position = whole.a / (whole.b * layout.object_index.centre);
    optics.object_distance = layout.working_distance;
    const double seen_radius = field_radius + description.greatest_defocus;
    const auto seen_through = [&](const std::vector<Surface>& train) {
        return seen_source({.train = train,
                            .working_distance = layout.working_distance,
                            .detector_distance = 0,
                            .pupil_curvature = optics.source_position,
                            .symmetric = !has_displaced(train)},
                           seen_radius);
    };
    SeenSource seen = seen_through(to_source);
    constexpr double any_slope = 1; // serves if no light of the reference wavelength comes from the source
    const auto light_through = [&](const std::vector<Surface>& train) {
        return SourceLight(train, layout, hulls, optics.source_position, seen.outer > 0 ? seen.outer : any_slope);
    };
    // Light that is scattered more than once may come from outside the detector's field, up to seen_radius.
    optics.source_outer = std::max(seen.outer, light_through(to_source).largest_crossing(
                                                   std::max(seen_radius, hulls.field_radius()), hulls.heights()));
    // For a rectangle, only light of its inscribed circle is certain.
    const std::vector<Surface> to_inner = source.rectangle ? to_disc(source.inner_radius()) : to_source;
    seen = source.rectangle ? seen_through(to_inner) : seen;
    // With several wavelengths rims differ, and losses require tracing, so no light is certain.
    const bool nothing_sure =
        !description.spectrum.monochromatic() || (instrument.features & physics::f64::FEATURE_LOSSES) != 0;
    if (!nothing_sure && seen.inner > 0) {
        optics.source_inner =
            std::min(seen.inner, light_through(to_inner).least_rim(seen.inner_radius, optics.source_outer));
    }
    optics.inner_field = seen.inner_radius;
    return turned;
}

Instrument turned_round(const Instrument& instrument) {
    Instrument turned = instrument;
    turned.surfaces = instrument.turned.value().surfaces;
    turned.constants = instrument.turned.value().constants;
    turned.surface_names.resize(turned.surfaces.size());
    return turned;
}

bool can_turn_round(const InstrumentDescription& description) {
    const auto sources = description.sources();
    const bool ring =
        std::ranges::any_of(sources, [](const SourceDescription* source) { return source->ring.has_value(); });
    if (!ring || !description.cover_glass) {
        return true;
    }
    const Medium& medium = description.immersion.value_or(description.objective.medium_before);
    return std::ranges::none_of(
        std::array{description.spectrum.shortest_um, description.spectrum.longest_um}, [&](double wavelength_um) {
            return description.cover_glass->glass.index(wavelength_um) < medium.index(wavelength_um);
        });
}

} // namespace vkfv::optics
