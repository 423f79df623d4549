#include "configuration/configuration.hpp"

#include "configuration/configuration_instrument.hpp"
#include "configuration/configuration_section.hpp"
#include "configuration/specimen.hpp"
#include "core/digest.hpp"
#include "core/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv {

namespace {

constexpr std::int64_t most_rays = 1'000'000'000'000; // 1e12: an hour a picture on the fastest device
constexpr std::int64_t most_bounces = 64;             // a Lambertian pit loses all but 1e-3 of its light in ten
constexpr std::int64_t fewest_positions = 3;          // the peak is a fit through three points
constexpr double most_smoothing_steps = 100;          // 1202 images in memory
constexpr std::int64_t most_peak_range_steps = 100;
constexpr std::int64_t largest_seed = 0xffffffffll; // seeds are 32-bit words of the counter-based generator

double from_um(double value) {
    return value / um_per_mm;
} // division rounds 0.8 um to the double nearest 0.0008

// "a/./b/" as "a/b".
std::filesystem::path without_dots(const std::filesystem::path& path) {
    const auto normal = path.lexically_normal();
    return normal.has_filename() || normal == normal.root_path() ? normal : normal.parent_path();
}

void read_scan(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table("scan");
    const OldSection section(table, configuration);
    const double start = section.number("z_start_um", NumberRange::finite());
    const double stop = section.number("z_stop_um", NumberRange::finite());
    const double step = section.number("z_step_um", NumberRange::positive());
    if (stop < start) {
        table.fail("z_stop_um", fmt::format("a number >= z_start_um = {}", start),
                   "Exchange z_start_um and z_stop_um: a scan ascends.");
    }
    const double positions = std::floor((stop - start) / step + 1e-6) + 1; // as ScanPlan::positions() counts
    if (positions < static_cast<double>(fewest_positions)) {
        table.fail("z_step_um",
                   fmt::format("at least {} focal positions from z_start_um = {} to z_stop_um = {}, found {}",
                               fewest_positions, start, stop, positions),
                   "Choose a smaller z_step_um or a longer scan.");
    }
    if (positions > scan::most_positions) {
        table.fail("z_step_um", fmt::format("at most {} focal positions, found {}", scan::most_positions, positions),
                   "Choose a larger z_step_um or a shorter scan.");
    }
    configuration.scan = scan::ScanPlan{from_um(start), from_um(stop), from_um(step)};
}

void read_trace(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table_or_empty("trace");
    const OldSection section(table, configuration);
    auto& trace = configuration.trace;
    trace.rays = static_cast<std::uint64_t>(section.integer("rays", 1, most_rays, 10'000'000));
    trace.seed = static_cast<std::uint32_t>(section.integer("seed", 0, largest_seed, 1));
    trace.max_bounces = static_cast<int>(section.integer("max_bounces", 1, most_bounces, 2));
    trace.nonsequential = section.choice("mode", {"sequential", "nonsequential"}, "sequential") == "nonsequential";
    if (section.choice("estimator", {"forward", "backward"}, "forward") == "backward") {
        trace.estimator = trace::Estimator::backward;
        configuration.instrument.turned = true;
        if (trace.nonsequential) {
            table.fail("estimator", "\"forward\" with mode = \"nonsequential\"",
                       "Choose estimator = \"forward\", or mode = \"sequential\".");
        }
    }
    configuration.instrument.directed_emission =
        section.choice("emission", {"directed", "analog"}, "directed") == "directed";
    trace.directed_scatter = section.choice("scattering", {"analog", "directed"}, "analog") == "directed";
    if (trace.directed_scatter && trace.nonsequential) {
        table.fail("scattering", "\"analog\" with mode = \"nonsequential\", whose light finds the pupil by itself",
                   "Choose scattering = \"analog\", or mode = \"sequential\".");
    }
    if (trace.directed_scatter && trace.estimator == trace::Estimator::backward) {
        table.fail("scattering", "\"analog\" with estimator = \"backward\", which starts from the pupil",
                   "Choose scattering = \"analog\", or estimator = \"forward\".");
    }
    const std::string traversal =
        section.choice("traversal", {"auto", "ray-query", "quadtree", "bvh"}, "auto", Influence::nothing);
    if (trace.nonsequential && traversal == "quadtree") {
        table.fail("traversal", "a traversal that knows the instrument's elements too",
                   "Use \"auto\", \"bvh\" or \"ray-query\" with mode = \"nonsequential\".");
    }
    trace.traversal = traversal == "ray-query"  ? trace::Traversal::ray_query
                      : traversal == "quadtree" ? trace::Traversal::quadtree
                      : traversal == "bvh"      ? trace::Traversal::bvh
                                                : trace::Traversal::automatic;
    trace.batch = static_cast<std::uint64_t>(section.integer("batch", 0, most_rays, 0, Influence::nothing));
    if (const auto device = table.optional_string("device")) {
        section.record("device", toml_quoted(*device), Influence::nothing);
        trace.device = *device;
    }
}

void read_topography(const TomlTable& root, Configuration& configuration, Needs needs) {
    const TomlTable table = root.table_or_empty("topography");
    const OldSection section(table, configuration);
    auto& options = configuration.topography;
    options.focus_measure =
        section.choice("focus_measure", topography::focus_measure_names(), options.focus_measure, Influence::nothing);
    options.window_px = static_cast<int>(section.integer("window_px", 3, 255, options.window_px, Influence::nothing));
    if (options.window_px % 2 == 0) {
        table.fail("window_px", "an odd integer, so that the window has a central pixel",
                   fmt::format("Choose {} or {}.", options.window_px - 1, options.window_px + 1));
    }
    if (needs == Needs::stack && table.sound("detector") &&
        options.window_px > configuration.instrument.detector_pixels) {
        table.fail("window_px",
                   fmt::format("an integer <= detector.pixels = {}", configuration.instrument.detector_pixels),
                   "Choose a smaller window or more pixels.");
    }
    options.window_shape =
        section.choice("window_shape", {"box", "gaussian"}, options.window_shape, Influence::nothing);
    options.smoothing_steps = section.number("smoothing_steps", NumberRange::within(0, most_smoothing_steps),
                                             options.smoothing_steps, Influence::nothing);
    options.false_peak_rate =
        section.number("false_peak_rate", NumberRange::between(0, 1), options.false_peak_rate, Influence::nothing);
    options.peak = section.choice("peak", topography::peak_method_names(), options.peak, Influence::nothing);
    options.peak_range_steps = static_cast<int>(
        section.integer("peak_range_steps", 1, most_peak_range_steps, options.peak_range_steps, Influence::nothing));
    options.least_contrast =
        section.number("least_contrast", NumberRange::at_least(0), options.least_contrast, Influence::nothing);
    options.most_fit_residual =
        section.number("most_fit_residual", NumberRange::positive(), options.most_fit_residual, Influence::nothing);
    options.most_peaks = static_cast<int>(section.integer("most_peaks", 1, 4, options.most_peaks, Influence::nothing));
    options.repair_outliers = section.boolean("repair_outliers", options.repair_outliers, Influence::nothing);
    configuration.evaluate_on =
        section.choice("evaluate_on", {"auto", "host", "device"}, configuration.evaluate_on, Influence::nothing);
    // "none", so that --set can take it back.
    if (const auto name = table.optional_string("flatness_file"); name && *name != "none") {
        configuration.flatness_file = looked_for(table.file_path("flatness_file"));
        section.record_reference("flatness_file", absolute_path(configuration.flatness_file).string());
    }
    configuration.band.spline =
        section.choice("filter", {"gaussian", "spline"}, "gaussian", Influence::nothing) == "spline";
    configuration.band.s_filter =
        from_um(section.number("s_filter_um", NumberRange::at_least(0), 0.0, Influence::nothing));
    configuration.band.l_filter =
        from_um(section.number("l_filter_um", NumberRange::at_least(0), 0.0, Influence::nothing));
}

void read_diffraction(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table_or_empty("diffraction");
    const OldSection section(table, configuration);
    const std::string kind = section.kind("point_spread", {"none", "airy", "file"}, "none", Influence::nothing);
    if (kind != "file") {
        for (const char* key : {"file", "pitch_um"}) {
            if (table.has(key)) {
                table.note(key, fmt::format("no such key with point_spread = \"{}\"", kind),
                           "Remove it; it belongs to point_spread = \"file\".");
            }
        }
    }
    configuration.diffraction.airy = kind == "airy";
    if (kind == "file") {
        configuration.diffraction.file = looked_for(table.file_path("file"));
        section.record_reference("file", absolute_path(configuration.diffraction.file).string());
        configuration.diffraction.pitch =
            from_um(section.number("pitch_um", NumberRange::positive(), {}, Influence::nothing));
    }
}

void read_output(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table_or_empty("output");
    const OldSection section(table, configuration);
    configuration.output_directory =
        without_dots(table.optional_file_path("directory").value_or(configuration.file.parent_path() / "vkfv-out"));
    // The canonical text lies in the folder itself, wherever that is moved to.
    section.record_reference("directory", ".");
    constexpr std::array files = {std::pair{"tiff", "topography.tif"}, std::pair{"x3p", "topography.x3p"},
                                  std::pair{"sur", "topography.sur"}, std::pair{"sdf", "topography.sdf"},
                                  std::pair{"ply", "topography.ply"}};
    const std::vector<std::string> formats =
        table.has("surfaces") ? table.value_texts("surfaces") : std::vector{toml_quoted("tiff"), toml_quoted("x3p")};
    for (const std::string& format : formats) {
        const auto* file =
            std::ranges::find_if(files, [&](const auto& candidate) { return toml_quoted(candidate.first) == format; });
        if (file == files.end()) {
            table.note("surfaces", "\"tiff\", \"x3p\", \"sur\", \"sdf\" or \"ply\"", fmt::format("Remove {}.", format));
            break;
        }
        configuration.topography_files.emplace_back(file->second);
    }
    section.record("surfaces", fmt::format("[{}]", fmt::join(formats, ", ")), Influence::nothing);
    if (section.choice("images", {"float32", "uint16"}, "float32") != "float32") {
        table.note("images", "\"float32\"; 16-bit counts are not available yet", "Choose images = \"float32\".");
    }
}

void read_sweep(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("sweep");
    if (!table) {
        return;
    }
    Sweep sweep;
    sweep.stacks = table->optional_choice("of", {"images", "stacks"}).value_or("images") == "stacks";
    if (!sweep.stacks) {
        sweep.focal_height = from_um(table->optional_number("z_um").value_or(0));
    } else if (table->has("z_um")) {
        table->fail("z_um", "no focal height for a sweep of stacks", "Remove it; [scan] has the heights.");
    }
    if (sweep.stacks) {
        sweep.repeats = static_cast<int>(table->optional_integer("repeats", 1, 1000).value_or(1));
    } else if (table->has("repeats")) {
        table->fail("repeats", "no repeats of a sweep of images", "Remove it; vary trace.seed instead.");
    }
    for (const TomlTable& parameter_table : table->tables("parameter")) {
        Sweep::Parameter parameter;
        parameter.key = parameter_table.string("key");
        if ((parameter.key.starts_with("sweep.") && parameter.key != "sweep.z_um") ||
            parameter.key.starts_with("output.")) {
            parameter_table.fail("key", "a key that decides what is traced or evaluated", "Choose another.");
        }
        if (std::ranges::find(sweep.parameters, parameter.key, &Sweep::Parameter::key) != sweep.parameters.end()) {
            parameter_table.fail("key", "each key once", "Put all values into one parameter.");
        }
        // The last word of the key, unless there is a better one.
        parameter.label =
            parameter_table.optional_string("label").value_or(parameter.key.substr(parameter.key.rfind('.') + 1));
        if (parameter.label.find_first_of("/\\=") != std::string::npos) {
            parameter_table.fail("label", "a word without '/', '\\' and '='", "Folders are named after it.");
        }
        parameter.values = parameter_table.value_texts("values");
        sweep.parameters.push_back(std::move(parameter));
    }
    configuration.sweep = std::move(sweep);
}

} // namespace

