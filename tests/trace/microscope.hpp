// The microscope and specimens that the tests of the trace share.
#pragma once

#include "core/mathematics/units.hpp"
#include "optics/instrument/instrument.hpp"
#include "optics/prescriptions/ideal_lens.hpp"
#include "specimen/description.hpp"
#include "trace/interface/tracer.hpp"

namespace vkfv::test {

inline optics::InstrumentDescription microscope_description() {
    const std::filesystem::path base = std::filesystem::path(VKFV_SOURCE_DIR) / "assets" / "stacks";
    optics::InstrumentDescription description;
    description.source.radius = 0.96;
    description.spectrum = optics::Spectrum::line(0.587562);
    description.illumination = optics::load_prescription("koehler", "illuminators", base);
    description.field_stop_radius = 0.85;
    description.objective = optics::load_prescription("10x_0.28", "objectives", base);
    description.tube_lens = optics::load_prescription("200mm", "tube_lenses", base);
    description.detector_width = 1.28;
    description.detector_pixels = ImageSize::square(64);
    return description;
}

// An illuminator of condenser, field stop and field lens without aberrations: the stop is imaged into the specimen
// sharply.
inline optics::Prescription ideal_illuminator() {
    optics::Prescription illuminator = optics::ideal_lens(26);
    illuminator.source_distance = 26;
    optics::PrescribedSurface& condenser = illuminator.surfaces.front();
    condenser.thickness = 30;
    optics::PrescribedSurface stop;
    stop.medium_after = condenser.medium_after;
    stop.role = optics::SurfaceRole::field_stop;
    stop.thickness = 150;
    const optics::PrescribedSurface field_lens = optics::ideal_lens(150).surfaces.front();
    illuminator.surfaces.push_back(stop);
    illuminator.surfaces.push_back(field_lens);
    return illuminator;
}

// The microscope with lenses that have no aberrations. Each is one surface, so that rays take less time than in
// microscope_description(): for tests that do not depend on the lenses.
inline optics::InstrumentDescription ideal_microscope_description() {
    optics::InstrumentDescription description = microscope_description();
    description.illumination = ideal_illuminator();
    description.objective = optics::ideal_objective(20, 0.28);
    description.tube_lens = optics::ideal_lens(200);
    return description;
}

inline optics::Instrument microscope() {
    return optics::assemble(microscope_description());
}

// A specimen so rough that light meets it more than once. Only slopes above 3.5 turn back light that is within the
// pupil, which steep_specimen() has.
inline specimen::Specimen rough_specimen(double g = 0.65, double sq = 0.003, double correlation_length = 0.012) {
    specimen::Rough rough;
    rough.size = 0.3;
    rough.pitch = 0.001;
    rough.random = {.sq = sq, .correlation_length = correlation_length, .seed = 5};
    return specimen::make({.shape = rough, .material = specimen::Material::henyey_greenstein(g)});
}

inline specimen::Specimen steep_specimen(double g) {
    return rough_specimen(g, 0.016, 0.009);
}

inline specimen::Specimen plane_specimen(double g) {
    specimen::Plane plane;
    plane.size = 0.4;
    plane.pitch = 0.01;
    return specimen::make({.shape = plane, .material = specimen::Material::henyey_greenstein(g)});
}

} // namespace vkfv::test
