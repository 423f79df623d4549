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

// The displacement of a part: its first vertex is moved and tilted from its nominal pose on the axis, while the parts
// that follow stay; or, with `global`, it is placed at a point of the specimen frame with its origin in the paraxial
// object plane (mm), tilted against that frame's axes. Fold mirrors do not count: positions are in the unfolded space.
struct Placement {
    CoordinateBreak change;
    std::optional<glm::dvec3> global;
};

// A Lambertian ring that illuminates the specimen past the objective. Lengths in mm, angles in rad.
struct RingLightDescription {
    double distance = 0;  // from the plane of best focus on the axis to the middle of the band
    double elevation = 0; // elevation of the band over the specimen's plane
    double width = 0;     // width of the band, at right angles to its direction
    int segments = 1;
    double fill = 1;                  // share of its sector that a segment covers
    std::vector<bool> on;             // state of each segment, counted from +x towards +y
    std::optional<double> lit_radius; // radius about the axis that all of the ring must light; none: the field
};

// A Lambertian source: a disc or a rectangle behind the illuminator, or a ring light. Lengths in mm, flux in W.
struct SourceDescription {
    std::string key = "source"; // key of its table, for messages
    double flux = 1;
    double radius = 0;                   // radius of the disc
    std::optional<glm::dvec2> rectangle; // width and height of a rectangle instead of the disc
    // The distance from disc or rectangle to the illumination's first vertex; none: the prescription's.
    std::optional<double> distance;
    std::optional<RingLightDescription> ring; // ring light instead of disc, rectangle and illuminator
    std::optional<Spectrum> spectrum;         // none: the instrument's

    double outer_radius() const; // circumscribed circle of the disc or rectangle
    double inner_radius() const; // inscribed circle
};

struct BeamSplitter {
    enum class Kind { ideal, plate, cube } kind = Kind::ideal;
    double reflectance = 0.5;   // for the illumination
    double transmittance = 0.5; // for the imaging; the remaining light is absorbed
    Medium glass = Medium::air();
    double size = 0;                // thickness of the plate, edge of the cube
    std::optional<double> distance; // from the objective's back vertex; none: half way to the tube lens
    std::optional<double> semi_diameter;
};

// A plane mirror in the infinity space.
struct FoldMirror {
    enum class Path { imaging, illumination } path = Path::imaging;
    double distance = 0;  // behind the objective's back vertex (imaging) or the illuminator's last vertex
    double incidence = 0; // angle of incidence of the axis, rad
    double azimuth = 0;   // azimuth of the plane of incidence about the axis, rad
    double semi_diameter = 0;
    double reflectance = 1;
};

// A plane-parallel plate over the specimen.
struct CoverGlass {
    double thickness = 0;
    Medium glass = Medium::air();
    // The height of the lower face above the paraxial object plane; none: half the free distance.
    std::optional<double> distance;
};

// Deviations of the image from the one that the lenses make (shaders/physics/image_distortion.glsl): those of a real
// instrument whose prescription is not known, or that are put in to see what they do to heights.
struct ImageDeviations {
    double distortion = 0;         // share by which places at field_height are recorded too far from the axis
    double field_height = 1;       // mm on the specimen
    double shear = 0;              // rad by which the angle from the rows to the columns exceeds a right one
    double magnification_rate = 0; // 1/mm: growth of the magnification with the height of the focal plane, relative
    double greatest_height = 0;    // mm, of the focal plane from z = 0, at which light is to be traced
};

// The instrument of a configuration, in internal units (mm, W, rad, wavelengths in um).
struct InstrumentDescription {
    SourceDescription source;
    std::vector<SourceDescription> further_sources; // ring lights
    // The spectrum of all light together, to which first-order data and best focus belong.
    Spectrum spectrum = Spectrum::line(0.5876);
    Prescription illumination;
    // The distance from the last illumination vertex to the objective's back vertex; none: the source is imaged into
    // the pupil.
    std::optional<double> illumination_to_objective;
    std::optional<double> field_stop_radius;            // none: the prescription's
    std::optional<LightField> light_field;              // transmission of the field stop's plane; none: 1 everywhere
    std::optional<double> illumination_aperture_radius; // radius of a stop at the source
    BeamSplitter splitter;
    std::vector<FoldMirror> fold_mirrors;
    Interfaces interfaces;
    Prescription objective;                     // from the specimen to the back
    std::optional<Medium> immersion;            // medium between specimen and objective; none: the prescription's
    std::optional<double> aperture_stop_radius; // none: the prescription's
    std::optional<CoverGlass> cover_glass;
    Placement objective_placement;
    Prescription tube_lens; // from the objective to the detector
    Placement tube_lens_placement;
    double objective_to_tube_lens = 100;
    double detector_width = 0; // along the rows, in the detector's plane; pixels are square
    ImageSize detector_pixels;
    double fill_factor = 1; // sensitive share of a pixel's area, a square in its middle
    Placement detector_placement;
    ImageDeviations image;
    std::vector<MeshElement> meshes; // only for the non-sequential mode
    bool directed_emission = true;   // aim the source at directions that can pass the illumination train
    bool single_scatter = false;     // also compute the aim at the detector for light scattered once
    bool turned = false;             // also compute the form for the backward estimator
    // The largest distance of the specimen's top plane from the plane of best focus, for the acceptance bound.
    double greatest_defocus = 0.2;

    std::vector<const SourceDescription*> sources() const; // all sources, the first one first
};