Configuration load_configuration(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides,
                                 Needs needs) {
    return read_configuration(TomlTable::open(file, overrides), needs);
}

Configuration read_configuration(const TomlTable& root, Needs needs) {
    Configuration configuration;
    configuration.file = root.where().file;
    configuration.identity = fmt::format("program = \"vkfv {}\"\n", VKFV_VERSION);
    root.collect_problems(); // to tell of all at once
    read_glass_catalogs(root, configuration);
    read_instrument(root, configuration);
    if (needs != Needs::instrument || root.has("specimen")) {
        root.attempt("specimen", [&] { read_specimen(root, configuration); });
    }
    if (needs == Needs::stack || root.has("scan")) {
        root.attempt("scan", [&] { read_scan(root, configuration); });
    }
    root.attempt("trace", [&] { read_trace(root, configuration); });
    root.attempt("diffraction", [&] { read_diffraction(root, configuration); });
    root.attempt("topography", [&] { read_topography(root, configuration, needs); });
    root.attempt("output", [&] { read_output(root, configuration); });
    root.attempt("sweep", [&] { read_sweep(root, configuration); });
    root.reject_unknown_keys();
    return configuration;
}

Configuration topography_configuration(const std::vector<TomlOverride>& overrides) {
    const TomlTable root = TomlTable::parse("", "command line", overrides);
    Configuration configuration;
    root.collect_problems();
    root.attempt("topography", [&] { read_topography(root, configuration, Needs::exposure); });
    root.reject_unknown_keys();
    return configuration;
}

} // namespace vkfv
