// The program's commands, each in a file of its own. Data goes to standard output, everything else to standard error.
// All commands throw InputError, DeviceError or RunError.
#pragma once

#include "command_line/command.hpp"

namespace vkfv::app {

using namespace command_line;

// All commands, in the order in which help lists them.
std::vector<Command> commands();

Command stack_command();
Command merge_command();
Command image_command();
Command sweep_command();
Command calibrate_command();
Command budget_command();
Command capability_command();
Command fit_command();
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

// The overrides of a command whose results, without --out, go to a folder that is named by the configuration and this
// ending, so that it is beside no stack of the configuration's name.
std::vector<TomlOverride> overrides_with_folder(const CommandOptions& options, const std::string& ending);

// Tells programs that read the log as JSON which folder holds a command's results.
void tell_results(const std::filesystem::path& folder);

// Traces a whole stack, with its topography and the deviation from truth. Continues a stack that was interrupted.
void run_stack(const CommandOptions& options);
// Puts the shards of a stack together and evaluates the stack as if one run had traced it.
void run_merge(const CommandOptions& options);
// Takes one exposure, as a TIFF with its ledger.
void run_image(const CommandOptions& options);
// Measures images or stacks for every combination of the parameters in [sweep], with a table, charts and a contact
// sheet. Continues a sweep that was interrupted.
void run_sweep(const CommandOptions& options);
// Measures the metrological characteristics of the instrument on virtual standards, and writes a certificate. Continues
// a calibration that was interrupted.
void run_calibrate(const CommandOptions& options);
// Measures what the uncertain numbers of the configuration do to a result, and writes an uncertainty budget. Continues
// one that was interrupted.
void run_budget(const CommandOptions& options);
// Measures sinusoids over wavelength and amplitude, and writes a map of what the instrument can measure beside its
// limits. Continues one that was interrupted.
void run_capability(const CommandOptions& options);
// Finds the numbers of a configuration with which it makes stacks like a measured one, and writes them with their
// uncertainties. Continues a fit that was interrupted.
void run_fit(const CommandOptions& options);
// Judges the configuration, and prints warnings and figures of the instrument. Opens no device except for a forecast.
void run_check(const CommandOptions& options);
// Traces given rays through the imaging train, as CSV.
void run_trace_rays(const CommandOptions& options);
// Draws the instrument to scale with rays through it, as an SVG.
void run_layout(const CommandOptions& options);
// Computes the images that waves make of points of the field: pictures, tables and optics.json in a folder.
void run_optics(const CommandOptions& options);
// Measures the configured camera on images that it takes of uniform light: figures, charts and camera.json in a folder.
void run_camera(const CommandOptions& options);
// Lists the devices at hand, with what each lacks and which ones would be used.
void run_devices(const CommandOptions& options);
// Measures the rays per second of the configuration, by stages and by the other parts of bench.hpp. With `out`, it also
// writes bench.json and bench.svg into that folder.
void run_bench(const CommandOptions& options);
// Evaluates an existing stack: a stack of vkfv anew, by its stack.toml, or the images of another instrument in a folder
// or in a file of several pages. With `shuffle` it takes the images in a random order, a control that must find
// nothing.
void run_topography(const CommandOptions& options);
// Treats a surface file: removes its form, filters it, and prints its ISO 25178-2 parameters and those of a profile.
// With `out`, it writes the surface in the format that the name's ending tells.
void run_surface(const CommandOptions& options);
// Compares measured with true heights: lateral shift, deviation, its systematic and random part, ISO 25178-2
// parameters. With `out`, it writes the deviation by spatial frequency (transfer.csv) and by slope (slope.csv), maps
// and compare.json into that folder.
void run_compare(const CommandOptions& options);
// Checks that the files of a stack, a sweep or other results are still those that were written. RunError names the
// files that are not.
void run_verify(const CommandOptions& options);
// Converts a Zemax lens to a prescription, in the file `out` or on standard output.
void run_import(const CommandOptions& options);

} // namespace vkfv::app
