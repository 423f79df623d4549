// The instrument, assembled from its parts and reduced to what the trace needs.
#pragma once

#include "optics/prescription.hpp"
#include "physics/physics.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkfv::optics {

// What a configuration says of the instrument, in the units of the inside (mm, W, wavelengths in um).
struct InstrumentDescription {
    double source_radius = 0;
    double flux = 1;
    double wavelength_um = 0.5876;
    std::optional<double> source_distance; // to the illumination's first vertex; none: the prescription's
    Prescription illumination;
    std::optional<double>
        illumination_to_objective;           // last illumination vertex to the objective's last (back)
                                             // vertex; none: the source is imaged into the pupil
    std::optional<double> field_stop_radius; // none: the prescription's
    double splitter_reflectance = 0.5;
    Prescription objective; // from the specimen to the back
    Prescription tube_lens; // from the objective to the detector
    double objective_to_tube_lens = 100;
    double detector_size = 0; // of the square, in the detector's plane
    int detector_pixels = 0;
    bool directed_emission = true; // aim the source at the cone that can pass the illumination train
    double greatest_defocus = 0.2; // of the specimen's top plane from the plane of best focus, for the gate
};

// First-order and measured properties (mm, unless the name says otherwise).
struct FirstOrder {
    double efl_objective = 0;
    double efl_tube_lens = 0;
    double numerical_aperture = 0; // object side, of the on-axis marginal ray through all apertures
    double working_distance = 0;   // paraxial focus to the objective's front vertex
    double magnification = 0;      // signed, paraxial, at the detector
    double depth_of_field =
        0;                  // lambda / NA^2 (n = 1): ISO 25178-604's optical depth of field, n lambda / NA^2
    double pixel_pitch = 0; // in the object plane
    // Height above the paraxial plane, towards the objective (+z), of the on-axis point whose rays have the
    // least RMS distance from their centroid on the detector. They fill the real apertures with uniform
    // density in direction cosines, as the light of a Lambertian specimen does.
    double best_focus_offset = 0;
    double field_curvature = 0; // the same at the field's edge, from the on-axis best focus (+z)
    double field_edge = 0;      // the field height that belongs to it: half the detector's side in the object
    double pupil_radius_in_source = 0;    // radius of source that fills the objective's pupil
    double illumination_to_objective = 0; // as resolved
};

// Trains and constants in double. `surfaces` holds the illumination train (source to specimen: illuminator,
// then the objective backward) and the imaging train (specimen to detector). Light travels towards +z in
// both; the specimen frame is the illumination's turned half a turn about x. Constant throughout a run.
struct Instrument {
    std::vector<physics::f64::Surface> surfaces;
    std::vector<std::string> surface_names; // for the ledger: "illumination 3 (koehler 1)", ...
    physics::f64::Instrument constants;
    FirstOrder first_order;
    double flux = 1; // W, emitted over the hemisphere
    double splitter_reflectance = 0.5;
    // Surfaces of each train that light meets before the beam splitter: the illuminator's and the objective's
    // number.
    int illumination_surfaces_before_splitter = 0;
    int imaging_surfaces_before_splitter = 0;
    // Front vertex of the objective above the plane of best focus (z = 0 of the specimen frame, scan at 0).
    double front_vertex_height = 0;
    std::vector<std::string> warnings;
};

// The scene that trace_train needs on the host.
struct TrainScene {
    std::span<const physics::f64::Surface> surfaces;
    const physics::f64::Surface& surface_at(int index) const {
        return surfaces[static_cast<std::size_t>(index)];
    }
};

// Throws InputError where parts do not fit together (no real image, illumination too long to fit, ...).
Instrument assemble(const InstrumentDescription& description);

} // namespace vkfv::optics
