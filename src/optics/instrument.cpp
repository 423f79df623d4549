#include "optics/instrument.hpp"

#include "core/error.hpp"
#include "core/units.hpp"
#include "optics/apertures.hpp"
#include "optics/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace vkfv::optics {

namespace {

using physics::f64::Surface;
using Role = PrescribedSurface::Role;
using Part = std::vector<PlacedSurface>;

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

// Half a turn about x: the frame of light that comes down.
Pose downward(double height) {
    return Pose{}.along_z(height).half_turn();
}

// A whole part moved: what was given against `from` then stands the same way against `to`.
void move(Part& part, const Pose& from, const Pose& to) {
    const glm::dmat3 turn = to.axes * glm::transpose(from.axes);
    for (PlacedSurface& placed : part) {
        placed.pose = {to.origin + turn * (placed.pose.origin - from.origin), turn * placed.pose.axes};
    }
}

Pose placed_at(const Placement& placement, const Pose& nominal) {
    if (placement.global) {
        Pose corner;
        corner.origin = *placement.global;
        return corner.turned(placement.change);
    }
    return nominal.turned(placement.change);
}

Surface transfer_between(const Pose& from, const PlacedSurface& to) {
    Part part = {to};
    link(part, from);
    return part.front().surface;
}

void append(Part& train, const Part& part) {
    train.insert(train.end(), part.begin(), part.end());
}

// "imaging 3 (10x_0.28 3, aperture stop)": the place in the train, and in the prescription as its file counts.
void name_surfaces(std::vector<std::string>& names, const char* train, const Part& surfaces) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        names.push_back(fmt::format("{} {} ({})", train, i + 1, surfaces[i].name));
    }
}

// The parts, each in the specimen's frame with its origin in the paraxial object plane, unfolded.
struct Layout {
    const InstrumentDescription& description;
    const Spectrum& spectrum;
    SpectralIndex air;

    explicit Layout(const InstrumentDescription& given)
        : description(given), spectrum(given.spectrum), air(spectral_index(Medium::air(), given.spectrum)) {}

    Element element(Element::Kind kind, const PlacedSurface& placed, const char* part) const {
        Element result;
        result.kind = (placed.surface.flags & physics::f64::SURFACE_IDEAL_LENS) != 0 ? Element::Kind::ideal_lens
                      : kind == Element::Kind::surface &&
                              placed.surface.index_before == placed.surface.index_after
                          ? Element::Kind::stop
                          : kind;
        result.surface = placed.surface;
        result.pose = placed.pose;
        result.name = placed.name;
        result.part = part;
        return result;
    }

    // A plate of glass between two planes; `medium` on both sides.
    Part plate(const Pose& first, double thickness, const Medium& glass, const Medium& medium,
               std::optional<double> semi_diameter, const std::string& name) const {
        Prescription prescription;
        prescription.name = name;
        prescription.medium_before = medium;
        PrescribedSurface surface;
        surface.semi_diameter = semi_diameter;
        surface.thickness = thickness;
        surface.medium_after = glass;
        prescription.surfaces = {surface, surface};
        prescription.surfaces.back().medium_after = medium;
        Pose end;
        return place_prescription(prescription, spectrum, description.interfaces, first, end);
    }

    PlacedSurface mirror_plane(const Pose& pose, std::optional<double> semi_diameter, std::string name) const {
        PlacedSurface mirror = dummy_plane(air, pose, std::move(name));
        mirror.surface.flags |= physics::f64::SURFACE_MIRROR;
        mirror.surface.reflectance = 1;
        if (semi_diameter) {
            mirror.surface.flags |= physics::f64::SURFACE_CLIPPED;
            mirror.surface.semi_diameter_squared = *semi_diameter * *semi_diameter;
        }
        return mirror;
    }
};

// What stands in the infinity space of one train, in the order of its light.
struct Inserted {
    double distance = 0;
    Part surfaces;
};

RayTransfer transfer_of(Part part) {
    link(part, part.front().pose);
    return transfer_of_train(surfaces_of(part));
}

