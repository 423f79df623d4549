// How an instrument is put together: stages one after another, each a function of the description and of what the
// earlier stages found. Only instrument.cpp and the stages' own files include this. Poses are in the specimen's frame
// with its origin in the paraxial object plane (mm), unfolded: in the straight space that mirrors show.
#pragma once

#include "optics/aim/aim.hpp"
#include "optics/aim/apertures.hpp"
#include "optics/aim/light_hull.hpp"
#include "optics/instrument/instrument.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::optics {

using PlacedSurfaces = std::vector<PlacedSurface>;

// Where the parts stand along the axis, paraxially: the object in the front focal plane of the objective behind its
// cover glass, the detector in the tube lens' back focal plane. Lengths in mm, heights over the paraxial object plane.
struct AxialLayout {
    SpectralIndex air;
    Prescription objective_lens; // with its immersion and stop
    SpectralIndex object_index;  // of the medium over the specimen
    // Without placements, the first vertex at the origin.
    PlacedSurfaces straight_objective;
    PlacedSurfaces straight_tube_lens;
    PlacedSurfaces cover; // glass
    double efl_objective = 0;
    double efl_tube_lens = 0;
    double magnification = 0; // signed
    double working_distance = 0;
    glm::dvec2 field_corner{0}; // of the detector, in the object
    double field_half_diagonal = 0;
    double detector_distance = 0; // from the tube lens' last vertex
    double objective_front = 0;   // heights of its vertices
    double objective_back = 0;
    Pose front; // frame in which the imaging train is entered
};
AxialLayout lay_out(const InstrumentDescription& description);

// A fold mirror, unfolded.
struct Fold {
    double distance = 0; // FoldMirror::distance
    PlacedSurface mirror;
};

struct PlacedSplitter {
    double distance = 0; // behind the objective
    double height = 0;
    Pose pose;
    double half_size = 0;    // of the cube
    PlacedSurfaces surfaces; // in the imaging train
};

struct ImagingTrain {
    PlacedSurfaces objective;
    PlacedSurfaces tube_lens;
    PlacedSplitter splitter;
    std::vector<Fold> folds; // by distance
    Pose detector_pose;
    PlacedSurfaces train; // from specimen to detector
    int surfaces_before_splitter = 0;
    std::size_t aperture_stop = 0; // of the objective's surfaces
    Imaging imaging;               // the train's surfaces linked
    // The train of light from the detector, which ends in the plane of the front vertex.
    std::vector<physics::f64::Surface> from_detector;
};
ImagingTrain place_imaging(const InstrumentDescription& description, const AxialLayout& layout);

// What the imaging train does, by tracing.
struct MeasuredImaging {
    double numerical_aperture = 0;
    double depth_of_field = 0;
    double best_focus_offset = 0; // these as in FirstOrder
    double least_spot_offset = 0;
    double field_curvature = 0;
    double field_curvature_corner = 0;
    std::vector<Warning> warnings;
};
MeasuredImaging measure_imaging(const InstrumentDescription& description, const AxialLayout& layout,
                                const ImagingTrain& imaging);

// What holds all light of the description's source between detector and specimen, over the spectrum and the detector's
// field, on planes up to the greatest defocus above and below best focus (greatest_of()).
class DetectorHulls {
  public:
    DetectorHulls(const InstrumentDescription& description, const AxialLayout& layout, const ImagingTrain& imaging,
                  const MeasuredImaging& measured);

    double gate_radius() const;  // of physics::Instrument
    double field_radius() const; // mm, about the axis: what the detector sees of those planes
    // Of the exit pupil, a disc of slopes about per_position (1/mm) times the place on the detector.
    double pupil_radius(double per_position) const;
    // The least distance from that disc's middle at which light ends, radius: the disc's.
    double least_pupil_rim(double per_position, double radius) const;

    const Range& spectral() const { return light_.spectral; } // x of physics::Light
    const Range& heights() const { return heights_; }         // mm, of those planes above the paraxial object plane

  private:
    DiscLight light_;
    Range heights_;
    double working_distance_;
    double gate_position_;
};

struct Illumination {
    PlacedSurfaces illuminator; // with its aperture; none for a ring light
    std::vector<Fold> folds;    // by distance
    PlacedSurfaces train;       // from the source to the specimen
    int surfaces_before_splitter = 0;
    Pose source_pose;
    double source_distance = 0;     // of the disc, to the first vertex
    physics::f64::RingLight ring{}; // instead of the disc
    Aim aim;                        // of the source
    double to_objective = 0;        // these as in FirstOrder
    double source_magnification = 0;
    double pupil_radius_in_source = 0;
    double field_stop_magnification = 0;
    std::vector<Warning> warnings;
};
Illumination place_ring(const InstrumentDescription& description, const AxialLayout& layout,
                        const MeasuredImaging& measured);
Illumination place_illuminator(const InstrumentDescription& description, const AxialLayout& layout,
                               const ImagingTrain& imaging);

// The light the other way. `instrument` has its trains and constants.
TurnedInstrument turn_round(const InstrumentDescription& description, const AxialLayout& layout,
                            const ImagingTrain& imaging, const DetectorHulls& hulls, const Illumination& illumination,
                            const Instrument& instrument);

// Every element once, the light's way folded, heights over the plane of best focus.
struct FoldedElements {
    std::vector<Element> elements;
    Pose source_pose;
};
FoldedElements fold(const InstrumentDescription& description, const AxialLayout& layout, const ImagingTrain& imaging,
                    const MeasuredImaging& measured, const Illumination& illumination);

// In the frame of the folded elements.
std::vector<PlacedMesh> place_meshes(const InstrumentDescription& description, const MeasuredImaging& measured);

// What stages share.

[[noreturn]] void refuse(std::string key, std::string found, std::string expected, std::string remedy,
                         const std::filesystem::path& file = {});
void require_positive(double value, const std::string& key);
void require_surfaces(const Prescription& prescription, const char* key);
void require_air(double index, const Prescription& prescription, const char* key);

// The prescription with another radius (mm) of the stop of this role; none: as it is.
Prescription with_stop(Prescription prescription, SurfaceRole role, std::optional<double> radius, const char* key);

void append(PlacedSurfaces& train, const PlacedSurfaces& part);
RayTransfer transfer_of(PlacedSurfaces part); // from its first vertex on
physics::f64::Surface transfer_between(const Pose& from, const PlacedSurface& to);
Pose downward(double height); // the frame of light that comes down: half a turn about x
Pose placed_at(const Placement& placement, const Pose& nominal);
bool has_displaced(const std::vector<physics::f64::Surface>& train);

// Ends a train in this plane, unless it ends there already.
void end_in(PlacedSurfaces& train, const PlacedSurface& plane);

// A plate of glass between two planes; `medium` on both sides.
PlacedSurfaces plate(const InstrumentDescription& description, const Pose& first, double thickness, const Medium& glass,
                     const Medium& medium, std::optional<double> semi_diameter, const std::string& name);
PlacedSurface mirror_plane(const SpectralIndex& medium, const Pose& pose, std::optional<double> semi_diameter,
                           std::string what);

// A fold mirror of the description on an axis whose origin is at the mirror.
Fold place_fold(const FoldMirror& mirror, const SpectralIndex& air, const Pose& axis);
std::string distance_key(const InstrumentDescription& description, const FoldMirror& mirror); // for messages

} // namespace vkfv::optics
