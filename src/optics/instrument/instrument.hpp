// The instrument, assembled from its parts and reduced to what the trace needs.
#pragma once

#include "core/mathematics/pixel_grid.hpp"
#include "core/messages/warning.hpp"
#include "optics/media/spectrum.hpp"
#include "optics/prescriptions/prescription.hpp"
#include "optics/train/mesh_element.hpp"
#include "optics/train/train.hpp"
#include "physics/physics.hpp"

#include <optional>
#include <string>
#include <vector>

namespace vkfv::optics {

// Where a part stands: its first vertex moved and tilted from where the axis would have it, the parts that follow it
// unmoved; or, with `global`, at a point of the specimen frame with its origin in the paraxial object plane (mm),
// tilted against that frame's axes. Fold mirrors do not count: positions are in the straight space that they show.
struct Placement {
    CoordinateBreak change;
    std::optional<glm::dvec3> global;
};

// A Lambertian ring that shines on the specimen past the objective. Lengths in mm, angles in rad.
struct RingLightDescription {
    double distance = 0;  // from the plane of best focus on the axis to the middle of the band
    double elevation = 0; // of that direction over the specimen's plane
    double width = 0;     // of the band, at right angles to that direction
    int segments = 1;
    double fill = 1;                  // share of its sector that a segment takes
    std::vector<bool> on;             // of each segment, counted from +x towards +y
    std::optional<double> lit_radius; // of the circle about the axis that all of the ring must light; none: the field
};

// A Lambertian source: a disc or a rectangle behind the illuminator, or a ring light. mm, W.
struct SourceDescription {
    std::string key = "source"; // of its table, for messages
    double flux = 1;
    double radius = 0;                        // of the disc
    std::optional<glm::dvec2> rectangle;      // instead of the disc: its width and height
    std::optional<double> distance;           // of both to the illumination's first vertex; none: the prescription's
    std::optional<RingLightDescription> ring; // instead of both, and of the illuminator
    std::optional<Spectrum> spectrum;         // none: the instrument's

    double outer_radius() const; // of the circle about the disc or rectangle
    double inner_radius() const; // of the circle in it
};

struct BeamSplitter {
    enum class Kind { ideal, plate, cube } kind = Kind::ideal;
    double reflectance = 0.5;   // for the illumination
    double transmittance = 0.5; // for the imaging; the rest is absorbed
    Medium glass = Medium::air();
    double size = 0;                // thickness of the plate, edge of the cube
    std::optional<double> distance; // from the objective's back vertex; none: half way to the tube lens
    std::optional<double> semi_diameter;
};

// A plane mirror in the infinity space.
struct FoldMirror {
    enum class Path { imaging, illumination } path = Path::imaging;
    double distance = 0;  // imaging: behind the objective's back vertex; illumination: behind the illuminator's last
    double incidence = 0; // angle of incidence of the axis, rad
    double azimuth = 0;   // of the plane of incidence about the axis, rad
    double semi_diameter = 0;
    double reflectance = 1;
};

// A plane-parallel plate over the specimen.
struct CoverGlass {
    double thickness = 0;
    Medium glass = Medium::air();
    std::optional<double> distance; // lower face over the paraxial object plane; none: half the free way
};

// What a configuration says of the instrument, in the units of the inside (mm, W, rad, wavelengths in um).
struct InstrumentDescription {
    SourceDescription source;
    std::vector<SourceDescription> further_sources; // ring lights
    Spectrum spectrum = Spectrum::line(0.5876);     // of all light together: first-order data and best focus are its
    Prescription illumination;
    std::optional<double> illumination_to_objective;    // last illumination vertex to the objective's last (back)
                                                        // vertex; none: the source is imaged into the pupil
    std::optional<double> field_stop_radius;            // none: the prescription's
    std::optional<LightField> light_field;              // of the field stop's plane; none: it lets all through
    std::optional<double> illumination_aperture_radius; // of a stop at the source
    BeamSplitter splitter;
    std::vector<FoldMirror> fold_mirrors;
    Interfaces interfaces;
    Prescription objective;                     // from the specimen to the back
    std::optional<Medium> immersion;            // between specimen and objective; none: the prescription's
    std::optional<double> aperture_stop_radius; // none: the prescription's
    std::optional<CoverGlass> cover_glass;
    Placement objective_placement;
    Prescription tube_lens; // from the objective to the detector
    Placement tube_lens_placement;
    double objective_to_tube_lens = 100;
    double detector_width = 0; // along the rows, in the detector's plane; its pixels are square
    ImageSize detector_pixels;
    double fill_factor = 1; // share of a pixel's area, a square in its middle, that is sensitive
    Placement detector_placement;
    std::vector<MeshElement> meshes; // the non-sequential mode's alone
    bool directed_emission = true;   // aim the source at what can pass the illumination train
    bool single_scatter = false;     // the aim at what the detector sees of light scattered once is wanted too
    bool turned = false;             // the backward estimator's form is wanted too
    double greatest_defocus = 0.2;   // of the specimen's top plane from the plane of best focus, for the gate

