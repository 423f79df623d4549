#include "configuration/configuration.hpp"

#include "configuration/configuration_instrument.hpp"
#include "configuration/configuration_section.hpp"
#include "core/digest.hpp"
#include "core/units.hpp"
#include "physics/scatter_registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace vkfv {

namespace {

constexpr std::int64_t most_rays = 1'000'000'000'000; // 1e12: an hour a picture on the fastest device
constexpr std::int64_t most_bounces = 64;             // a Lambertian pit loses all but 1e-3 of its light in ten
constexpr std::int64_t fewest_positions = 3;          // the peak is a fit through three points
constexpr double most_smoothing_steps = 100;          // 1202 images in memory
constexpr std::int64_t most_peak_range_steps = 100;
constexpr std::int64_t largest_seed = 0xffffffffll; // seeds are 32-bit words of the counter-based generator
constexpr std::array length_units = {std::pair{"mm", 1.0}, std::pair{"um", 1e-3}, std::pair{"m", 1e3},
                                     std::pair{"inch", 25.4}};

double from_um(double value) {
    return value / um_per_mm;
} // division rounds 0.8 um to the double nearest 0.0008

// "a/./b/" as "a/b".
std::filesystem::path without_dots(const std::filesystem::path& path) {
    const auto normal = path.lexically_normal();
    return normal.has_filename() || normal == normal.root_path() ? normal : normal.parent_path();
}

struct KindRule {
    const char* name;
    specimen::Kind kind;
    bool generated; // from a formula, over a square footprint
    std::vector<std::string> keys;
};

const std::vector<KindRule>& kind_rules() {
    using specimen::Kind;
    static const std::vector<KindRule> rules = {
        {"plane", Kind::plane, true, {"size_mm", "pitch_um", "representation", "tilt_x_deg", "tilt_y_deg"}},
        {"step", Kind::step, true, {"size_mm", "pitch_um", "representation", "height_um", "wall_um"}},
        {"sphere", Kind::sphere, true, {"size_mm", "pitch_um", "representation", "radius_um", "height_um"}},
        {"sinusoid", Kind::sinusoid, true, {"size_mm", "pitch_um", "representation", "amplitude_um", "period_um"}},
        {"chirp",
         Kind::chirp,
         true,
         {"size_mm", "pitch_um", "representation", "amplitude_um", "period_um", "period_stop_um"}},
        {"rough",
         Kind::rough,
         true,
         {"size_mm", "pitch_um", "representation", "sq_um", "correlation_length_um", "seed"}},
        {"plateaus",
         Kind::plateaus,
         true,
         {"size_mm", "pitch_um", "text", "font", "text_width_mm", "file", "heights_um", "sq_um",
          "correlation_length_um", "seed"}},
        {"air",
         Kind::air,
         true,
         {"tiles", "tile_size_mm", "pitch_um", "sq_um", "roll_off_wavelength_um", "shortest_wavelength_um",
          "hurst_exponent", "seed", "file"}},
        {"star", Kind::star, true, {"size_mm", "pitch_um", "petals", "radius_um", "height_um"}},
        {"groove", Kind::groove, true, {"size_mm", "pitch_um", "width_um", "depth_um", "wall_um"}},
        {"image", Kind::image, false, {"file", "pitch_um", "height_um"}},
        {"surface", Kind::surface, false, {"file", "pitch_um", "unit", "size_mm", "level"}},
        {"stl", Kind::stl, false, {"file", "unit", "centre"}},
        {"gltf", Kind::gltf, false, {"file", "unit", "centre"}},
    };
    return rules;
}

bool has_key(const KindRule& rule, const std::string& key) {
    return std::find(rule.keys.begin(), rule.keys.end(), key) != rule.keys.end();
}

std::optional<specimen::Roughness> read_roughness(const TomlTable& specimen_table, const KindRule& rule,
                                                  Configuration& configuration) {
    const auto table = specimen_table.optional_table("roughness");
    if (!table) {
        return std::nullopt;
    }
    if (rule.kind == specimen::Kind::stl || rule.kind == specimen::Kind::gltf) {
        specimen_table.fail("roughness", fmt::format("no roughness for a specimen of kind \"{}\"", rule.name),
                            "Remove [specimen.roughness]; a mesh brings its own.");
    }
    const Section section(*table, configuration);
    specimen::Roughness roughness;
    roughness.noise = from_um(section.number("noise_um", NumberRange::at_least(0)));
    roughness.kernel = from_um(section.number("kernel_um", NumberRange::positive()));
    roughness.pitch = from_um(section.number("pitch_um", NumberRange::positive()));
    roughness.seed = static_cast<std::uint32_t>(section.integer("seed", 0, largest_seed, 1));
    return roughness;
}

// A scatter model and its parameters. Those of another model are refused.
specimen::Lobe read_lobe(const Section& section, const std::optional<std::string>& fallback = {}) {
    std::vector<std::string> names;
    std::map<std::string, std::vector<std::string>> models_with;
    for (const auto& model : physics::scatter_registry) {
        names.emplace_back(model.name);
        for (const auto& parameter : model.parameters) {
            models_with[std::string(parameter.name)].push_back(names.back());
        }
    }
    specimen::Lobe lobe;
    lobe.model = section.kind("scatter", names, fallback);
    lobe.parameters.clear();
    for (const auto& parameter :
         std::ranges::find(physics::scatter_registry, lobe.model, &physics::ScatterModel::name)->parameters) {
        const std::string key(parameter.name);
        models_with.erase(key);
        lobe.parameters.push_back(
            section.number(key, NumberRange::within(parameter.minimum, parameter.maximum), parameter.fallback));
    }
    for (const auto& [key, models] : models_with) {
        if (section.table().has(key)) {
            section.table().note(
                key, fmt::format("no such key for scatter = \"{}\"", lobe.model),
                fmt::format("Remove it; it belongs to scatter = \"{}\".", fmt::join(models, "\" or \"")));
        }
    }
    return lobe;
}

// One lobe in the table itself, or several in [[specimen.material.lobe]].
specimen::Material read_material(const TomlTable& table, Configuration& configuration) {
    const Section section(table, configuration);
    const auto lobe_tables = table.optional_tables("lobe");
    specimen::Material material;
    material.lobes.clear();
    if (lobe_tables.empty()) {
        specimen::Lobe lobe = read_lobe(section, "henyey-greenstein");
        lobe.weight = section.number("reflectance", NumberRange::within(0, 1), 1.0);
        if (lobe.weight > 0) {
            material.lobes.push_back(lobe);
        }
        return material;
    }
    for (const auto& key : table.keys()) {
        if (key != "lobe") {
            table.note(key, "no other key beside [[specimen.material.lobe]]",
                       "Move it into a lobe; the reflectance is the sum of the lobes' weights.");
        }
    }
    if (lobe_tables.size() > specimen::most_lobes) {
        table.fail("lobe", fmt::format("at most {} lobes", specimen::most_lobes), "Leave the weakest out.");
    }
    double reflectance = 0;
    for (const auto& lobe_table : lobe_tables) {
        const Section lobe_section(lobe_table, configuration);
        material.lobes.push_back(read_lobe(lobe_section));
        material.lobes.back().weight =
            lobe_section.number("weight", {.minimum = 0, .maximum = 1, .minimum_included = false});
        reflectance += material.lobes.back().weight;
        if (reflectance > 1 + specimen::weight_rounding) {
            lobe_table.fail("weight", fmt::format("weights that add up to at most 1, not {:.6g}", reflectance),
                            "Choose smaller weights; what they leave of 1 is absorbed.");
        }
    }
    return material;
}

void read_specimen(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table("specimen");
    const Section section(table, configuration);
    std::vector<std::string> names;
    KeysOfKinds keys_of_kinds;
    for (const auto& rule : kind_rules()) {
        names.emplace_back(rule.name);
        keys_of_kinds[rule.name] = rule.keys;
    }
    const std::string name = section.kind("kind", names);
    const KindRule& rule = *std::find_if(kind_rules().begin(), kind_rules().end(),
                                         [&](const KindRule& candidate) { return candidate.name == name; });
    reject_keys_of_other_kinds(table, keys_of_kinds, name, "a specimen");

    specimen::Description description;
    description.kind = rule.kind;
    description.where = table.where();
    const auto has = [&](const char* key) { return has_key(rule, key); };
    const auto read_um = [&](const char* key, double& into, const NumberRange& range,
                             std::optional<double> fallback = {}) {
        if (has(key)) {
            into = from_um(section.number(key, range, fallback));
        }
    };

    const auto roughness_table = table.optional_table("roughness");
    const bool measured_air = rule.kind == specimen::Kind::air && table.has("file");
    if (rule.generated) {
        if (has("representation")) {
            const bool analytic = section.choice("representation", {"facets", "analytic"}, "facets") == "analytic";
            description.representation =
                analytic ? specimen::Representation::analytic : specimen::Representation::facets;
        }
        if (rule.kind == specimen::Kind::air) {
            description.tiles = static_cast<int>(section.integer("tiles", 1, 64, 4));
            description.size = description.tiles * section.number("tile_size_mm", NumberRange::positive());
        } else {
            description.size = section.number("size_mm", NumberRange::positive());
        }
    }
    if (rule.kind == specimen::Kind::surface) {
        // What is not given is the file's own.
        description.pitch = from_um(section.number_if_given("pitch_um", NumberRange::positive()).value_or(0));
        description.size = section.number_if_given("size_mm", NumberRange::positive()).value_or(0);
        description.level = section.boolean("level", true);
        description.unit = 0;
    } else if (has("pitch_um")) {
        // Facets as fine as the roughness needs them; else half a micrometre, below what any objective
        // resolves.
        std::optional<double> fallback;
        if (rule.generated) {
            fallback = roughness_table
                           ? roughness_table->optional_number("pitch_um", NumberRange::positive()).value_or(0.5)
                           : 0.5;
        }
        read_um("pitch_um", description.pitch, NumberRange::positive(), fallback);
    }
    if (rule.kind == specimen::Kind::plane) {
        const auto slope = NumberRange::within(-80, 80); // steeper, the facets no longer resolve the footprint
        description.tilt_x = section.number("tilt_x_deg", slope, 0.0) * radians_per_degree;
        description.tilt_y = section.number("tilt_y_deg", slope, 0.0) * radians_per_degree;
    }
    read_um("radius_um", description.radius, NumberRange::positive());
    read_um("height_um", description.height, NumberRange::finite());
    read_um("wall_um", description.wall, NumberRange::at_least(0), 0.0);
    read_um("amplitude_um", description.amplitude, NumberRange::at_least(0));
    read_um("period_um", description.period, NumberRange::positive());
    read_um("period_stop_um", description.period_stop, NumberRange::positive());
    read_um("width_um", description.width, NumberRange::positive());
    read_um("depth_um", description.depth, NumberRange::finite());
    if (has("petals")) {
        description.petals = static_cast<int>(section.integer("petals", 1, 360));
    }
    if (has("seed") && !measured_air) {
        // The lattice of [specimen.roughness] may be all the roughness there is; plateaus may be smooth.
        const bool needed = (rule.kind == specimen::Kind::air && !measured_air) ||
                            (rule.kind == specimen::Kind::rough && !roughness_table);
        read_um("sq_um", description.sq, NumberRange::at_least(0), needed ? std::nullopt : std::optional(0.0));
        description.correlation_length = description.pitch; // of heights that are all zero
        if (has("correlation_length_um") && (description.sq > 0 || table.has("correlation_length_um"))) {
            read_um("correlation_length_um", description.correlation_length, NumberRange::positive());
        }
        description.seed = static_cast<std::uint32_t>(section.integer("seed", 0, largest_seed, 1));
    }
    if (measured_air) {
        for (const char* key :
             {"sq_um", "seed", "roll_off_wavelength_um", "shortest_wavelength_um", "hurst_exponent"}) {
            if (table.has(key)) {
                table.note(key, "no such key with a file of a measured surface",
                           "Remove it, or remove file for sub-surfaces from a power spectrum.");
            }
        }
    } else if (rule.kind == specimen::Kind::air) {
        read_um("roll_off_wavelength_um", description.roll_off, NumberRange::positive());
        read_um("shortest_wavelength_um", description.shortest, NumberRange::positive());
        description.hurst = section.number("hurst_exponent", NumberRange::within(0, 1));
    }
    if (rule.kind == specimen::Kind::plateaus) {
        for (const double height : section.numbers("heights_um", NumberRange::finite())) {
            description.heights.push_back(from_um(height));
        }
        if (table.has("text") == table.has("file")) {
            table.fail(table.has("text") ? "file" : "text", "either text or file",
                       "Give the letters as text, or a mask of the plateaus as file.");
        }
        if (table.has("text")) {
            description.text = section.string("text");
            description.font = section.string("font", "DejaVuSans-Bold");
            description.text_width = section.number("text_width_mm", NumberRange::positive(), 0.8 * description.size);
        }
    }
    const bool file_optional = rule.kind == specimen::Kind::plateaus || rule.kind == specimen::Kind::air;
    if (has("file") && (!file_optional || table.has("file"))) {
        description.file = looked_for(table.file_path("file"));
        description.where = table.where("file");
        section.record_reference("file", absolute_path(description.file).string());
    }
    if (has("unit") && (rule.kind != specimen::Kind::surface || table.has("unit"))) {
        std::vector<std::string> units;
        for (const auto& [unit, mm] : length_units) {
            units.emplace_back(unit);
        }
        // glTF 2.0 lengths are metres; STL has no unit, and millimetres are its custom.
        const std::string unit = section.choice("unit", units, rule.kind == specimen::Kind::gltf ? "m" : "mm");
        for (const auto& [candidate, mm] : length_units) {
            if (unit == candidate) {
                description.unit = mm;
            }
        }
        if (has("centre")) {
            description.centre = section.boolean("centre", true);
        }
    }
    description.roughness = read_roughness(table, rule, configuration);
    description.material = read_material(table.table_or_empty("material"), configuration);
    configuration.specimen = std::move(description);
}

void read_scan(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table("scan");
    const Section section(table, configuration);
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
    const Section section(table, configuration);
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
    const Section section(table, configuration);
    auto& options = configuration.topography;
    options.focus_measure = topography::focus_measure_from_name(section.choice(
        "focus_measure", topography::focus_measure_names(), name_of(options.focus_measure), Influence::nothing));
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
    options.window_shape = topography::window_shape_from_name(section.choice(
        "window_shape", topography::window_shape_names(), name_of(options.window_shape), Influence::nothing));
    options.smoothing_steps = section.number("smoothing_steps", NumberRange::within(0, most_smoothing_steps),
                                             options.smoothing_steps, Influence::nothing);
    options.false_peak_rate =
        section.number("false_peak_rate", NumberRange::between(0, 1), options.false_peak_rate, Influence::nothing);
    options.peak = topography::peak_method_from_name(
        section.choice("peak", topography::peak_method_names(), name_of(options.peak), Influence::nothing));
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
    const Section section(table, configuration);
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
    const Section section(table, configuration);
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
