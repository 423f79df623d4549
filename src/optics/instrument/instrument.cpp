#include "optics/instrument/instrument.hpp"

#include "core/mathematics/units.hpp"
#include "optics/aim/detector_aim.hpp"
#include "optics/instrument/assembly.hpp"
#include "optics/instrument/obstructed_ring.hpp"
#include "optics/instrument/unknown_dispersion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>
#include <span>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;

namespace {

// Appends names such as "imaging 3 (10x_0.28 3, aperture stop)": the index in the train, and the number in the
// prescription's file.
void name_surfaces(std::vector<std::string>& names, const char* train, const PlacedSurfaces& surfaces) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        names.push_back(fmt::format("{} {} ({})", train, i + 1, surfaces[i].name.text()));
    }
}

FirstOrder first_order_of(const InstrumentDescription& description, const AxialLayout& layout,
                          const MeasuredImaging& measured, const Illumination& illumination) {
    return {.efl_objective = layout.efl_objective,
            .efl_tube_lens = layout.efl_tube_lens,
            .numerical_aperture = measured.numerical_aperture,
            .object_index = layout.object_index.centre,
            .working_distance = layout.working_distance,
            .magnification = layout.magnification,
            .depth_of_field = measured.depth_of_field,
            .pixel_pitch =
                description.detector_width / description.detector_pixels.columns / std::abs(layout.magnification),
            .best_focus_offset = measured.best_focus_offset,
            .least_spot_offset = measured.least_spot_offset,
            .field_curvature = measured.field_curvature,
            .field_curvature_corner = measured.field_curvature_corner,
            .field_edge = std::max(layout.field_corner.x, layout.field_corner.y),
            .field_corner = layout.field_corner,
            .pupil_radius_in_source = illumination.pupil_radius_in_source,
            .illumination_to_objective = illumination.to_objective,
            .source_magnification = illumination.source_magnification,
            .field_stop_magnification = illumination.field_stop_magnification};
}

physics::f64::Instrument constants_of(const InstrumentDescription& description, const AxialLayout& layout,
                                      const ImagingTrain& imaging, const DetectorHulls& hulls,
                                      const Illumination& illumination) {
    const Spectrum& spectrum = description.spectrum;
    physics::f64::Instrument constants{};
    const SourceDescription& source = description.source;
    constants.source_radius = source.radius;
    const glm::dvec2 sides = source.rectangle.value_or(glm::dvec2(0));
    constants.source_half_width = 0.5 * sides.x;
    constants.source_half_height = 0.5 * sides.y;
    constants.source_distance = illumination.source_distance;
    constants.ring = illumination.ring;
    const Aim aim = description.directed_emission ? illumination.aim : Aim{};
    constants.emission_sine = aim.sine;
    constants.emission_shift = aim.shift;
    constants.magnification = layout.magnification;
    constants.detector_distance = imaging.imaging.detector_distance;
    const ImageSize& pixels = description.detector_pixels;
    constants.detector_half_width = 0.5 * description.detector_width;
    constants.detector_half_height = constants.detector_half_width * pixels.rows / pixels.columns;
    constants.image_distortion = layout.image_distortion;
    constants.image_shear = image_shear(description.image);
    constants.pixel_reach = description.fill_factor < 1 ? 0.5 * std::sqrt(description.fill_factor) : 1;
    constants.detector_columns = pixels.columns;
    constants.detector_rows = pixels.rows;
    constants.gate_position = imaging.imaging.pupil_curvature;
    constants.gate_slope = 1;
    // The field is slightly enlarged: aberrations let the detector see past its paraxial edge.
    constants.gate_radius =
        std::max(hulls.gate_radius(), gate_radius(imaging.imaging, 1.05 * layout.seen_half_diagonal(),
                                                  hulls.heights().low, hulls.heights().high));
    constants.light_field = description.light_field.value_or(LightField{}).record;
    constants.spectrum_centre = spectrum.centre();
    constants.spectrum_half_width = spectrum.half_width();
    constants.spectral_bins = static_cast<int>(source.spectrum.value_or(spectrum).bins.size());
    constants.specimen_index = layout.object_index.centre;
    constants.specimen_dispersion = layout.object_index.dispersion;
    constants.illumination_first = 0;
    constants.illumination_count = static_cast<int>(illumination.train.size());
    constants.imaging_first = constants.illumination_count;
    constants.imaging_count = static_cast<int>(imaging.train.size());
    return constants;
}

