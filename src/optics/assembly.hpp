// How an instrument is put together: the parts that its description names, placed one after another, and what
// is known of them so far. Only instrument.cpp and the stages' own files include this.
#pragma once

#include "optics/apertures.hpp"
#include "optics/instrument.hpp"

#include <optional>
#include <string>
#include <vector>

namespace vkfv::optics {

using Part = std::vector<PlacedSurface>;

[[noreturn]] void refuse(std::string key, std::string found, std::string expected, std::string remedy,
                         const std::filesystem::path& file = {});
void require_positive(double value, const char* key);
void require_surfaces(const Prescription& prescription, const char* key);
void require_air(double index, const Prescription& prescription, const char* key);

// The prescription with another radius (mm) of the stop of this role; none: as it is.
Prescription with_stop(Prescription prescription, PrescribedSurface::Role role, std::optional<double> radius,
                       const char* key);

void append(Part& train, const Part& part);
RayTransfer transfer_of(Part part); // from its first vertex on
physics::f64::Surface transfer_between(const Pose& from, const PlacedSurface& to);
Pose downward(double height); // the frame of light that comes down: half a turn about x
Pose placed_at(const Placement& placement, const Pose& nominal);

// Poses are in the specimen's frame with its origin in the paraxial object plane (mm), unfolded: in the
// straight space that mirrors show. Each stage fills in what stands below it; `instrument` grows with all of
// them.
struct Assembly {
    explicit Assembly(const InstrumentDescription& description);

    void lay_out();                    // 1: focal lengths, and where the parts stand along the axis
    void assemble_imaging();           // 2: the train from specimen to detector
    void measure_imaging();            //    and what it does, by tracing
    void assemble_ring();              // 3: the train from the ring light to the specimen
    void assemble_illuminator();       //   or from the disc
    double ring_emission_sine() const; //  and into what cone the ring shines
    void reduce();                     // 4: the constants of the trace
    void turn_round();                 //    and the same for light the other way
    void furnish();                    // 5: the elements as they stand in the room, folded

    // A plate of glass between two planes; `medium` on both sides.
    Part plate(const Pose& first, double thickness, const Medium& glass, const Medium& medium,
               std::optional<double> semi_diameter, const std::string& name) const;
    PlacedSurface mirror_plane(const Pose& pose, std::optional<double> semi_diameter, std::string name) const;

    // What stands in the infinity space of one train, in the order of its light.
    struct Inserted {
        double distance = 0;
        Part surfaces;
    };
    struct Fold {
        FoldMirror::Path path;
        double distance;
        PlacedSurface mirror; // unfolded
    };
    void add_fold(const FoldMirror& fold, const Pose& axis, std::vector<Inserted>& into);
    std::string key_of(const FoldMirror& fold) const;               // of its distance, for messages
    std::vector<const Fold*> folds_of(FoldMirror::Path path) const; // by distance

    const InstrumentDescription& description;
    const Spectrum& spectrum;
    const BeamSplitter& splitter;
    SpectralIndex air;
    Instrument instrument{};
    FirstOrder& first_order = instrument.first_order;
    physics::f64::Instrument& constants = instrument.constants;

    // 1
    Prescription objective_lens; // with its immersion and stop
    SpectralIndex object_index;  // of the medium over the specimen
    Part straight_objective;     // without placements, its first vertex at the origin
    Part straight_tube_lens;
    Part cover;                 // glass
    double field_half_side = 0; // of the detector, in the object
    double field_half_diagonal = 0;
    double detector_distance = 0; // from the tube lens' last vertex
    double objective_front = 0;   // heights of its vertices
    double back = 0;
    Pose front; // frame in which the imaging train is entered
    // 2
    Part objective;
    Part tube_lens;
    double splitter_distance = 0; // behind the objective
    double splitter_height = 0;
    Pose splitter_pose;
    double half_size = 0;  // of the cube
    Part splitter_imaging; // its surfaces in the imaging train
    std::vector<Fold> folds;
    Pose detector_pose;
    Part imaging_train;
    std::vector<physics::f64::Surface> imaging_surfaces;
    std::optional<std::size_t> aperture_stop; // of the objective's surfaces
    Imaging imaging;
    // 3
    Part illuminator;
    Part illumination_train;
    double aimed_sine = 1; // of the cone that the source must fill
};

} // namespace vkfv::optics
