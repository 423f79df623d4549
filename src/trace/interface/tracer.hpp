// From a seed and a focal position to an image: the trace, on a Vulkan device or on the host in double.
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/instrument/instrument.hpp"
#include "optics/waves/pupil_filter.hpp"
#include "specimen/specimen.hpp"
#include "trace/interface/checkpoint.hpp"
#include "trace/interface/tracer_identity.hpp"
#include "vulkan/opened_device.hpp"

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::trace {

enum class Traversal { automatic, ray_query, quadtree, bvh };

// forward: from the source, counted on the detector. backward: from the detector, collecting the source's radiance.
enum class Estimator { forward, backward };

struct TraceOptions {
    Estimator estimator = Estimator::forward; // backward asks for an instrument that was turned round too
    std::uint64_t rays = 0;                   // launched per image; backward: at least, see backward_plan()
    std::uint32_t seed = 1;
    int max_bounces = 2;
    Traversal traversal = Traversal::automatic;
    std::uint64_t batch = 0;         // rays in flight at once; 0: what suits the device
    std::uint64_t batch_divisor = 1; // of what `batch` says
    std::string device;              // selector: an index or a part of the name
    vulkan::OpenedDevice opened;     // that device, if it is open or being opened
    bool nonsequential = false;      // light finds its own way, and interfaces split it
    bool directed_scatter = false;   // forward, sequential: every bounce also aims at the pupil, and light has weights
    std::optional<bool> instrument_in_constants; // of the forward kernels; none: where it pays
    std::optional<bool> for_software;            // the kernels' form for such devices; none: as the device is
    bool illumination_polynomials = true;        // where it is in constants: optics/instrument/train_polynomials.hpp
    std::optional<optics::WaveOptions> waves;    // sequential: images as waves make them; none: as rays do
};

// How many rays an exposure launches: those asked for, or what each pixel's share is rounded up to backward, for each
// source by itself.
std::uint64_t launched_rays(const TraceOptions& options, const optics::InstrumentDescription& instrument);

enum class Train { none, illumination, imaging };

// Where the emitted power of one image went; W. emitted = the sum of all others.
struct Ledger {
    enum class Status {
        // Fates of paths, in the order of physics::PATH_ALIVE and the following.
        under_way,
        detected,
        beside_specimen,
        outside_pupil,
        bounce_limit,
        beside_detector,
        numerical,
        absorbed,
        interaction_limit,
        vignetted, // these four at a surface
        missed,
        totally_reflected,
        lost_in_reflection,
        // What is not traced.
        not_aimed_at,
        splitter_towards_specimen,
        splitter_towards_detector,
        not_followed_backward
    };
    struct Entry {
        std::string name; // for people: "detected", "vignetted at imaging 3 (10x_0.28 3)", ...
        double power = 0; // W
        std::uint64_t rays = 0;
        Status status = Status::under_way;
        Train train = Train::none; // of the surface; none: it is an element, or there is no surface
        int surface = -1;          // of its train, or of Room::elements, from 0; -1: none
    };
    double emitted = 0;
    std::vector<Entry> entries; // always the same names in the same order for one instrument
    double residual() const;    // emitted minus the sum, W
    double residual_error = 0;  // its standard error, W; 0: the ledger closes exactly
};

// One exposure. Radiant flux per pixel in W and the standard error of each; rows ascend with y. Waves make the errors
// of neighbouring pixels depend on each other; the one told is the rays', times the filter's noise.
struct Image {
    Grid<double> flux;
    Grid<double> standard_error;
    Ledger ledger;
    std::uint64_t rays = 0;
    std::uint64_t detected = 0; // rays
    double crossings = 0;       // of surfaces in sequence, of all rays together
    // The rest enters no image; s. Exposures that are under way at a time share the wall clock.
    double seconds = 0;            // wall clock, from beginning to end
    double device_seconds = 0;     // the device's work, by its own clock; parted: the devices' mean
    double longest_submission = 0; // of that work
    double device_begin = 0;       // on that clock, from the tracer's first exposure on
    double device_end = 0;
    int device = 0; // place of the device among those that work together
};

// What a part of an exposure counted: integers, which of all parts together, added up, make the image.
struct ExposurePart {
    std::vector<std::uint64_t> numbers;
    double device_seconds = 0;     // s, as Image has it
    double longest_submission = 0; // s
};

// Where the stage holds the focal plane for an exposure.
struct FocalPosition {
    double height = 0;    // of the focal plane in the specimen frame, mm: z of the image
    glm::dvec2 beside{0}; // the specimen's displacement at right angles to the axis, mm
    FocalPosition() = default;
    FocalPosition(double z, glm::dvec2 displacement = glm::dvec2(0)) : height(z), beside(displacement) {}
};

// Constructed for one instrument, specimen and device, then const: exposures are independent of each other.
class Tracer {
  public:
    virtual ~Tracer() = default;
    // image: the index that keys the random numbers. The same arguments give the same bits whatever the batch size.
    virtual Image expose(FocalPosition position, std::uint32_t image) const = 0;
    // The same image, later: a device works on it from now on, and the host takes what came of it when the future is
    // asked (or dropped). At most most_under_way() futures may be neither. The tracer must outlive them.
    // checkpoints: from where it goes on, and where a long one is kept meanwhile; the bits are the same. The host
    // keeps none.
    virtual std::future<Image> begin(FocalPosition position, std::uint32_t image,
                                     std::shared_ptr<const Checkpoints> /*checkpoints*/ = nullptr) const {
        return std::async(std::launch::deferred, [this, position, image] { return expose(position, image); });
    }
    virtual int most_under_way() const { return 1; }
    // Units of work of an exposure, of which some tracers count parts: first ... end - 1. The image comes of a
    // checkpoint with all units done and the parts' sum. 0: these do not.
    virtual std::uint64_t units() const { return 0; }
    virtual std::uint64_t rays_per_unit() const { return 1; }
    virtual ExposurePart count(FocalPosition /*position*/, std::uint32_t /*image*/, std::uint64_t /*first*/,
                               std::uint64_t /*end*/) const {
        return {};
    }
    virtual std::string description() const = 0; // device, traversal and the reason for both
    virtual TracerIdentity identity() const = 0;
    // That it works on, for further work there; none: the host.
    virtual std::shared_ptr<const vulkan::Device> device() const { return nullptr; }
    // What makes its images as waves do, one a light of the instrument; none: they are as rays make them.
    virtual std::vector<optics::PupilFilter> pupil_filters() const { return {}; }

  protected:
    static std::vector<optics::PupilFilter> filters_of(const std::optional<optics::PupilFilter>& filter) {
        return filter ? std::vector{*filter} : std::vector<optics::PupilFilter>{};
    }
};

// The identity that a tracer would have, without opening the device. Throws DeviceError, InputError.
TracerIdentity expected_identity(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                 const TraceOptions& options);

} // namespace vkfv::trace
