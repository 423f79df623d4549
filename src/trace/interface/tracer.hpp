// The trace of an image from a seed and a focal position, on a Vulkan device or on the host in double.
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

// forward counts light from the source on the detector; backward collects the source's radiance from the detector.
enum class Estimator { forward, backward };

struct TraceOptions {
    Estimator estimator = Estimator::forward; // backward needs an instrument with a reversed form (turned_round()) too
    std::uint64_t rays = 0;                   // launched per image; backward: at least so many, see backward_plan()
    std::uint32_t seed = 1;
    int max_bounces = 2;
    Traversal traversal = Traversal::automatic;
    std::uint64_t batch = 0;         // rays in flight at once; 0: a number that suits the device
    std::uint64_t batch_divisor = 1; // divisor of `batch`
    std::string device;              // selector: an index or a part of the name
    vulkan::OpenedDevice opened;     // the same device, if it is open or being opened
    bool nonsequential = false;      // elements are met in any order, and interfaces split light
    bool directed_scatter = false;   // forward, sequential: every bounce also aims at the pupil, and light has weights
    std::optional<bool> instrument_in_constants; // in the forward kernels; none: where it pays
    std::optional<bool> for_software;            // kernels in the form for software devices; none: as the device is
    bool illumination_polynomials = true;        // if the illumination is in constants:
                                                 // optics/instrument/train_polynomials.hpp
    std::optional<optics::WaveOptions> waves;    // sequential: wave images; none: images of rays
};

// The number of rays that an exposure launches: those asked for, or backward those with each pixel's share rounded up,
// for each source by itself.
std::uint64_t launched_rays(const TraceOptions& options, const optics::InstrumentDescription& instrument);

enum class Train { none, illumination, imaging };

// The ledger of one image: the fate of the emitted power, W. emitted = the sum of all entries.
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
        vignetted, // this and the next three are at a surface
        missed,
        totally_reflected,
        lost_in_reflection,
        // Power that is not traced.
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
        Train train = Train::none; // train of the surface; none: an element, or there is no surface
        int surface = -1;          // index in its train, or in Room::elements, from 0; -1: none
    };
    double emitted = 0;
    std::vector<Entry> entries; // always the same names in the same order for one instrument
    double residual() const;    // emitted minus the sum, W
    double residual_error = 0;  // standard error of the residual, W; 0: the ledger closes exactly
};

// One exposure. Radiant flux per pixel in W and the standard error of each; rows ascend with y. With waves the errors
// of neighbouring pixels are correlated; the reported error is that of the rays times the filter's noise gain.
struct Image {
    Grid<double> flux;
    Grid<double> standard_error;
    Ledger ledger;
    std::uint64_t rays = 0;
    std::uint64_t detected = 0; // rays
    double crossings = 0;       // crossings of surfaces in sequence, all rays together
    // The following members enter no image; times in s. Exposures that are under way together share the wall clock.
    double seconds = 0;            // wall clock, from beginning to end
    double device_seconds = 0;     // the device's work, by its own clock; for parted exposures the devices' mean
    double longest_submission = 0; // longest submission of that work
    double device_begin = 0;       // by the device's clock, from the tracer's first exposure on
    double device_end = 0;
    int device = 0; // place of the device among those that work together
};

// The integers that a part of an exposure counted; the sum over all parts makes the image.
struct ExposurePart {
    std::vector<std::uint64_t> numbers;
    double device_seconds = 0;     // s, as in Image
    double longest_submission = 0; // s
};

// The position in which the stage holds the focal plane for an exposure.
struct FocalPosition {
    double height = 0;    // mm, of the focal plane in the specimen frame: z of the image
    glm::dvec2 beside{0}; // mm, the specimen's displacement at right angles to the axis
    FocalPosition() = default;
    FocalPosition(double z, glm::dvec2 displacement = glm::dvec2(0)) : height(z), beside(displacement) {}
};

// Constructed for one instrument, specimen and device, then const: exposures are independent of each other.
class Tracer {
  public:
    virtual ~Tracer() = default;
    // Traces an image. image: the index that keys the random numbers. The same arguments give the same bits whatever
    // the batch size.
    virtual Image expose(FocalPosition position, std::uint32_t image) const = 0;
    // Begins the same image: a device works on it from now on, and the host takes the result when the future is asked
    // (or dropped). At most most_under_way() futures may be outstanding. The tracer must outlive them. checkpoints:
    // where it continues from, and where a long exposure saves its counts; the bits are the same. The host saves none.
    virtual std::future<Image> begin(FocalPosition position, std::uint32_t image,
                                     std::shared_ptr<const Checkpoints> /*checkpoints*/ = nullptr) const {
        return std::async(std::launch::deferred, [this, position, image] { return expose(position, image); });
    }
    virtual int most_under_way() const { return 1; }
    // The number of units of work of an exposure, of which some tracers count parts: first ... end - 1. The image is
    // made from a checkpoint with all units done and the parts' sum. 0: this tracer counts no parts.
    virtual std::uint64_t units() const { return 0; }
    virtual std::uint64_t rays_per_unit() const { return 1; }
    virtual ExposurePart count(FocalPosition /*position*/, std::uint32_t /*image*/, std::uint64_t /*first*/,
                               std::uint64_t /*end*/) const {
        return {};
    }
    virtual std::string description() const = 0; // device, traversal and the reason for both
    virtual TracerIdentity identity() const = 0;
    // The device that it works on, for further work there; null: the host.
    virtual std::shared_ptr<const vulkan::Device> device() const { return nullptr; }
    // The filters of its wave images, one for each light of the instrument; empty: images of rays.
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
