// [specimen], [specimen.roughness], [specimen.material] and [[specimen.material.lobe]]; reflectance.cpp has its map.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/files/assets.hpp"
#include "physics/scatter_registry.hpp"
#include "specimen/kinds.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <map>

namespace vkfv {

namespace {

// [specimen]: the kind, and all keys of the kinds. Keys that kinds share are here once, with the names of all of them.
class SpecimenKeys {
  public:
    SpecimenKeys() : kind("kind", options(), needed, "What the specimen is, unless standard says it.") {
        kind.example = "\"plane\"";
        std::map<const Key*, Key*> copies;
        for (const auto& one : specimen::kinds()) {
            for (const Key* key : one.keys) {
                auto& copy = copies[key];
                if (!copy) {
                    copy = &keys_.emplace_back(*key);
                }
                copy->kinds.push_back(one.name);
            }
        }
        table.keys.push_back(&kind);
        table.keys.push_back(&standard);
        for (const Key& key : keys_) {
            table.keys.push_back(&key);
        }
    }

    ChoiceKey<const specimen::Kind*> kind;
    TextKey standard{
        "standard", Default::in_words("none"),
        "A standard in place of kind: a name in assets/specimens, or a file (.toml) with a table [specimen]. "
        "Keys beside it hold instead of its own; stack.toml has its keys written out."};
    KeyTable table{.path = "specimen",
                   .meaning = "The object under the microscope, around x = y = 0; its height 0 is the focal height 0.",
                   .subject = "a specimen",
                   .kind = "kind",
                   .keys = {},
                   .shown = true};

  private:
    static std::vector<ChoiceKey<const specimen::Kind*>::Option> options() {
        std::vector<ChoiceKey<const specimen::Kind*>::Option> list;
        for (const auto& one : specimen::kinds()) {
            list.push_back({&one, one.name, one.meaning});
        }
        return list;
    }

    std::deque<Key> keys_;
};

const SpecimenKeys& specimen_keys() {
    static const SpecimenKeys keys;
    return keys;
}

struct RoughnessKeys {
    NumberKey noise = for_example("0.1", NumberKey("noise_um", NumberRange::at_least(0),
                                                   Default::in_words("none: noise_um, sq_um or ra_um is needed"),
                                                   "Standard deviation of the white noise that is filtered."));
    NumberKey sq{"sq_um", NumberRange::at_least(0), Default::in_words("what the filter leaves of the noise"),
                 "Root mean square height (Sq) of what is made, instead of noise_um."};
    NumberKey ra{
        "ra_um", NumberRange::at_least(0), Default::in_words("what the filter leaves of the noise"),
        "Arithmetic mean deviation (Ra) of its rows and columns over their whole length, in the mean, instead of "
        "noise_um."};
    NumberKey shortest{"shortest_wavelength_um", NumberRange::positive(), Default::in_words("none is taken out"),
                       "Shorter wavelengths of the noise are taken out; at least 2 pitch_um."};
    NumberKey longest{"longest_wavelength_um", NumberRange::positive(), Default::in_words("none is taken out"),
                      "Longer wavelengths of the noise are taken out."};
    NumberKey kernel =
        for_example("1.0", NumberKey("kernel_um", NumberRange::positive(),
                                     Default::in_words("none: it is needed where shortest_wavelength_um is not given"),
                                     "Standard deviation of the Gaussian that filters it; what remains is about "
                                     "noise_um * pitch_um / (2 sqrt(pi) kernel_um) high, as the log says."));
    NumberKey pitch = for_example(
        "0.5", NumberKey("pitch_um", NumberRange::positive(), needed, "Distance of neighbouring points of the noise."));
    IntegerKey seed{"seed", 0, largest_seed, 1, "Of the random numbers that the noise is made of."};
    KeyTable table{.path = "specimen.roughness",
                   .presence = KeyTable::Presence::optional,
                   .meaning = "Roughness over a specimen of any kind but a mesh: filtered noise.",
                   .subject = {},
                   .kind = {},
                   .keys = {&noise, &sq, &ra, &kernel, &shortest, &longest, &pitch, &seed}};
};

const RoughnessKeys& roughness_keys() {
    static const RoughnessKeys keys;
    return keys;
}

using physics::scatter_registry;

// "asymmetry: 0 is Lambertian" as a sentence.
std::string sentence_of(std::string_view words) {
    std::string sentence(words);
    sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
    return sentence + ".";
}

// The keys of a lobe: a scatter model, its parameters, and what share of the light it has.
struct LobeKeys {
    LobeKeys(std::optional<std::size_t> default_model, NumberKey share_key, KeyTable lobe_table)
        : scatter("scatter", options(), default_model, "How light is scattered."), share(std::move(share_key)),
          table(std::move(lobe_table)) {
        scatter.example = "\"henyey-greenstein\"";
        table.kind = "scatter";
        table.keys.push_back(&scatter);
        for (const auto& model : scatter_registry) {
            for (const auto& parameter : model.parameters) {
                parameters.push_back(of_kinds({std::string(model.name)},
                                              NumberKey(std::string(parameter.name),
                                                        NumberRange::within(parameter.minimum, parameter.maximum),
                                                        parameter.fallback, sentence_of(parameter.meaning))));
                table.keys.push_back(&parameters.back());
            }
        }
        table.keys.push_back(&share);
    }
    LobeKeys(const LobeKeys&) = delete;
    LobeKeys& operator=(const LobeKeys&) = delete;

