#include "optics/instrument.hpp"

#include "core/error.hpp"
#include "optics/assembly.hpp"
#include "optics/first_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

using physics::f64::Surface;

namespace {

// "imaging 3 (10x_0.28 3, aperture stop)": the place in the train, and in the prescription as its file
// counts.
void name_surfaces(std::vector<std::string>& names, const char* train, const Part& surfaces) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        names.push_back(fmt::format("{} {} ({})", train, i + 1, surfaces[i].name));
    }
}

} // namespace

void refuse(std::string key, std::string found, std::string expected, std::string remedy,
            const std::filesystem::path& file) {
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

Pose downward(double height) {
    return Pose{}.along_z(height).half_turn();
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

RayTransfer transfer_of(Part part) {
    link(part, part.front().pose);
    return transfer_of_train(surfaces_of(part));
}

Prescription with_stop(Prescription prescription, PrescribedSurface::Role role, std::optional<double> radius,
                       const char* key) {
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

Part Assembly::plate(const Pose& first, double thickness, const Medium& glass, const Medium& medium,
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

PlacedSurface Assembly::mirror_plane(const Pose& pose, std::optional<double> semi_diameter, std::string name) const {
    PlacedSurface mirror = dummy_plane(air, pose, std::move(name));
    mirror.surface.flags |= physics::f64::SURFACE_MIRROR;
    mirror.surface.reflectance = 1;
    if (semi_diameter) {
        mirror.surface.flags |= physics::f64::SURFACE_CLIPPED;
        mirror.surface.semi_diameter_squared = *semi_diameter * *semi_diameter;
    }
    return mirror;
}
void Assembly::add_fold(const FoldMirror& fold, const Pose& axis, std::vector<Inserted>& into) {
    require_positive(fold.semi_diameter, "fold_mirror.semi_diameter_mm");
    const Pose pose = axis.turned({.tilt_z = fold.azimuth}).turned({.tilt_x = fold.incidence});
    PlacedSurface mirror = mirror_plane(pose, fold.semi_diameter, "fold mirror");
    mirror.surface.reflectance = fold.reflectance;
    folds.push_back({fold.path, fold.distance, mirror});
    into.push_back({fold.distance, {mirror}});
}

std::string Assembly::key_of(const FoldMirror& fold) const {
    return fmt::format("fold_mirror[{}].distance_mm", &fold - description.fold_mirrors.data());
}

std::vector<const Assembly::Fold*> Assembly::folds_of(FoldMirror::Path path) const {
    std::vector<const Fold*> chosen;
    for (const Fold& fold : folds) {
        if (fold.path == path) {
            chosen.push_back(&fold);
        }
    }
    std::ranges::sort(chosen, {}, [](const Fold* fold) { return fold->distance; });
    return chosen;
}

Assembly::Assembly(const InstrumentDescription& given)
    : description(given), spectrum(given.spectrum), splitter(given.splitter),
      air(spectral_index(Medium::air(), given.spectrum)) {
    instrument.flux = description.flux;
    instrument.splitter_reflectance = description.ring ? 1 : splitter.reflectance;
    instrument.splitter_transmittance = splitter.transmittance;
    instrument.spectral_bins = spectrum.bins;
}

void Assembly::reduce() {
    name_surfaces(instrument.surface_names, "illumination", illumination_train);
    name_surfaces(instrument.surface_names, "imaging", imaging_train);

    constants.source_radius = description.source_radius;
    constants.emission_sine = description.directed_emission ? aimed_sine : 1;
    constants.magnification = first_order.magnification;
    constants.detector_half_size = 0.5 * description.detector_size;
    constants.gate_position = imaging.pupil_curvature;
    constants.gate_slope = 1;
    // A little more than the field: aberrations let the detector see past its paraxial edge.
    constants.gate_radius =
        gate_radius(imaging, 1.05 * field_half_diagonal, first_order.best_focus_offset - description.greatest_defocus,
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
}

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

    Assembly assembly(description);
    assembly.lay_out();
    assembly.assemble_imaging();
    assembly.measure_imaging();
    if (description.ring) {
        assembly.assemble_ring();
    } else {
        assembly.assemble_illuminator();
    }
    assembly.reduce();
    if (description.turned) {
        if (description.ring) {
            refuse("trace.estimator", "\"backward\"",
                   "a disc source; the backward estimator does not know the ring light",
                   "Use estimator = \"forward\".");
        }
        assembly.turn_round();
    }
    assembly.furnish();
    return std::move(assembly.instrument);
}

} // namespace vkfv::optics
