// The stages that assemble an instrument, one after another, each a function of the description and of the results of
// earlier stages. Only instrument.cpp and the stages' own files include this. Poses are in the specimen's frame with
// its origin in the paraxial object plane (mm), in the unfolded (straight) space that mirrors show.
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

// The paraxial positions of the parts along the axis: the object in the front focal plane of the objective behind its
// cover glass, the detector in the tube lens' back focal plane. Lengths in mm, heights above the paraxial object plane.
struct AxialLayout {
    SpectralIndex air;
    Prescription objective_lens; // with the description's immersion and stop
    SpectralIndex object_index;  // index of the medium over the specimen
    // The objective without its placement, the first vertex at the origin.
    PlacedSurfaces straight_objective;
    PlacedSurfaces straight_tube_lens;
    PlacedSurfaces cover; // surfaces of the cover glass
    double efl_objective = 0;
    double efl_tube_lens = 0;
    double magnification = 0; // signed
    double working_distance = 0;
    glm::dvec2 field_corner{0}; // corner of the detector's field in the object
    double field_half_diagonal = 0;
    double image_distortion = 0; // 1/mm^2 on the detector (shaders/physics/image_distortion.glsl)
    // The farthest place of the detector's field in the object, at any focal height, over field_half_diagonal; at least
    // 1. It exceeds 1 where the image is compressed.
    double reach = 1;
    double seen_half_diagonal() const { return reach * field_half_diagonal; }
    double detector_distance = 0; // from the tube lens' last vertex
    double objective_front = 0;   // heights of the first and last vertex
    double objective_back = 0;
    Pose front; // frame in which light enters the imaging train
};
AxialLayout lay_out(const InstrumentDescription& description);
// image_shear of shaders/physics/image_distortion.glsl.
double image_shear(const ImageDeviations& image);

// A fold mirror in the unfolded space.
struct Fold {
    double distance = 0; // FoldMirror::distance
    PlacedSurface mirror;
};

struct PlacedSplitter {
    double distance = 0; // behind the objective's back vertex
    double height = 0;
    Pose pose;
    double half_size = 0;    // half the edge of a cube
    PlacedSurfaces surfaces; // surfaces in the imaging train
};

struct ImagingTrain {
    PlacedSurfaces objective;
    PlacedSurfaces tube_lens;
    PlacedSplitter splitter;
    std::vector<Fold> folds; // sorted by distance
    Pose detector_pose;
    PlacedSurfaces train; // from specimen to detector
    int surfaces_before_splitter = 0;
    std::size_t aperture_stop = 0; // index into the objective's surfaces
    Imaging imaging;               // with the train's surfaces linked
    // The train for light from the detector, which ends in the plane of the front vertex.
    std::vector<physics::f64::Surface> from_detector;
};
ImagingTrain place_imaging(const InstrumentDescription& description, const AxialLayout& layout);

// Properties of the imaging train, measured by tracing.
struct MeasuredImaging {
    double numerical_aperture = 0;
    double depth_of_field = 0;
    double best_focus_offset = 0; // this and the next three: see FirstOrder
    double least_spot_offset = 0;
    double field_curvature = 0;
    double field_curvature_corner = 0;
    std::vector<Warning> warnings;
};
MeasuredImaging measure_imaging(const InstrumentDescription& description, const AxialLayout& layout,
                                const ImagingTrain& imaging);

// Bounds of all light of the description's source between detector and specimen, over the spectrum and the detector's
// field, on planes up to the greatest defocus above and below best focus (greatest_of()).
class DetectorHulls {
  public:
    DetectorHulls(const InstrumentDescription& description, const AxialLayout& layout, const ImagingTrain& imaging,
                  const MeasuredImaging& measured);

    double gate_radius() const;  // acceptance bound of physics::Instrument
    double field_radius() const; // mm, radius about the axis of the field that the detector sees on those planes
    // The radius of the exit pupil: a disc of slopes about per_position (1/mm) times the position on the detector.
    double pupil_radius(double per_position) const;
    // The least distance from that disc's centre at which passing light ends. radius: the disc's.
    double least_pupil_rim(double per_position, double radius) const;

