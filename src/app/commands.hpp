// The program's commands, one file each. Data goes to standard output, everything else to standard error.
// All throw InputError, DeviceError or RunError.
#pragma once

#include "configuration/configuration.hpp"
#include "optics/diffraction.hpp"
#include "surface/band.hpp"
#include "surface/roughness_profile.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vkfv::app {

// What the command line says, as far as it does not override the configuration.
struct CommandOptions {
    std::filesystem::path file; // configuration; for --topography the stack, for --surface the surface
    std::vector<TomlOverride> overrides;
    std::optional<std::filesystem::path> out;
    bool quiet = false;
    bool json = false;
    double focal_height = 0;                           // --image; mm
    std::filesystem::path rays_file;                   // --trace-rays
    std::filesystem::path picture_file;                // --layout
    std::vector<std::filesystem::path> compared_files; // --compare: measurements, then the truth
    bool align = false;                                // --compare: the lateral shift is removed
    surface::Band band;                                // --compare, --surface: form and filters
    std::optional<surface::ProfileLine> profile_line;  // --surface; none: the middle row
    bool float_precision = false;                      // --trace-rays: on the device
    bool apertures = true;                             // --trace-rays
    int runs = 5;                                      // --bench
    std::vector<std::string> bench_parts;              // --bench: what to measure (bench.hpp)
    bool quick = false;                                // --bench
    std::filesystem::path peer;                        // --bench: the program vkfv_bench_peer
    std::string commit;                                // --bench: for the report
    std::vector<std::filesystem::path> glass_catalogs; // --import
    std::optional<std::uint64_t> shuffle;              // --topography: seed of the order in which the images are taken
    // --topography of a stack that vkfv did not make: mm
    std::optional<double> z_step;  // negative: the images descend
    std::optional<double> pitch;   // --surface too, of an image
    std::optional<double> unit;    // --surface: mm per unit of an image's value
    std::optional<double> z_start; // of the first image; none: 0
};

// A whole stack with its topography and deviation from truth; continues one that was interrupted.
void run_stack(const CommandOptions& options);
// One exposure, as a TIFF and its ledger.
void run_image(const CommandOptions& options);
// Images or stacks for every combination of the parameters in [sweep], with a table, charts and a contact sheet;
// continues one that was interrupted.
void run_sweep(const CommandOptions& options);
// Validates, and prints the instrument's first-order data; needs no device.
void run_check(const CommandOptions& options);
// Given rays through the imaging train, as CSV.
void run_trace_rays(const CommandOptions& options);
// The instrument to scale with rays through it, as an SVG.
void run_layout(const CommandOptions& options);
// The devices at hand, what each lacks and which would be used.
void run_devices(const CommandOptions& options);
// Rays per second of the configuration's chain, by stages and whatever else bench.hpp tells of; with `out`, also as
// bench.json and bench.svg in that folder.
void run_bench(const CommandOptions& options);
// Evaluates an existing stack: one of vkfv anew, by its stack.toml, or the images of another instrument in a folder or
// a file of several pages. With `shuffle` in a random order of its images, a control that must find nothing.
void run_topography(const CommandOptions& options);

// A surface file: form removed and filtered, its ISO 25178-2 parameters and a profile's; with `out`, written in the
// format that the name's ending tells.
void run_surface(const CommandOptions& options);

// Measured against true heights: lateral shift, deviation, its systematic and random part, ISO 25178-2 parameters; with
// `out`, also deviation by spatial frequency (transfer.csv) and by slope (slope.csv), maps and compare.json there.
void run_compare(const CommandOptions& options);

// Whether the files of a stack, a sweep or other results are still those that were written; RunError names those that
// are not.
void run_verify(const CommandOptions& options);

// A Zemax lens as a prescription: in the file `out`, else on standard output.
void run_import(const CommandOptions& options);

} // namespace vkfv::app
