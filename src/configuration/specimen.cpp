#include "configuration/specimen.hpp"

#include "configuration/configuration_section.hpp"
#include "core/units.hpp"
#include "physics/scatter_registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

namespace vkfv {

namespace {

constexpr std::int64_t largest_seed = 0xffffffffll; // seeds are 32-bit words of the counter-based generator
constexpr std::array length_units = {std::pair{"mm", 1.0}, std::pair{"um", 1e-3}, std::pair{"m", 1e3},
                                     std::pair{"inch", 25.4}};

double from_um(double value) {
    return value / um_per_mm;
} // division rounds 0.8 um to the double nearest 0.0008

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
    const OldSection section(*table, configuration);
    specimen::Roughness roughness;
    roughness.noise = from_um(section.number("noise_um", NumberRange::at_least(0)));
    roughness.kernel = from_um(section.number("kernel_um", NumberRange::positive()));
    roughness.pitch = from_um(section.number("pitch_um", NumberRange::positive()));
    roughness.seed = static_cast<std::uint32_t>(section.integer("seed", 0, largest_seed, 1));
    return roughness;
}

// A scatter model and its parameters. Those of another model are refused.
specimen::Lobe read_lobe(const OldSection& section, const std::optional<std::string>& fallback = {}) {
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
    const OldSection section(table, configuration);
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
        const OldSection lobe_section(lobe_table, configuration);
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

} // namespace

void read_specimen(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table("specimen");
    const OldSection section(table, configuration);
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

} // namespace vkfv
