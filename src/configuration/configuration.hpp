// What the user asks for: a TOML file and the command line's overrides, checked and in the units of the inside.
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
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// Which tables a command cannot do without: [specimen] for an exposure, [scan] besides for a stack.
enum class Needs { instrument, exposure, stack };

// How images are blurred after the trace, if at all. Belongs to no traced image (waves do: trace::TraceOptions).
struct DiffractionOptions {
    bool airy = false;
    std::filesystem::path file; // else a measured point spread function
    double pitch = 0;           // of the file's pixels, mm in the object plane

    bool any() const { return airy || !file.empty(); }
};

// What `vkfv --sweep` varies: every combination of the values, the first parameter slowest.
struct Sweep {
    struct Parameter {
        std::string key;                 // dotted: "trace.rays"
        std::string label;               // on axes and in folders' names
        std::vector<std::string> values; // TOML texts
    };
    bool stacks = false;     // else single images
    double focal_height = 0; // of the images, mm
    int repeats = 1;         // of each combination, with seeds that follow trace.seed
    std::vector<Parameter> parameters;
};

// What the plane of the illumination's field stop lets through.
struct LightFieldDescription {
    specimen::Reflectance pattern;
    double falloff = 0;      // 1/mm^2, of the square of the distance from the brightest place
    glm::dvec2 brightest{0}; // mm
};

// Where a stack is evaluated. Automatic: on the device that traces, if it has cores of its own.
enum class EvaluateOn { automatic, host, device };

// Of the texts in ReadKeys, `canonical` is TOML that load_configuration() takes, and `identity` is what the images
// depend on, a line a key, for telling one stack from another. Of the keys of `canonical` the identity leaves out, with
// the reason:
//   diffraction.* but for waves', topography.*, output.directory   blur, evaluate or place the images (a blur that
//                                    comes before a camera is in it)
//   trace.batch                      the same bits for any batch size
//   trace.device, trace.traversal    requests; what they resolve to is in the tracer's description
//   file paths                       the content counts, and stands in its place as a digest
// The program's version is in it: another version may trace other bits.
struct Configuration : ReadKeys {
    std::filesystem::path file;
    optics::GlassCatalog glasses; // of the program and of the file's glass_catalogs; none where no instrument is read
    optics::InstrumentDescription instrument; // without the light's field
    std::optional<LightFieldDescription> light_field;
    // Distance (mm) from the back vertex of an objective with a parfocal length to its shoulder, from which the
    // distance to the tube lens counts.
    double shoulder = 0;
    std::optional<camera::CameraOptions> camera; // none: images are light
    std::optional<specimen::Description> specimen;
    std::optional<scan::ScanPlan> scan;
    std::optional<scan::Stage> stage;
    trace::TraceOptions trace;
    DiffractionOptions diffraction;
    topography::TopographyOptions topography;
    EvaluateOn evaluate_on = EvaluateOn::automatic;
    topography::Registration registration = topography::Registration::none; // of images of another instrument
    std::filesystem::path flatness_file; // a flat measured by the same instrument; empty: no correction
    topography::Band band;               // form of both comparisons with the truth; filters of the second; unlimited:
                                         // there is only one
    std::filesystem::path output_directory;
    bool stack_file = false;                                // all images in one file, beside the single ones
    static constexpr double usual_checkpoint_interval = 60; // s
    double checkpoint_interval = usual_checkpoint_interval; // of an exposure that takes longer; 0: none are kept
    scan::PixelType pixel_type = scan::PixelType::float32;  // of the images
    std::vector<std::string> topography_files;              // names under which the topography is written
    std::optional<Sweep> sweep; // belongs to no image: neither in `canonical` nor in `identity`
};

// Throws InputError.
Configuration load_configuration(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides = {},
                                 Needs needs = Needs::stack);

// The same of a document; relative paths start at its file.
Configuration read_configuration(const TomlTable& root, Needs needs = Needs::stack);

// [topography] alone, with these overrides of its keys: for a stack without a configuration; all else has its default.
// Throws InputError.
Configuration topography_configuration(const std::vector<TomlOverride>& overrides);

} // namespace vkfv