// First-order and measured properties at the reference wavelength (mm, unless the name says otherwise).
struct FirstOrder {
    double efl_objective = 0;
    double efl_tube_lens = 0;
    double numerical_aperture = 0; // object side, n sin, of the on-axis cone through all apertures
    double object_index = 1;       // index of the medium over the specimen
    double working_distance = 0;   // from the paraxial focus to the first vertex above it (objective or cover glass)
    double magnification = 0;      // signed, paraxial, at the detector
    double depth_of_field = 0;     // n lambda / NA^2: ISO 25178-604's optical depth of field
    double pixel_pitch = 0;        // in the object plane
    // Heights of focus for a point on the axis, above the paraxial plane, towards the objective (+z). Its light fills
    // the real apertures with uniform density in direction cosines, as a Lambertian specimen's does.
    double best_focus_offset = 0; // least variance of the wavefront over the spectrum: z = 0 of a scan
    double least_spot_offset = 0; // least RMS distance of the rays from their centroid on the detector
    // Best focus relative to that on the axis (+z); with displaced parts the mean over all directions.
    double field_curvature = 0;           // at the field's edge
    double field_curvature_corner = 0;    // in the field's corners
    double field_edge = 0;                // field height of the edge: half the longer side in the object
    glm::dvec2 field_corner{0};           // half of both sides of the field in the object
    double pupil_radius_in_source = 0;    // radius of source that fills the objective's pupil; 0: a ring light
    double illumination_to_objective = 0; // the distance given, or the one computed
    double source_magnification = 0;      // paraxial magnification of the source's image in the objective's pupil
    // The paraxial signed magnification of the field stop's image on the specimen; 0: no stop.
    double field_stop_magnification = 0;
};

// The part of the instrument to which an element belongs.
enum class Part { illuminator, beam_splitter, fold_mirror, cover_glass, objective, tube_lens, detector };
const char* name_of(Part part); // "tube lens"

// An element placed in the room, for drawing and for non-sequential tracing. The frame is the specimen's with its
// origin on the axis in the plane of best focus (mm), the objective at rest; the splitter and the mirrors fold the
// path.
struct Element {
    enum class Kind { surface, stop, mirror, splitter, ideal_lens, detector } kind = Kind::surface;
    physics::f64::Surface surface{}; // z of its frame: the direction of imaging; in the illuminator, that of its light
    Pose pose;
    SurfaceName name;
    Part part = Part::objective;
};

// The reversed instrument for the backward estimator (shaders/physics/backward.glsl): its illumination train leads from
// the detector to the specimen, its imaging train from there to the source.
struct TurnedInstrument {
    std::vector<physics::f64::Surface> surfaces;
    physics::f64::Instrument constants{};
    physics::f64::BackwardOptics optics{}; // its disc of pupil_radius contains all light
    // The slope of the pupil's edge, like pupil_radius; 0: no circle, or not the same all over the field.
    double pupil_rim = 0;
};

// The trains and constants of the instrument in double precision, with the light of one source. `surfaces` holds the
// illumination train (source to specimen: illuminator, then the objective backward) and the imaging train (specimen to
// detector). Light travels towards +z in both; the specimen frame is the illumination's rotated by half a turn about x.
// Constant throughout a run.
struct Instrument {
    std::vector<physics::f64::Surface> surfaces;
    std::vector<std::string> surface_names; // for the ledger: "illumination 3 (koehler 1)", ...
    std::vector<physics::f64::SpectralBin> spectral_bins;
    physics::f64::Instrument constants{};
    std::uint32_t features = 0;            // physics::FEATURE_*
    std::optional<LightField> light_field; // its record is also among the constants
    FirstOrder first_order;
    double flux = 1;               // W, emitted over the hemisphere
    double fill_factor = 1;        // fill factor of the pixels
    double magnification_rate = 0; // 1/mm, ImageDeviations::magnification_rate
    // The farthest place from the axis that ImageDeviations let the detector see, over its corner's; at least 1.
    double image_reach = 1;
    double splitter_reflectance = 0.5;   // for the illumination; 1 for a ring light, which bypasses it
    double splitter_transmittance = 0.5; // for the imaging
    // The number of surfaces of each train that light meets before the beam splitter's mirror.
    int illumination_surfaces_before_splitter = 0;
    int imaging_surfaces_before_splitter = 0;
    // Height of the front vertex of the objective (or cover glass) above the plane of best focus (z = 0 of the specimen
    // frame, scan at 0).
    double front_vertex_height = 0;
    std::vector<Element>
        elements; // in the order of the light: illuminator, splitter, cover glass, objective, ... detector
    std::vector<PlacedMesh> meshes; // in the elements' frame; only the non-sequential mode traces them
    // The pose, in the elements' frame, of the source's frame, which emits towards +z (for a ring light: of its aim).
    Pose source_pose;
    std::optional<TurnedInstrument> turned;       // none unless the description asks for it
    std::optional<glm::dvec2> single_scatter_aim; // aim_at_detector(); none unless the description asks for it
    std::vector<Warning> warnings;
    std::vector<Instrument> further_lights; // the same instrument in the light of each further source

    std::vector<const Instrument*> lights() const; // one for each source, this one first
    TrainScene scene() const { return {surfaces, features, spectral_bins, light_field ? &*light_field : nullptr}; }
    double aimed_share() const; // share of the flux that leaves in the aimed directions
    ImageSize detector_pixels() const { return {constants.detector_columns, constants.detector_rows}; }
};

// The instrument with the trains and constants of its reversed form.
Instrument turned_round(const Instrument& instrument);

// The instrument for paths that meet the specimen once: with the aim at the detector, if there is one.
Instrument aimed_for_single_scatter(Instrument instrument);

// The instrument with pixels that collect over their full area, for images that the wave filter distributes
// (PupilFilter).
Instrument with_whole_pixels(Instrument instrument);

// Assembles the instrument. Throws InputError where parts do not fit together (no real image, illumination too long to
// fit, ...).
Instrument assemble(const InstrumentDescription& description);

} // namespace vkfv::optics