std::uint32_t features_of(const InstrumentDescription& description, const std::vector<Surface>& surfaces) {
    using namespace physics::f64;
    std::uint32_t features = description.source.ring        ? FEATURE_RING
                             : description.source.rectangle ? FEATURE_RECTANGLE
                                                            : 0u;
    features |= description.spectrum.monochromatic() ? 0u : FEATURE_SPECTRUM;
    for (const Surface& surface : surfaces) {
        const bool lossy_mirror = (surface.flags & SURFACE_MIRROR) != 0 && surface.reflectance < 1;
        features |= is_displaced(surface) ? FEATURE_PLACEMENT : 0u;
        features |= (surface.flags & SURFACE_IDEAL_LENS) != 0 ? FEATURE_IDEAL_LENS : 0u;
        features |= (surface.flags & SURFACE_LIGHT_FIELD) != 0 ? FEATURE_LIGHT_FIELD | FEATURE_LOSSES : 0u;
        features |= (surface.flags & (SURFACE_FRESNEL | SURFACE_LAYER)) != 0 || lossy_mirror ? FEATURE_LOSSES : 0u;
    }
    return features;
}

void check(const InstrumentDescription& description) {
    for (const SourceDescription* source : description.sources()) {
        if (source->rectangle) {
            require_positive(source->rectangle->x, source->key + ".width_mm");
            require_positive(source->rectangle->y, source->key + ".height_mm");
        } else if (!source->ring) {
            require_positive(source->radius, source->key + ".radius_mm");
        }
        require_positive(source->flux, source->key + ".flux_W");
    }
    require_positive(description.spectrum.reference_um, "source.wavelength_um");
    require_positive(description.detector_width, "detector.size_mm");
    require_positive(std::min(description.detector_pixels.columns, description.detector_pixels.rows),
                     "detector.pixels");
    require_surfaces(description.objective, "objective.prescription");
    require_surfaces(description.tube_lens, "tube_lens.prescription");
}

// The instrument's trains and constants; its elements in the room and its reversed form are added later.
Instrument reduce(const InstrumentDescription& description, const AxialLayout& layout, const ImagingTrain& imaging,
                  const MeasuredImaging& measured, const DetectorHulls& hulls, const Illumination& illumination) {
    Instrument instrument;
    instrument.surfaces = surfaces_of(illumination.train);
    instrument.surfaces.insert(instrument.surfaces.end(), imaging.imaging.train.begin(), imaging.imaging.train.end());
    name_surfaces(instrument.surface_names, "illumination", illumination.train);
    name_surfaces(instrument.surface_names, "imaging", imaging.train);
    instrument.spectral_bins = description.source.spectrum.value_or(description.spectrum).bins;
    instrument.constants = constants_of(description, layout, imaging, hulls, illumination);
    instrument.features = features_of(description, instrument.surfaces);
    if ((instrument.features & physics::f64::FEATURE_LIGHT_FIELD) != 0) { // light of a ring bypasses it
        instrument.light_field = description.light_field;
    }
    instrument.first_order = first_order_of(description, layout, measured, illumination);
    instrument.flux = description.source.flux;
    instrument.fill_factor = description.fill_factor;
    instrument.magnification_rate = description.image.magnification_rate;
    instrument.image_reach = layout.reach;
    instrument.splitter_reflectance = description.source.ring ? 1 : description.splitter.reflectance;
    instrument.splitter_transmittance = description.splitter.transmittance;
    instrument.illumination_surfaces_before_splitter = illumination.surfaces_before_splitter;
    instrument.imaging_surfaces_before_splitter = imaging.surfaces_before_splitter;
    instrument.front_vertex_height = layout.working_distance - measured.best_focus_offset;
    instrument.warnings = measured.warnings;
    instrument.warnings.insert(instrument.warnings.end(), illumination.warnings.begin(), illumination.warnings.end());
    std::ranges::move(warning_of_unknown_dispersion(description), std::back_inserter(instrument.warnings));
    return instrument;
}

std::optional<glm::dvec2> single_scatter_aim(const InstrumentDescription& description, const Imaging& imaging,
                                             double reach, const Instrument& instrument) {
    const auto& constants = instrument.constants;
    const std::span<const Surface> surfaces = instrument.surfaces;
    const auto illumination = surfaces.first(static_cast<std::size_t>(constants.illumination_count));
    if (!description.directed_emission || description.source.ring || !imaging.symmetric ||
        std::ranges::any_of(illumination, is_displaced)) {
        return std::nullopt;
    }
    const double radius = description.source.outer_radius();
    const auto sides = aim_at_detector(
        {.illumination = illumination,
         .imaging = imaging.train,
         .source = {.radius = radius,
                    .distance = constants.source_distance,
                    .monochromatic = description.spectrum.monochromatic()},
         .front_vertex_height = instrument.front_vertex_height,
         .greatest_defocus = description.greatest_defocus,
         .detector_distance = constants.detector_distance,
         .detector_half_sides = reach * glm::dvec2(constants.detector_half_width, constants.detector_half_height)},
        {.shift = constants.emission_shift, .sine = constants.emission_sine});
    const bool within_hemisphere = sides && std::abs(constants.emission_shift) * radius + glm::length(*sides) <= 1;
    return within_hemisphere ? sides : std::nullopt;
}

} // namespace