    std::vector<const SourceDescription*> sources() const; // all, in their order
};

// First-order and measured properties (mm, unless the name says otherwise), at the reference wavelength.
struct FirstOrder {
    double efl_objective = 0;
    double efl_tube_lens = 0;
    double numerical_aperture = 0; // object side, n sin, of the on-axis cone through all apertures
    double object_index = 1;       // of the medium over the specimen
    double working_distance = 0;   // paraxial focus to the first vertex over it (the objective's or the cover glass')
    double magnification = 0;      // signed, paraxial, at the detector
    double depth_of_field = 0;     // n lambda / NA^2: ISO 25178-604's optical depth of field
    double pixel_pitch = 0;        // in the object plane
    // Heights above the paraxial plane, towards the objective (+z), of a point on the axis; its light fills the real
    // apertures with uniform density in direction cosines, as a Lambertian specimen's does.
    double best_focus_offset = 0; // its wavefront has the least variance, over the spectrum: z = 0 of a scan
    double least_spot_offset = 0; // its rays have the least RMS distance from their centroid on the detector
    // Best focus from that on the axis (+z); of displaced parts the mean all round.
    double field_curvature = 0;           // at the field's edge
    double field_curvature_corner = 0;    // in the field's corners
    double field_edge = 0;                // the field height that belongs to it: half the longer side in the object
    glm::dvec2 field_corner{0};           // half of both sides of the field, in the object
    double pupil_radius_in_source = 0;    // radius of source that fills the objective's pupil; 0: a ring light
    double illumination_to_objective = 0; // as resolved
    double source_magnification = 0;      // paraxial, of the source's image in the objective's pupil
    double field_stop_magnification = 0;  // paraxial, signed, of the field stop's image on the specimen; 0: no stop
};

// What an element belongs to.
enum class Part { illuminator, beam_splitter, fold_mirror, cover_glass, objective, tube_lens, detector };
const char* name_of(Part part); // "tube lens"

// An element as it stands in the room, for drawing and for non-sequential tracing. Frame: the specimen's with its
// origin on the axis in the plane of best focus (mm), the objective at rest; the splitter and the mirrors fold the
// light's way.
struct Element {
    enum class Kind { surface, stop, mirror, splitter, ideal_lens, detector } kind = Kind::surface;
    physics::f64::Surface surface{}; // z of its frame: in the imaging direction, for the illuminator the light's
    Pose pose;
    SurfaceName name;
    Part part = Part::objective;
};

// The instrument with its light turned round, for the backward estimator (shaders/physics/backward.glsl): its
// illumination train leads from the detector to the specimen, its imaging train from there to the source.
struct TurnedInstrument {
    std::vector<physics::f64::Surface> surfaces;
    physics::f64::Instrument constants{};
    physics::f64::BackwardOptics optics{}; // its disc of pupil_radius holds all light
    double pupil_rim = 0; // the pupil's edge, as pupil_radius; 0: no circle, or not the same all over the field
};

// Trains and constants in double, with the light of one source. `surfaces` holds the illumination train (source to
// specimen: illuminator, then the objective backward) and the imaging train (specimen to detector). Light travels
// towards +z in both; the specimen frame is the illumination's turned half a turn about x. Constant throughout a run.
struct Instrument {
    std::vector<physics::f64::Surface> surfaces;
    std::vector<std::string> surface_names; // for the ledger: "illumination 3 (koehler 1)", ...
    std::vector<physics::f64::SpectralBin> spectral_bins;
    physics::f64::Instrument constants{};
    std::uint32_t features = 0;            // physics::FEATURE_*
    std::optional<LightField> light_field; // its record is among the constants too
    FirstOrder first_order;
    double flux = 1;                     // W, emitted over the hemisphere
    double fill_factor = 1;              // of the pixels
    double splitter_reflectance = 0.5;   // for the illumination; 1 for a ring light, which does not meet it
    double splitter_transmittance = 0.5; // for the imaging
    // Surfaces of each train that light meets before the beam splitter's mirror.
    int illumination_surfaces_before_splitter = 0;
    int imaging_surfaces_before_splitter = 0;
    // Front vertex of the objective (or cover glass) above the plane of best focus (z = 0 of the specimen frame, scan
    // at 0).
    double front_vertex_height = 0;
    std::vector<Element>
        elements; // in the order of the light: illuminator, splitter, cover glass, objective, ... detector
    std::vector<PlacedMesh> meshes; // in the same frame; only light without a given sequence meets them
    Pose source_pose; // of the source's frame, light towards its z (a ring light's: its aim), in the elements' frame
    std::optional<TurnedInstrument> turned;       // where the description asks for it
    std::optional<glm::dvec2> single_scatter_aim; // aim_at_detector(), where the description asks for it
    std::vector<Warning> warnings;
    std::vector<Instrument> further_lights; // the same instrument in the light of each further source

    std::vector<const Instrument*> lights() const; // one a source, this one first
    TrainScene scene() const { return {surfaces, features, spectral_bins, light_field ? &*light_field : nullptr}; }
    double aimed_share() const; // share of the flux that leaves in the directions aimed into
    ImageSize detector_pixels() const { return {constants.detector_columns, constants.detector_rows}; }
};

// With the trains and constants of the turned form.
Instrument turned_round(const Instrument& instrument);

// For paths that meet the specimen once. With the aim at the detector, if there is one.
Instrument aimed_for_single_scatter(Instrument instrument);

// With pixels that count all of their light, for images that the waves' filter shares out (PupilFilter).
Instrument with_whole_pixels(Instrument instrument);

// Throws InputError where parts do not fit together (no real image, illumination too long to fit, ...).
Instrument assemble(const InstrumentDescription& description);

} // namespace vkfv::optics