    const Range& spectral() const { return light_.spectral; } // x of physics::Light
    const Range& heights() const { return heights_; }         // mm, of those planes, above the paraxial object plane

  private:
    DiscLight light_;
    Range heights_;
    double working_distance_;
    double gate_position_;
};

struct Illumination {
    PlacedSurfaces illuminator; // with its aperture; empty for a ring light
    std::vector<Fold> folds;    // sorted by distance
    PlacedSurfaces train;       // from the source to the specimen
    int surfaces_before_splitter = 0;
    Pose source_pose;
    double source_distance = 0;     // from the disc to the first vertex
    physics::f64::RingLight ring{}; // for a ring light, instead of the disc
    Aim aim;                        // aim of the source's emission
    double to_objective = 0;        // this and the next three: see FirstOrder
    double source_magnification = 0;
    double pupil_radius_in_source = 0;
    double field_stop_magnification = 0;
    std::vector<Warning> warnings;
};
Illumination place_ring(const InstrumentDescription& description, const AxialLayout& layout,
                        const MeasuredImaging& measured);
Illumination place_illuminator(const InstrumentDescription& description, const AxialLayout& layout,
                               const ImagingTrain& imaging);

// The form of the instrument for the backward estimator. `instrument` has its trains and constants already.
TurnedInstrument turn_round(const InstrumentDescription& description, const AxialLayout& layout,
                            const ImagingTrain& imaging, const DetectorHulls& hulls, const Illumination& illumination,
                            const Instrument& instrument);

// Each element once, in the folded space, with heights above the plane of best focus.
struct FoldedElements {
    std::vector<Element> elements;
    Pose source_pose;
};
FoldedElements fold(const InstrumentDescription& description, const AxialLayout& layout, const ImagingTrain& imaging,
                    const MeasuredImaging& measured, const Illumination& illumination);

// Places the meshes in the frame of the folded elements.
std::vector<PlacedMesh> place_meshes(const InstrumentDescription& description, const MeasuredImaging& measured);

// Helpers that several stages use.

[[noreturn]] void refuse(std::string key, std::string found, std::string expected, std::string remedy,
                         const std::filesystem::path& file = {});
void require_positive(double value, const std::string& key);
void require_surfaces(const Prescription& prescription, const char* key);
void require_air(double index, const Prescription& prescription, const char* key);

// The prescription with the radius (mm) of the stop of this role replaced; none leaves it unchanged.
Prescription with_stop(Prescription prescription, SurfaceRole role, std::optional<double> radius, const char* key);

void append(PlacedSurfaces& train, const PlacedSurfaces& part);
RayTransfer transfer_of(PlacedSurfaces part); // from the part's first vertex
physics::f64::Surface transfer_between(const Pose& from, const PlacedSurface& to);
Pose downward(double height); // frame of descending light: half a turn about x
Pose placed_at(const Placement& placement, const Pose& nominal);
bool has_displaced(const std::vector<physics::f64::Surface>& train);

// Ends a train in this plane, unless the train ends there already.
void end_in(PlacedSurfaces& train, const PlacedSurface& plane);

// A plate of glass between two planes, with `medium` on both sides.
PlacedSurfaces plate(const InstrumentDescription& description, const Pose& first, double thickness, const Medium& glass,
                     const Medium& medium, std::optional<double> semi_diameter, const std::string& name);
PlacedSurface mirror_plane(const SpectralIndex& medium, const Pose& pose, std::optional<double> semi_diameter,
                           std::string what);

// A fold mirror of the description on the axis `axis`, whose origin is at the mirror.
Fold place_fold(const FoldMirror& mirror, const SpectralIndex& air, const Pose& axis);
std::string distance_key(const InstrumentDescription& description, const FoldMirror& mirror); // key for messages

} // namespace vkfv::optics
