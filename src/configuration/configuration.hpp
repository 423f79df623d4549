// The configuration that the user gives, as a TOML file with overrides of the command line: checked, in the program's
// own units.
#pragma once

#include "camera/camera.hpp"
#include "core/keys/section.hpp"
#include "optics/instrument/instrument.hpp"
#include "scan/plan.hpp"
#include "scan/stage.hpp"
#include "scan/store.hpp"
#include "specimen/description.hpp"
#include "topography/compare.hpp"
#include "topography/registration.hpp"
#include "topography/topography.hpp"
#include "trace/interface/tracer.hpp"

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// The tables that a command requires beside the instrument: [specimen] for an exposure, [specimen] and [scan] for a
// stack.
enum class Needs { instrument, exposure, stack };

// The blur of images after the trace, if there is one. Traced images do not depend on it; waves, on which they do
// depend, are in trace::TraceOptions.
struct DiffractionOptions {
    bool airy = false;
    std::filesystem::path file; // measured point spread function; empty: none
    double pitch = 0;           // mm in the object plane, of the file's pixels

    bool any() const { return airy || !file.empty(); }
};

// The parameters that `vkfv --sweep` varies. It takes every combination of their values, with the first parameter
// slowest.
struct Sweep {
    struct Parameter {
        std::string key;                 // dotted: "trace.rays"
        std::string label;               // name on axes and in folders' names
        std::vector<std::string> values; // TOML texts
    };
    bool stacks = false;     // stacks, or single images
    double focal_height = 0; // mm, of the single images
    int repeats = 1;         // of each combination; their seeds follow trace.seed
    std::vector<Parameter> parameters;
};

// The uncertainties of numbers of the configuration (JCGM 100 and 101), from which vkfv budget makes an uncertainty of
// the result.
struct UncertainInput {
    enum class Distribution { normal, student, rectangular, triangular, arcsine };
    std::string key; // dotted: "stage.scale_error"
    Distribution distribution = Distribution::normal;
    // Standard uncertainty in the key's unit. Student's distribution is scaled by it, and is wider.
    double uncertainty = 0;
    double degrees_of_freedom = std::numeric_limits<double>::infinity();
    std::string evaluation{}; // "A", by observations, or "B"
    std::string source{};     // where it is stated; empty: nowhere
};
struct Uncertainty {
    struct Correlation {
        std::size_t first, second; // places in `inputs`
        double coefficient;
    };
    std::vector<UncertainInput> inputs{};
    std::vector<Correlation> correlations{};
};

// The transmission of the plane of the illumination's field stop.
struct LightFieldDescription {
    specimen::Reflectance pattern;
    double falloff = 0;      // 1/mm^2, by the square of the distance from `brightest`
    glm::dvec2 brightest{0}; // mm, the brightest place
};

// The place where a stack is evaluated. `automatic` means the device that traces, if it has cores of its own.
enum class EvaluateOn { automatic, host, device };

// All settings. Of the texts in ReadKeys, `canonical` is TOML that load_configuration() takes, and `identity` tells one
// stack from another: it has a line for each key that the images depend on, and the program's version, since another
// version may trace other bits. The identity leaves out these keys of `canonical`, for the reason beside them:
//   diffraction.* but for waves', topography.*, output.directory   blur, evaluate or place the images (the identity has
//                                    a blur that comes before a camera)
//   trace.batch                      the same bits for any batch size
//   trace.device, trace.traversal    requests; the tracer's description has what they resolve to
//   file paths                       the content counts, and stands in its place as a digest
struct Configuration : ReadKeys {
    std::filesystem::path file;
    optics::GlassCatalog glasses;             // built in and from glass_catalogs; empty if no instrument is read
    optics::InstrumentDescription instrument; // its light field is not set here
    std::optional<LightFieldDescription> light_field;
    // The distance (mm) from the back vertex of an objective with a parfocal length to its shoulder, where the distance
    // to the tube lens begins.
    double shoulder = 0;
    // Side of a pixel on the specimen (mm), as the instrument believes it to be; none: the true one. Heights lie on a
    // grid of this pitch, and images state it.
    std::optional<double> assumed_pitch;
    std::optional<camera::CameraOptions> camera; // none: images are light
    std::optional<std::uint32_t> noise_seed;     // camera.noise_seed; none: trace.seed
    bool estimator_is_chosen = false;            // trace.estimator is "auto": trace.estimator below is vkfv's choice
    std::optional<specimen::Description> specimen;
    std::optional<scan::ScanPlan> scan;
    std::optional<scan::Stage> stage;
    trace::TraceOptions trace;
    DiffractionOptions diffraction;
    topography::TopographyOptions topography;
    EvaluateOn evaluate_on = EvaluateOn::automatic;
    topography::Registration registration = topography::Registration::none; // of the images of another instrument
    std::filesystem::path flatness_file; // a flat measured by the same instrument; empty: no correction
    // The form holds for both comparisons with the truth, the filters for the second; without limits there is only the
    // first.
    topography::Band band;
    std::filesystem::path output_directory;
    bool stack_file = false;                                // also write all images into one file
    static constexpr double usual_checkpoint_interval = 60; // s
    double checkpoint_interval = usual_checkpoint_interval; // s, for longer exposures; 0: no checkpoints
    scan::PixelType pixel_type = scan::PixelType::float32;  // of the images
    std::vector<std::string> topography_files;              // names of the topography's files
    std::optional<Sweep> sweep; // this and the next: part of neither `canonical` nor `identity`
    Uncertainty uncertainty;
};

// Reads a configuration with overrides of its keys. Throws InputError, with all problems that it finds.
Configuration load_configuration(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides = {},
                                 Needs needs = Needs::stack);

// Reads the configuration that a document holds; relative paths start at the document's file. Throws InputError.
Configuration read_configuration(const TomlTable& root, Needs needs = Needs::stack);

// Reads [topography] from these overrides alone, for a stack without a configuration. All other settings have their
// defaults. Throws InputError.
Configuration topography_configuration(const std::vector<TomlOverride>& overrides);

} // namespace vkfv