Prescription with_stops(const InstrumentDescription& description, Prescription prescription, Role role,
                        std::optional<double> radius, const char* key) {
    if (!radius) {
        return prescription;
    }
    require_positive(*radius, key);
    const auto found = std::ranges::find(prescription.surfaces, role, &PrescribedSurface::role);
    if (found == prescription.surfaces.end()) {
        refuse(key, fmt::format("{}", *radius),
               fmt::format("a part with such a stop, which {} has not", prescription.name),
               "Leave the radius out, or mark a surface with its role.", prescription.file);
    }
    found->semi_diameter = radius;
    (void)description;
    return prescription;
}

void require_surfaces(const Prescription& prescription, const char* key) {
    if (prescription.surfaces.empty()) {
        refuse(key, prescription.name, "a prescription with surfaces", "Add a [[surface]].", prescription.file);
    }
}

void require_air(double index, const Prescription& prescription, const char* key) {
    if (index != 1) {
        refuse(key, prescription.name, "a part that stands in air",
               "Remove medium_before and the medium of the last surface.", prescription.file);
    }
}

} // namespace

Instrument assemble(const InstrumentDescription& description) {
    if (!description.ring) {
        require_positive(description.source_radius, "source.radius_mm");
    }
    require_positive(description.flux, "source.flux_W");
    require_positive(description.spectrum.reference_um, "source.wavelength_um");
    require_positive(description.detector_size, "detector.size_mm");
    require_positive(description.detector_pixels, "detector.pixels");
    require_surfaces(description.objective, "objective.prescription");
    require_surfaces(description.tube_lens, "tube_lens.prescription");

    const Layout layout(description);
    const Spectrum& spectrum = description.spectrum;
    const double wavelength = spectrum.reference_um;

    Instrument instrument{};
    instrument.flux = description.flux;
    instrument.splitter_reflectance = description.ring ? 1 : description.splitter.reflectance;
    instrument.splitter_transmittance = description.splitter.transmittance;
    instrument.spectral_bins = spectrum.bins;
    FirstOrder& first_order = instrument.first_order;
    auto& constants = instrument.constants;

    // Paraxially: the object in the front focal plane of the objective behind its cover glass, the detector in the tube
    // lens' back focal plane.
    Prescription objective_lens = with_stops(description, description.objective, Role::aperture_stop,
                                             description.aperture_stop_radius, "objective.aperture_stop_radius_mm");
    if (description.immersion) {
        objective_lens.medium_before = *description.immersion;
    }
    const Medium& object_medium = objective_lens.medium_before;
    const SpectralIndex object_index = spectral_index(object_medium, spectrum);
    first_order.object_index = object_index.centre;
    Pose end;
    const Part straight_objective =
        place_prescription(objective_lens, spectrum, description.interfaces, Pose{}, end);
    const double objective_length = end.origin.z;
    require_air(straight_objective.back().surface.index_after, description.objective, "objective.prescription");
    const RayTransfer objective_transfer = transfer_of(straight_objective);
    const Part straight_tube_lens =
        place_prescription(description.tube_lens, spectrum, description.interfaces, Pose{}, end);
    require_air(straight_tube_lens.front().surface.index_before, description.tube_lens, "tube_lens.prescription");
    require_air(straight_tube_lens.back().surface.index_after, description.tube_lens, "tube_lens.prescription");
    const RayTransfer tube_lens_transfer = transfer_of(straight_tube_lens);
    first_order.efl_objective = focal_length(objective_transfer);
    first_order.efl_tube_lens = focal_length(tube_lens_transfer);
    // Without a cover glass; in the medium before the objective.
    const double free_distance = object_index.centre * front_focal_distance(objective_transfer);
    const double detector_distance = back_focal_distance(tube_lens_transfer);
    if (!(free_distance > 0 && std::isfinite(free_distance))) {
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

    // Heights over the paraxial object plane. A plate of thickness t shortens the way by t (1 - n0 / n).
    double objective_front = free_distance;
    Part cover;
    first_order.working_distance = free_distance;
    if (description.cover_glass) {
        const CoverGlass& glass = *description.cover_glass;
        require_positive(glass.thickness, "cover_glass.thickness_mm");
        const double index = glass.glass.index(wavelength);
        const double free_way = free_distance - glass.thickness * object_index.centre / index;
        const double height = glass.distance.value_or(0.5 * free_way);
        if (!(height > 0 && height < free_way)) {
            refuse("cover_glass.thickness_mm", fmt::format("{} mm, {:.6g} mm over the focus", glass.thickness, height),
                   fmt::format("a plate between the focus and the objective, which is {:.6g} mm away without it",
                               free_distance),
                   "Choose a thinner plate, or another distance_mm.");
        }
        cover = layout.plate(Pose{}.along_z(height), glass.thickness, glass.glass, object_medium, std::nullopt,
                             "cover glass");
        objective_front = free_way + glass.thickness;
        first_order.working_distance = height;
    }
    const Pose front = Pose{}.along_z(first_order.working_distance);
    const double back = objective_front + objective_length;

    // Imaging, from the specimen to the detector.
    const Part objective =
        place_prescription(objective_lens, spectrum, description.interfaces,
                           placed_at(description.objective_placement, Pose{}.along_z(objective_front)), end);
    const BeamSplitter& splitter = description.splitter;
    const double splitter_distance = splitter.distance.value_or(0.5 * description.objective_to_tube_lens);
    const double splitter_height = back + splitter_distance;
    // The coated side faces the specimen and the illuminator, which stands at +y.
    constexpr double quarter_turn = pi / 2;
    const Pose splitter_pose = Pose{}.along_z(splitter_height).turned({.tilt_x = 0.5 * quarter_turn});
    const double half_size = 0.5 * splitter.size;
    Part splitter_imaging;
    int splitter_surfaces_before = 0;
    if (splitter.kind == BeamSplitter::Kind::plate) {
        splitter_imaging = layout.plate(splitter_pose, splitter.size, splitter.glass, Medium::air(),
                                        splitter.semi_diameter, "beam splitter");
        // What its coating reflects is the splitter's reflectance.
        splitter_imaging.front().surface.flags &=
            ~(physics::f64::SURFACE_FRESNEL | physics::f64::SURFACE_LAYER);
        splitter_surfaces_before = 1;
    } else if (splitter.kind == BeamSplitter::Kind::cube) {
        splitter_imaging =
            layout.plate(Pose{}.along_z(splitter_height - half_size), splitter.size, splitter.glass, Medium::air(),
                         splitter.semi_diameter.value_or(half_size), "beam splitter");
        splitter_surfaces_before = 1;
    }
    std::vector<Inserted> inserted = {{splitter_distance, splitter_imaging}};
    struct Fold {
        FoldMirror::Path path;
        double distance;
        PlacedSurface mirror; // unfolded
    };
    std::vector<Fold> folds;
    const auto add_fold = [&](const FoldMirror& fold, const Pose& axis, std::vector<Inserted>& into) {
        require_positive(fold.semi_diameter, "fold_mirror.semi_diameter_mm");
        const Pose pose = axis.turned({.tilt_z = fold.azimuth}).turned({.tilt_x = fold.incidence});
        PlacedSurface mirror = layout.mirror_plane(pose, fold.semi_diameter, "fold mirror");
        mirror.surface.reflectance = fold.reflectance;
        folds.push_back({fold.path, fold.distance, mirror});
        into.push_back({fold.distance, {mirror}});
    };
    const auto key_of = [&](const FoldMirror& fold) {
        return fmt::format("fold_mirror[{}].distance_mm", &fold - description.fold_mirrors.data());
    };
    for (const FoldMirror& fold : description.fold_mirrors) {
        if (fold.path == FoldMirror::Path::imaging) {
            if (!(fold.distance > splitter_distance)) {
                refuse(key_of(fold), fmt::format("{}", fold.distance),
                       fmt::format("a place behind the beam splitter, which is {:.6g} mm behind the objective",
                                   splitter_distance),
                       "Move the fold mirror or the beam splitter.");
            }
            add_fold(fold, Pose{}.along_z(back + fold.distance), inserted);
        }
    }
    std::ranges::stable_sort(inserted, {}, &Inserted::distance);
    Part imaging_train = cover;
    append(imaging_train, objective);
    instrument.imaging_surfaces_before_splitter =
        static_cast<int>(imaging_train.size()) + splitter_surfaces_before;
    for (const Inserted& part : inserted) {
        if (!(part.distance >= 0 && part.distance <= description.objective_to_tube_lens)) {
            refuse("tube_lens.distance_mm", fmt::format("{}", description.objective_to_tube_lens),
                   fmt::format("room for what stands {:.6g} mm behind the objective", part.distance),
                   "Move the beam splitter or fold mirror, or the tube lens.");
        }
        append(imaging_train, part.surfaces);
    }
    const Pose tube_lens_nominal = Pose{}.along_z(back + description.objective_to_tube_lens);
    const Part tube_lens =
        place_prescription(description.tube_lens, spectrum, description.interfaces,
                           placed_at(description.tube_lens_placement, tube_lens_nominal), end);
    append(imaging_train, tube_lens);
    const double tube_lens_length = straight_tube_lens.back().pose.origin.z;
    const Pose detector_pose =
        placed_at(description.detector_placement, tube_lens_nominal.along_z(tube_lens_length + detector_distance));
    const PlacedSurface detector_plane = dummy_plane(layout.air, detector_pose, "detector's plane");
    if (is_displaced(transfer_between(imaging_train.back().pose, detector_plane))) {
        imaging_train.push_back(detector_plane);
    }
    link(imaging_train, front);
    constants.detector_distance = glm::dot(detector_pose.origin - imaging_train.back().pose.origin,
                                           imaging_train.back().pose.axes[2]);

    const auto aperture_stop = surface_with_role(objective, Role::aperture_stop);
    if (!aperture_stop || (objective[*aperture_stop].surface.flags & physics::f64::SURFACE_CLIPPED) == 0) {
        refuse("objective.prescription", description.objective.name,
               "one surface that is the aperture stop and has a semi-diameter",
               "Mark the surface that limits the cone with role = \"aperture stop\".",
               description.objective.file);
    }
    const std::vector<Surface> imaging_surfaces = surfaces_of(imaging_train);
    const EntrancePupil pupil =
        entrance_pupil(free_space(first_order.working_distance, object_index.centre)
                           .then(transfer_to_surface(imaging_surfaces, cover.size() + *aperture_stop)));
    const bool displaced = std::ranges::any_of(imaging_surfaces, [](const Surface& surface) {
        return is_displaced(surface);
    });
    const Imaging imaging{.train = imaging_surfaces,
                          .working_distance = first_order.working_distance,
                          .detector_distance = constants.detector_distance,
                          .pupil_curvature = pupil.curvature / object_index.centre,
                          .symmetric = !displaced};

    const Outline on_axis = outline_at(imaging, {0, 0});
    first_order.numerical_aperture = object_index.centre * std::sqrt(on_axis.area() / pi);
    if (!(first_order.numerical_aperture > 0)) {
        refuse("objective.prescription", description.objective.name,
               "an objective and a tube lens through which the axial ray passes",
               "Check media, radii and semi-diameters.", description.objective.file);
    }
    first_order.depth_of_field = object_index.centre * wavelength * mm_per_um /
                                 (first_order.numerical_aperture * first_order.numerical_aperture);
    first_order.best_focus_offset = best_focus(imaging, on_axis);
    first_order.field_curvature =
        best_focus(imaging, outline_at(imaging, {field_half_side, 0})) - first_order.best_focus_offset;
    instrument.front_vertex_height = first_order.working_distance - first_order.best_focus_offset;

    const Outline at_corner = outline_at(imaging, {field_half_diagonal, 0});
    const double relative_light = at_corner.area() / on_axis.area();
    if (relative_light < 0.9) {
        instrument.warnings.push_back(fmt::format(
            "The corners of the detector's field receive {:.0f} % of the axial light: lens edges clip "
            "their cones.",
            100 * relative_light));
    }

    // Illumination, from the source to the specimen. The frame of its end is that of the front vertex, turned.
    const Part cover_downward = reversed(cover);
    const Pose exit = front.half_turn();
    Part illumination_train;
    Part illuminator;
    double sine = 1;
    if (description.ring) {
        const RingLightDescription& ring = *description.ring;
        illumination_train = cover_downward;
        const Pose entry = illumination_train.empty() ? exit : illumination_train.front().pose;
        link(illumination_train, entry);
        constants.ring.aim_distance = entry.origin.z - first_order.best_focus_offset;
        constants.ring.distance = ring.distance;
        constants.ring.elevation_sine = std::sin(ring.elevation);
        constants.ring.elevation_cosine = std::cos(ring.elevation);
        constants.ring.half_width = 0.5 * ring.width;
        constants.ring.fill = ring.fill;
        constants.ring.segments = ring.segments;
        for (std::size_t segment = 0; segment < ring.on.size(); ++segment) {
            constants.ring.switched_on |= ring.on[segment] ? 1u << segment : 0u;
        }
        if (ring.segments < 1 || ring.segments > physics::f64::RING_CAPACITY ||
            ring.on.size() != static_cast<std::size_t>(ring.segments) || constants.ring.switched_on == 0) {
            refuse("source.segments", fmt::format("{} segments", ring.segments),
                   fmt::format("1 to {} segments, at least one of them on", physics::f64::RING_CAPACITY),
                   "Switch a segment on.");
        }
        if (!(ring.distance > 0 && ring.width > 0 && ring.elevation > 0 && ring.elevation < 0.5 * pi &&
              0.5 * ring.width * std::tan(ring.elevation) < ring.distance)) {
            refuse("source.width_mm", fmt::format("{} mm wide, {} mm away", ring.width, ring.distance),
                   "a band that does not reach the axis", "Choose a smaller width or elevation.");
        }
        if (!cover.empty() && !(ring.distance * constants.ring.elevation_sine -
                                    constants.ring.half_width * constants.ring.elevation_cosine >
                                constants.ring.aim_distance)) {
            refuse("source.distance_mm", fmt::format("{} mm", ring.distance),
                   fmt::format("a ring above the cover glass, whose upper face is {:.6g} mm over the focus",
                               constants.ring.aim_distance),
                   "Move the ring farther away, or the cover glass nearer to the specimen.");
        }
        // From any point of the band the lit circle lies within this cone about the band's normal: its middle is off the
        // normal by the half width, and no point of the circle is nearer than this.
        constexpr double margin = 1.5; // around the detector's field
        const double lit_radius = ring.lit_radius.value_or(margin * field_half_diagonal);
        const double reach = lit_radius + 0.5 * ring.width + (cover.empty() ? 0 : description.cover_glass->thickness);
        sine = ring.distance > lit_radius ? std::min(1.0, reach / std::hypot(reach, ring.distance - lit_radius)) : 1;
        instrument.source_pose = downward(0);
        instrument.features |= physics::f64::FEATURE_RING;
    } else {
        require_surfaces(description.illumination, "illumination.prescription");
        const Prescription prescribed = with_stops(description, description.illumination, Role::field_stop,
                                                   description.field_stop_radius,
                                                   "illumination.field_stop_radius_mm");
        illuminator = place_prescription(prescribed, spectrum, description.interfaces, Pose{}, end);
        require_air(illuminator.front().surface.index_before, prescribed, "illumination.prescription");
        require_air(illuminator.back().surface.index_after, prescribed, "illumination.prescription");
        const RayTransfer illuminator_transfer = transfer_of(illuminator);

        // The source is imaged into the objective's pupil, as it is seen from the back.
        const std::optional<double> source_distance =
            description.source_distance ? description.source_distance : prescribed.source_distance;
        if (!source_distance || !(*source_distance >= 0)) {
            refuse("source.distance_mm", source_distance ? fmt::format("{}", *source_distance) : "",
                   "the distance from the source to the illuminator, >= 0",
                   "Give it, or source_distance_mm in the prescription.", prescribed.file);
        }
        constants.source_distance = *source_distance;
        const ParaxialImage source_image = image_of(illuminator_transfer, *source_distance);
        Part straight_backward = reversed(straight_objective);
        link(straight_backward, straight_backward.front().pose);
        const std::size_t stop_backward = objective.size() - 1 - *aperture_stop;
        const RayTransfer back_to_stop = transfer_to_surface(surfaces_of(straight_backward), stop_backward);
        const EntrancePupil back_pupil = entrance_pupil(back_to_stop);
        const double stop_radius = std::sqrt(objective[*aperture_stop].surface.semi_diameter_squared);
        // The stop's image has 1 / a its size; a = 0 has none. What stands on the vertex is no further away than 0.
        const double back_pupil_distance = back_to_stop.b == 0 ? 0 : 1 / back_pupil.curvature;
        const double back_pupil_radius = stop_radius / std::abs(back_to_stop.a);
        // The cube's glass makes the way longer.
        const double glass_shift = splitter.kind == BeamSplitter::Kind::cube
                                       ? splitter.size * (1 - 1 / splitter.glass.index(wavelength))
                                       : 0;
        first_order.illumination_to_objective = description.illumination_to_objective.value_or(
            source_image.distance - back_pupil_distance + glass_shift);
        const double distance = first_order.illumination_to_objective;
        if (!(distance >= 0 && std::isfinite(distance))) {
            refuse("illumination.objective_distance_mm", fmt::format("{:.6g}", distance),
                   fmt::format("room between {} and {} so that the source is imaged into the pupil",
                               prescribed.name, description.objective.name),
                   "Give a distance >= 0, or move the source nearer to the illuminator's focal plane.",
                   prescribed.file);
        }
        first_order.source_magnification = source_image.magnification;
        first_order.pupil_radius_in_source = back_pupil_radius / std::abs(source_image.magnification);
        const double filling_radius =
            std::min(description.source_radius,
                     description.illumination_aperture_radius.value_or(description.source_radius));
        if (filling_radius < 0.98 * first_order.pupil_radius_in_source) {
            instrument.warnings.push_back(fmt::format(
                "The source does not fill the objective's pupil: its radius is {:.4g} mm, filling takes "
                "{:.4g} mm.",
                filling_radius, first_order.pupil_radius_in_source));
        }
        const double image_to_pupil = distance + back_pupil_distance - glass_shift - source_image.distance;
        if (!(std::abs(image_to_pupil) < 0.05 * first_order.efl_objective)) {
            instrument.warnings.push_back(fmt::format(
                "The source is imaged {:.3g} mm in front of the objective's pupil instead of into it.",
                image_to_pupil));
        }

        const Pose illuminator_last = downward(back + distance);
        move(illuminator, end, illuminator_last);
        const Pose entry = {illuminator_last.origin - illuminator_last.axes * (glm::transpose(end.axes) * end.origin),
                            illuminator_last.axes * glm::transpose(end.axes)};
        std::vector<Inserted> between;
        if (splitter.kind == BeamSplitter::Kind::cube) {
            between.push_back({distance - splitter_distance,
                               layout.plate(downward(splitter_height + half_size), splitter.size, splitter.glass,
                                            Medium::air(), splitter.semi_diameter.value_or(half_size),
                                            "beam splitter")});
        }
        const double splitter_from_illuminator = distance - splitter_distance;
        for (const FoldMirror& fold : description.fold_mirrors) {
            if (fold.path == FoldMirror::Path::illumination) {
                if (!(fold.distance >= 0 && fold.distance < splitter_from_illuminator)) {
                    refuse(key_of(fold), fmt::format("{}", fold.distance),
                           fmt::format("a place between the illuminator and the beam splitter {:.6g} mm behind it",
                                       splitter_from_illuminator),
                           "Move the fold mirror.");
                }
                add_fold(fold, illuminator_last.along_z(fold.distance), between);
            }
        }
        std::ranges::stable_sort(between, {}, &Inserted::distance);
        if (description.illumination_aperture_radius) {
            require_positive(*description.illumination_aperture_radius, "illumination.aperture_radius_mm");
            PlacedSurface aperture = dummy_plane(layout.air, entry.along_z(-*source_distance), "illumination aperture");
            aperture.surface.flags |= physics::f64::SURFACE_CLIPPED;
            aperture.surface.semi_diameter_squared =
                *description.illumination_aperture_radius * *description.illumination_aperture_radius;
            illuminator.insert(illuminator.begin(), aperture);
        }
        illumination_train = illuminator;
        instrument.illumination_surfaces_before_splitter = static_cast<int>(illumination_train.size());
        for (const Inserted& part : between) {
            append(illumination_train, part.surfaces);
            instrument.illumination_surfaces_before_splitter +=
                part.distance < splitter_from_illuminator ? static_cast<int>(part.surfaces.size())
                : part.surfaces.size() == 2               ? 1 // the cube's first face
                                                          : 0;
        }
        append(illumination_train, reversed(objective));
        append(illumination_train, cover_downward);
        const PlacedSurface exit_plane = dummy_plane(object_index, exit, "front vertex' plane");
        const Surface to_exit = transfer_between(illumination_train.back().pose, exit_plane);
        constexpr double rounding = 1e-12; // mm
        if (is_displaced(to_exit) || std::abs(to_exit.distance) > rounding) {
            illumination_train.push_back(exit_plane);
        }
        link(illumination_train, entry);
        const std::vector<Surface> illumination_surfaces = surfaces_of(illumination_train);
        const auto field_stop = surface_with_role(illuminator, Role::field_stop);
        if (field_stop && (illuminator[*field_stop].surface.flags & physics::f64::SURFACE_CLIPPED) != 0) {
            const RayTransfer before = transfer_to_surface(illumination_surfaces, *field_stop);
            const RayTransfer whole = transfer_of_train(illumination_surfaces)
                                          .then(free_space(first_order.working_distance, object_index.centre));
            // whole = after * before, so after = whole * before^-1; its first element is the stop's
            // magnification.
            const double magnification = whole.a * before.d - whole.b * before.c;
            const double lit_radius =
                std::abs(magnification) * std::sqrt(illuminator[*field_stop].surface.semi_diameter_squared);
            if (lit_radius < field_half_diagonal) {
                instrument.warnings.push_back(fmt::format(
                    "The field stop's image, {:.4g} mm in radius on the specimen, does not cover the "
                    "detector's field, {:.4g} mm to its corners.",
                    lit_radius, field_half_diagonal));
            }
        }
        // Without a field stop the last surface limits the field as well as any.
        const bool straight = std::ranges::none_of(illumination_surfaces, [](const Surface& surface) {
            return is_displaced(surface);
        });
        const auto stop_transfer =
            transfer_to_surface(illumination_surfaces, field_stop.value_or(illuminator.size() - 1));
        sine = emission_sine(illumination_surfaces, straight, description.source_radius, *source_distance,
                             free_space(*source_distance + illumination_surfaces.front().distance).then(stop_transfer));
        if (!(sine > 0)) {
            refuse("illumination.prescription", prescribed.name,
                   "an illuminator whose light passes the objective", "Check distances and semi-diameters.",
                   prescribed.file);
        }
        instrument.source_pose = entry.along_z(-*source_distance);
    }

    name_surfaces(instrument.surface_names, "illumination", illumination_train);
    name_surfaces(instrument.surface_names, "imaging", imaging_train);

    constants.source_radius = description.source_radius;
    constants.emission_sine = description.directed_emission ? sine : 1;
    constants.magnification = first_order.magnification;
    constants.detector_half_size = 0.5 * description.detector_size;
    constants.gate_position = imaging.pupil_curvature;
    constants.gate_slope = 1;
    // A little more than the field: aberrations let the detector see past its paraxial edge.
    constants.gate_radius = gate_radius(imaging, 1.05 * field_half_diagonal,
                                        first_order.best_focus_offset - description.greatest_defocus,
                                        first_order.best_focus_offset + description.greatest_defocus);
    constants.spectrum_centre = spectrum.centre();
    constants.spectrum_half_width = spectrum.half_width();
    constants.spectral_bins = static_cast<int>(spectrum.bins.size());
    constants.specimen_index = object_index.centre;
    constants.specimen_dispersion = object_index.dispersion;
    constants.illumination_first = 0;
    constants.illumination_count = static_cast<int>(illumination_train.size());
    constants.imaging_first = constants.illumination_count;
    constants.imaging_count = static_cast<int>(imaging_train.size());
    constants.detector_pixels = description.detector_pixels;
    instrument.surfaces = surfaces_of(illumination_train);
    instrument.surfaces.insert(instrument.surfaces.end(), imaging_surfaces.begin(), imaging_surfaces.end());
    instrument.features |= spectrum.monochromatic() ? 0u : physics::f64::FEATURE_SPECTRUM;
    for (const Surface& surface : instrument.surfaces) {
        using namespace physics::f64;
        const bool lossy_mirror = (surface.flags & SURFACE_MIRROR) != 0 && surface.reflectance < 1;
        instrument.features |= is_displaced(surface) ? FEATURE_PLACEMENT : 0u;
        instrument.features |= (surface.flags & SURFACE_IDEAL_LENS) != 0 ? FEATURE_IDEAL_LENS : 0u;
        instrument.features |=
            (surface.flags & (SURFACE_FRESNEL | SURFACE_LAYER)) != 0 || lossy_mirror ? FEATURE_LOSSES : 0u;
    }

    // The room: every element once, the light's way folded, heights over the plane of best focus.
    auto& elements = instrument.elements;
    const auto add_part = [&](const Part& part, Element::Kind kind, const char* name) {
        const std::size_t first = elements.size();
        for (const PlacedSurface& placed : part) {
            elements.push_back(layout.element(kind, placed, name));
        }
        return first;
    };
    // In a mirror's space stands what lies behind it in the light's direction, for the illumination what lies before.
    const auto fold_back = [&](std::size_t from, std::size_t to, const Pose& mirror) {
        for (std::size_t i = from; i < to; ++i) {
            elements[i].pose = elements[i].pose.mirrored_in(mirror);
        }
    };
    if (!description.ring) {
        add_part(illuminator, Element::Kind::surface, "illuminator");
        std::vector<const Fold*> on_the_way;
        for (const Fold& fold : folds) {
            if (fold.path == FoldMirror::Path::illumination) {
                on_the_way.push_back(&fold);
            }
        }
        std::ranges::sort(on_the_way, {}, [](const Fold* fold) { return fold->distance; });
        for (const Fold* fold : on_the_way) { // from the illuminator on: each shows all before it
            fold_back(0, elements.size(), fold->mirror.pose);
            instrument.source_pose = instrument.source_pose.mirrored_in(fold->mirror.pose);
            add_part({fold->mirror}, Element::Kind::mirror, "fold mirror");
        }
        if (splitter.kind == BeamSplitter::Kind::cube) {
            PlacedSurface face = splitter_imaging.front();
            face.pose = downward(splitter_height + half_size);
            add_part({face}, Element::Kind::surface, "beam splitter");
        }
        fold_back(0, elements.size(), splitter_pose);
        instrument.source_pose = instrument.source_pose.mirrored_in(splitter_pose);
    }
    add_part(cover, Element::Kind::surface, "cover glass");
    add_part(objective, Element::Kind::surface, "objective");
    PlacedSurface splitting = layout.mirror_plane(splitter_pose, splitter.semi_diameter, "beam splitter's coating");
    splitting.surface.reflectance = splitter.reflectance;
    std::vector<std::pair<double, const Fold*>> imaging_folds;
    for (const Fold& fold : folds) {
        if (fold.path == FoldMirror::Path::imaging) {
            imaging_folds.emplace_back(fold.distance, &fold);
        }
    }
    std::ranges::sort(imaging_folds, {}, [](const auto& pair) { return pair.first; });
    std::vector<std::pair<std::size_t, Pose>> mirrors; // first element behind, unfolded plane
    if (splitter.kind == BeamSplitter::Kind::plate) {
        Element coated = layout.element(Element::Kind::splitter, splitter_imaging.front(), "beam splitter");
        coated.surface.reflectance = splitter.reflectance;
        elements.push_back(coated);
        elements.push_back(layout.element(Element::Kind::surface, splitter_imaging.back(), "beam splitter"));
    } else if (splitter.kind == BeamSplitter::Kind::cube) {
        const SpectralIndex glass = spectral_index(splitter.glass, spectrum);
        splitting.surface.index_before = splitting.surface.index_after = glass.centre;
        splitting.surface.dispersion_before = splitting.surface.dispersion_after = glass.dispersion;
        elements.push_back(layout.element(Element::Kind::surface, splitter_imaging.front(), "beam splitter"));
        elements.push_back(layout.element(Element::Kind::splitter, splitting, "beam splitter"));
        elements.push_back(layout.element(Element::Kind::surface, splitter_imaging.back(), "beam splitter"));
    } else {
        elements.push_back(layout.element(Element::Kind::splitter, splitting, "beam splitter"));
    }
    for (const auto& [distance, fold] : imaging_folds) {
        add_part({fold->mirror}, Element::Kind::mirror, "fold mirror");
        mirrors.emplace_back(elements.size(), fold->mirror.pose);
    }
    add_part(tube_lens, Element::Kind::surface, "tube lens");
    PlacedSurface detector = dummy_plane(layout.air, detector_pose, "detector");
    add_part({detector}, Element::Kind::detector, "detector");
    for (auto mirror = mirrors.rbegin(); mirror != mirrors.rend(); ++mirror) { // the farthest first
        fold_back(mirror->first, elements.size(), mirror->second);
    }
    for (Element& element : elements) {
        element.pose.origin.z -= first_order.best_focus_offset;
    }
    if (!description.ring) {
        instrument.source_pose.origin.z -= first_order.best_focus_offset;
    }
    return instrument;
}

} // namespace vkfv::optics