const char* name_of(Part part) {
    switch (part) {
    case Part::illuminator:
        return "illuminator";
    case Part::beam_splitter:
        return "beam splitter";
    case Part::fold_mirror:
        return "fold mirror";
    case Part::cover_glass:
        return "cover glass";
    case Part::objective:
        return "objective";
    case Part::tube_lens:
        return "tube lens";
    case Part::detector:
        break;
    }
    return "detector";
}

double Instrument::aimed_share() const {
    const bool rectangle = (features & physics::f64::FEATURE_AIMED_RECTANGLE) != 0;
    return rectangle ? 4 / pi * constants.emission_half_width * constants.emission_half_height
                     : constants.emission_sine * constants.emission_sine;
}

Instrument aimed_for_single_scatter(Instrument instrument) {
    for (Instrument& further : instrument.further_lights) {
        further = aimed_for_single_scatter(std::move(further));
    }
    if (const auto& sides = instrument.single_scatter_aim) {
        instrument.constants.emission_half_width = sides->x;
        instrument.constants.emission_half_height = sides->y;
        instrument.constants.emission_sine = glm::length(*sides);
        instrument.features |= physics::f64::FEATURE_AIMED_RECTANGLE;
    }
    return instrument;
}

Instrument with_whole_pixels(Instrument instrument) {
    for (Instrument& further : instrument.further_lights) {
        further = with_whole_pixels(std::move(further));
    }
    instrument.constants.pixel_reach = 1;
    if (instrument.turned) {
        instrument.turned->constants.pixel_reach = 1;
    }
    return instrument;
}

double SourceDescription::outer_radius() const {
    return rectangle ? 0.5 * glm::length(*rectangle) : radius;
}

double SourceDescription::inner_radius() const {
    return rectangle ? 0.5 * std::min(rectangle->x, rectangle->y) : radius;
}

std::vector<const SourceDescription*> InstrumentDescription::sources() const {
    std::vector<const SourceDescription*> all = {&source};
    for (const SourceDescription& further : further_sources) {
        all.push_back(&further);
    }
    return all;
}

std::vector<const Instrument*> Instrument::lights() const {
    std::vector<const Instrument*> all = {this};
    for (const Instrument& further : further_lights) {
        all.push_back(&further);
    }
    return all;
}

Instrument assemble(const InstrumentDescription& description) {
    check(description);
    const AxialLayout layout = lay_out(description);
    const ImagingTrain imaging = place_imaging(description, layout);
    // The two slow stages run in parallel. Only the first source may stand behind the illuminator.
    std::future<Illumination> illuminator;
    if (!description.source.ring) {
        illuminator = std::async(std::launch::async, [&] { return place_illuminator(description, layout, imaging); });
    }
    const MeasuredImaging measured = measure_imaging(description, layout, imaging);
    const std::vector<PlacedMesh> meshes = place_meshes(description, measured);
    const auto in_light_of = [&](const SourceDescription& source) {
        InstrumentDescription lit = description;
        lit.source = source;
        const Illumination illumination = source.ring ? place_ring(lit, layout, measured) : illuminator.get();
        const DetectorHulls hulls(lit, layout, imaging, measured);
        Instrument instrument = reduce(lit, layout, imaging, measured, hulls, illumination);
        if (lit.single_scatter) {
            instrument.single_scatter_aim = single_scatter_aim(lit, imaging.imaging, layout.reach, instrument);
        }
        if (lit.turned) {
            instrument.turned = turn_round(lit, layout, imaging, hulls, illumination, instrument);
        }
        FoldedElements folded = fold(lit, layout, imaging, measured, illumination);
        instrument.elements = std::move(folded.elements);
        instrument.source_pose = folded.source_pose;
        instrument.meshes = meshes;
        instrument.features |= instrument.meshes.empty() ? 0u : physics::f64::FEATURE_FACETS;
        return instrument;
    };
    Instrument instrument = in_light_of(description.source);
    for (const SourceDescription& source : description.further_sources) {
        if (!source.ring) {
            refuse(source.key, "another disc or rectangle", "one source behind the illuminator, the first",
                   "Make the others ring lights.");
        }
        Instrument further = in_light_of(source);
        further.elements = instrument.elements; // light of a ring may reach the illuminator too
        instrument.further_lights.push_back(std::move(further));
    }
    append(instrument.warnings, warnings_of_obstructed_rings(description, instrument));
    return instrument;
}

} // namespace vkfv::optics