    static std::vector<ChoiceKey<std::size_t>::Option> options() {
        std::vector<ChoiceKey<std::size_t>::Option> list;
        for (const auto& model : scatter_registry) {
            list.push_back({list.size(), std::string(model.name)});
        }
        return list;
    }

    ChoiceKey<std::size_t> scatter;   // index in the registry
    std::deque<NumberKey> parameters; // of all models, in their order
    NumberKey share;
    KeyTable table;
};

const LobeKeys& material_keys() {
    static const auto* const default_model =
        std::ranges::find(scatter_registry, specimen::Lobe{}.model, &physics::ScatterModel::name);
    static const LobeKeys keys(
        static_cast<std::size_t>(default_model - scatter_registry.begin()),
        {"reflectance", NumberRange::within(0, 1), 1.0, "Share of the light that is scattered; the rest is absorbed."},
        {.path = "specimen.material",
         .presence = KeyTable::Presence::optional,
         .meaning = "How the surface scatters; or one to four [[specimen.material.lobe]].",
         .subject = {},
         .kind = {},
         .keys = {}});
    return keys;
}

const LobeKeys& lobe_keys() {
    static const LobeKeys keys(
        needed,
        for_example("0.5", NumberKey("weight", {.minimum = 0, .maximum = 1, .minimum_included = false}, needed,
                                     "Share of the light that this lobe scatters; what all "
                                     "lobes leave of 1 is absorbed.")),
        {.path = "specimen.material.lobe",
         .presence = KeyTable::Presence::repeated,
         .meaning = "One of at most four ways in which a material scatters side by side.",
         .subject = {},
         .kind = {},
         .keys = {}});
    return keys;
}

// A scatter model and its parameters. Those of another model are refused.
specimen::Lobe read_lobe(const Section& section, const LobeKeys& keys) {
    const auto& model = scatter_registry[section.choice(keys.scatter)];
    section.table().require(keys.scatter.name);
    specimen::Lobe lobe;
    lobe.model = model.name;
    lobe.parameters.clear();
    std::map<std::string, std::vector<std::string>> models_with;
    for (const NumberKey& key : keys.parameters) {
        models_with[key.name].push_back(key.kinds.front());
    }
    for (const NumberKey& key : keys.parameters) {
        if (key.kinds.front() == lobe.model) {
            lobe.parameters.push_back(section.number(key));
            models_with.erase(key.name);
        }
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
specimen::Material read_material(const TomlTable& table, ReadKeys& read) {
    const Section section(table, material_keys().table, read);
    const auto lobe_tables = table.optional_tables("lobe");
    specimen::Material material;
    material.lobes.clear();
    if (lobe_tables.empty()) {
        specimen::Lobe lobe = read_lobe(section, material_keys());
        lobe.weight = section.number(material_keys().share);
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
    for (const auto& one : lobe_tables) {
        const Section lobe_section(one, lobe_keys().table, read);
        material.lobes.push_back(read_lobe(lobe_section, lobe_keys()));
        material.lobes.back().weight = lobe_section.number(lobe_keys().share);
        reflectance += material.lobes.back().weight;
        if (reflectance > 1 + specimen::weight_rounding) {
            lobe_section.fail(lobe_keys().share,
                              fmt::format("weights that add up to at most 1, not {:.6g}", reflectance),
                              "Choose smaller weights; what they leave of 1 is absorbed.");
        }
    }
    return material;
}

specimen::Roughness read_roughness(const TomlTable& table, const TomlTable& specimen_table, const specimen::Kind& kind,
                                   ReadKeys& read) {
    if (!kind.takes_roughness) {
        specimen_table.fail("roughness", fmt::format("no roughness for a specimen of kind \"{}\"", kind.name),
                            "Remove [specimen.roughness]; a mesh brings its own.");
    }
    const auto& keys = roughness_keys();
    const Section section(table, keys.table, read);
    specimen::Roughness roughness;
    const auto length = [&](const NumberKey& key) {
        const auto value = section.number_if_given(key);
        return value ? std::optional(from_um(*value)) : std::nullopt;
    };
    roughness.sq = length(keys.sq);
    roughness.ra = length(keys.ra);
    if (section.has(keys.noise) + section.has(keys.sq) + section.has(keys.ra) > 1) {
        section.fail(section.has(keys.sq) ? keys.sq : keys.ra, "one of noise_um, sq_um and ra_um",
                     "Keep one of them; each says how high the roughness is.");
    }
    if (!section.has(keys.sq) && !section.has(keys.ra)) {
        roughness.noise = from_um(section.number(keys.noise));
    }
    roughness.shortest = length(keys.shortest);
    roughness.longest = length(keys.longest);
    if (section.has(keys.kernel) || !section.has(keys.shortest)) {
        roughness.kernel = from_um(section.number(keys.kernel));
    }
    roughness.pitch = from_um(section.number(keys.pitch));
    roughness.seed = static_cast<std::uint32_t>(section.integer(keys.seed));
    return roughness;
}

// What [specimen] has not itself, of the standard that it names. The canonical text and the identity have the
// standard's own keys, so that neither depends on where it was found.
void take_standard(const TomlTable& table, const Configuration& configuration) {
    constexpr const char* folder = "specimens";
    const std::string& key = specimen_keys().standard.name;
    const auto name = table.optional_string(key);
    if (!name) {
        return;
    }
    if (table.has(specimen_keys().kind.name)) {
        table.fail(key, "no such key beside kind", "Remove one of them; a standard has its kind.");
    }
    const auto base = absolute_path(configuration.file).parent_path();
    const bool is_path = name->ends_with(".toml");
    const std::string wanted = is_path ? absolute_path(table.file_path(key)).string() : *name;
    const auto file = find_asset(wanted, folder, base);
    if (!file) {
        const auto meant = nearest_word(*name, asset_names(folder, base));
        table.fail(key,
                   fmt::format("{}; {}",
                               is_path ? "an existing file" : "the name of a file in assets/specimens, without .toml",
                               searched_for_asset(wanted, folder, base)),
                   fmt::format("{}Correct the name (vkfv list standards), or give the path of a file (.toml).",
                               meant ? fmt::format("Did you mean \"{}\"? ", *meant) : ""));
    }
    table.complete_from(*file);
}

} // namespace

std::vector<const KeyTable*> specimen_key_tables() {
    return {&specimen_keys().table, &roughness_keys().table, &material_keys().table, &lobe_keys().table,
            &reflectance_keys()};
}

void read_specimen(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table("specimen");
    ReadKeys& read = configuration;
    take_standard(table, configuration);
    const Section section(table, specimen_keys().table, read);
    const specimen::Kind& kind = *section.kind(specimen_keys().kind);
    const auto roughness_table = table.optional_table("roughness");
    specimen::Description description;
    description.shape = kind.read(section);
    description.where = specimen::file_of(description.shape).empty() ? table.where() : table.where("file");
    if (roughness_table) {
        description.roughness = read_roughness(*roughness_table, table, kind, read);
    }
    description.material = read_material(table.table_or_empty("material"), read);
    if (const auto reflectance = table.optional_table("reflectance")) {
        description.reflectance = read_reflectance(*reflectance, read);
    }
    configuration.specimen = std::move(description);
}

} // namespace vkfv
