// The program's commands, one file each. Data goes to standard output, everything else to standard error. All throw
// InputError, DeviceError or RunError.
#pragma once

#include "command_line/command.hpp"

namespace vkfv::app {

using namespace command_line;

// All of them, in the order in which help lists them.
std::vector<Command> commands();

Command stack_command();
Command merge_command();
Command image_command();
Command sweep_command();
Command topography_command();
Command compare_command();
Command surface_command();
Command verify_command();
Command check_command();
Command trace_rays_command();
Command layout_command();
Command optics_command();
Command camera_command();
Command devices_command();
Command bench_command();
Command import_command();
Command keys_command();
Command explain_command();
Command template_command();
Command new_command();
Command list_command();
Command help_command();
Command completion_command();
Command man_command();

// For programs that read the log as JSON: tells the folder that holds a command's results.
void tell_results(const std::filesystem::path& folder);

// A whole stack with its topography and deviation from truth; continues one that was interrupted.
void run_stack(const CommandOptions& options);
// Shards of a stack put together and evaluated, as if one run had traced them.
void run_merge(const CommandOptions& options);
// One exposure, as a TIFF and its ledger.
void run_image(const CommandOptions& options);
// Images or stacks for every combination of the parameters in [sweep], with a table, charts and a contact sheet;
// continues one that was interrupted.
void run_sweep(const CommandOptions& options);
// Judges the configuration, and prints warnings and figures of the instrument; opens no device but for a forecast.
void run_check(const CommandOptions& options);
// Given rays through the imaging train, as CSV.
void run_trace_rays(const CommandOptions& options);
// The instrument to scale with rays through it, as an SVG.
void run_layout(const CommandOptions& options);
// What waves make of points of the field, as pictures, tables and optics.json in a folder.
void run_optics(const CommandOptions& options);
// The configured camera measured on images that it takes of uniform light: figures, charts and camera.json in a folder.
void run_camera(const CommandOptions& options);
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
