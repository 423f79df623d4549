// The tables [specimen], [specimen.roughness], [specimen.material] and [[specimen.material.lobe]]: their keys and
// readers. The reader of [specimen.reflectance] is in pattern.cpp.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/files/assets.hpp"
#include "core/files/digest.hpp"
#include "core/mathematics/units.hpp"
#include "core/parsing/number_table.hpp"
#include "physics/scatter_registry.hpp"
#include "specimen/kinds.hpp"
#include "specimen/scatter_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <deque>
#include <functional>
#include <map>
#include <span>

namespace vkfv {

namespace {

// The keys of [specimen]: the kind, and the keys of all kinds. A key that kinds share is here once, with the names of
// its kinds.
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

struct PlacementKeys {
    NumberKey x{"x_um", NumberRange::finite(), 0.0, "Displacement of the specimen from the axis along x."};
    NumberKey y{"y_um", NumberRange::finite(), 0.0, "Displacement along y."};
    NumberKey z{"z_um", NumberRange::finite(), 0.0, "Displacement towards the objective."};
    NumberKey rotation{"rotation_deg", tilt_range_deg, 0.0, "Rotation about the axis, from +x towards +y."};
    NumberKey tilt_x{"tilt_x_deg", NumberRange::between(-90, 90), 0.0,
                     "Slope angle along x that a level surface gets. A specimen that is turned or tilted is traced as "
                     "a mesh."};
    NumberKey tilt_y{"tilt_y_deg", NumberRange::between(-90, 90), 0.0, "Slope angle along y that it gets."};
    KeyTable table{.path = "specimen.placement",
                   .presence = KeyTable::Presence::optional,
                   .meaning = "Where the specimen lies: it is turned about the axis, then tilted, then displaced, with "
                              "its reflectance. Not for representation = \"analytic\".",
                   .subject = {},
                   .kind = {},
                   .keys = {&x, &y, &z, &rotation, &tilt_x, &tilt_y}};
};

const PlacementKeys& placement_keys() {
    static const PlacementKeys keys;
    return keys;
}

// Words as a sentence: "asymmetry: 0 is Lambertian" becomes "Asymmetry: 0 is Lambertian."
std::string sentence_of(std::string_view words) {
    std::string sentence(words);
    sentence.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence.front())));
    return sentence + ".";
}

// The keys of a lobe: a scatter model, the model's parameters, and the lobe's share of the light.
struct LobeKeys {
    LobeKeys(std::optional<std::size_t> default_model, NumberKey share_key, KeyTable lobe_table)
        : scatter("scatter", options(), default_model, "How light is scattered."), share(std::move(share_key)),
          table(std::move(lobe_table)) {
        scatter.example = "\"henyey-greenstein\"";
        table.kind = "scatter";
        table.keys.push_back(&scatter);
        for (const auto& model : scatter_registry) {
            for (const auto& parameter : model.parameters) {
                declare(std::string(model.name), parameter);
            }
        }
        for (const NumberKey& key : parameters) {
            table.keys.push_back(&key);
        }
        const std::initializer_list<const Key*> further = {
            &sq,   &sq_wavelength,     &index_wavelengths,       &refractive_indices, &extinctions,     &index_file,
            &file, &reciprocity_limit, &reflectance_wavelengths, &reflectances,       &reflectance_file};
        table.keys.insert(table.keys.end(), further);
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

    // Models share the key of a parameter, since parameters of one name are the same in all models.
    void declare(const std::string& model, const physics::ScatterParameter& parameter) {
        const auto known = std::ranges::find(parameters, parameter.name, &NumberKey::name);
        if (known != parameters.end()) {
            known->kinds.push_back(model);
            return;
        }
        parameters.push_back(of_kinds({model}, NumberKey(std::string(parameter.name),
                                                         NumberRange::within(parameter.minimum, parameter.maximum),
                                                         parameter.fallback, sentence_of(parameter.meaning))));
    }

    ChoiceKey<std::size_t> scatter;   // index into scatter_registry
    std::deque<NumberKey> parameters; // those of all models
    NumberKey sq = of_kinds(
        {"abg", "harvey-shack"},
        NumberKey(
            "sq_um", NumberRange::positive(), Default::in_words("this lobe is scattered light alone"),
            "Root mean square height of the surface's finish. It parts the light at normal incidence: the share "
            "1 - exp(-(4 pi sq_um / sq_wavelength_um)^2) is scattered, the rest mirrored, as a lobe of its own."));
    NumberKey sq_wavelength =
        of_kinds({"abg", "harvey-shack"},
                 NumberKey("sq_wavelength_um", wavelength_range_um, Default::in_words("needed with sq_um"),
                           "Wavelength of that share, which all light has."));
    NumbersKey index_wavelengths =
        of_kinds(index_models(), NumbersKey("index_wavelengths_um", wavelength_range_um,
                                            Default::in_words("the index is the same at all wavelengths"),
                                            "Ascending wavelengths in vacuum of refractive_indices, instead of "
                                            "refractive_index and extinction_coefficient: linear in between, held "
                                            "beyond."));
    NumbersKey refractive_indices =
        of_kinds(index_models(), NumbersKey("refractive_indices", index_range(),
                                            Default::in_words("needed with "
                                                              "index_wavelengths_um"),
                                            "Real part n of the index at each of index_wavelengths_um."));
    NumbersKey extinctions =
        of_kinds(index_models(), NumbersKey("extinction_coefficients", extinction_range(),
                                            Default::in_words("needed with index_wavelengths_um"),
                                            "Imaginary part k of the index at each of index_wavelengths_um."));
    FileKey index_file =
        of_kinds(index_models(), FileKey("index_file", Default::in_words("the index in the configuration"),
                                         "CSV file of wavelength_um,refractive_index,extinction_coefficient."));
    FileKey file = of_kinds(
        {"tabulated"},
        for_example("\"bsdf.csv\"", FileKey("file", Default::none(),
                                            "CSV file of incidence_deg,scatter_deg,azimuth_deg,bsdf_per_sr, or "
                                            "without azimuth_deg: each combination of its angles once. Azimuths "
                                            "are counted from the mirror direction's, 0 to 180 degrees.")));
    NumberKey reciprocity_limit = without_influence(
        of_kinds({"tabulated"}, NumberKey("reciprocity_limit", NumberRange::at_least(0), 0.1,
                                          "A table is refused whose bsdf deviates more from reciprocity: mean of "
                                          "|f(i, o) - f(o, i)| over that of f.")));
    NumbersKey reflectance_wavelengths{"reflectance_wavelengths_um", wavelength_range_um,
                                       Default::in_words("the reflectance is the same at all wavelengths"),
                                       "Ascending wavelengths in vacuum of reflectances."};
    NumbersKey reflectances{
        "reflectances", NumberRange::within(0, 1), Default::in_words("needed with reflectance_wavelengths_um"),
        "Share of this light that is kept at each of reflectance_wavelengths_um: linear in between, "
        "held beyond."};
    FileKey reflectance_file{"reflectance_file", Default::in_words("the reflectances in the configuration"),
                             "CSV file of wavelength_um,reflectance, instead of reflectances."};
    NumberKey share;
    KeyTable table;

  private:
    static std::vector<std::string> index_models() { return {"conductor", "ggx-conductor"}; }
    static NumberRange index_range() { return NumberRange::within(0.01, 20); }
    static NumberRange extinction_range() { return NumberRange::within(0, 20); }
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

bool is_of(const Key& key, const std::string& model) {
    return key.kinds.empty() || std::ranges::find(key.kinds, model) != key.kinds.end();
}

// The keys of columns over the wavelength. The columns stand under two or more keys of the configuration, or in a file
// whose first column is wavelength_um. There are no columns if neither is given.
struct SpectralKeys {
    const NumbersKey* wavelengths;
    std::vector<const NumbersKey*> values;
    const FileKey* file;
    std::vector<std::string_view> columns;
};

std::vector<specimen::SpectralFunction> read_spectral_file(const Section& section, const SpectralKeys& keys) {
    const TomlTable& table = section.table();
    const auto file = looked_for(table.file_path(keys.file->name));
    Digest digest;
    std::vector<specimen::SpectralFunction> functions(keys.values.size());
    as_named(table, keys.file->name, file, [&] {
        for (const auto& point : read_number_table(file, keys.columns, table.path() + "." + keys.file->name, "point")) {
            digest.add_values(std::span<const double>(point.values));
            const auto require = [&](std::size_t column, bool holds, std::string expected) {
                if (!holds) {
                    throw InputError({.where = {.file = file, .line = point.line, .column = 1},
                                      .key = std::string(keys.columns[column]),
                                      .found = fmt::format("{}", point.values[column]),
                                      .expected = std::move(expected),
                                      .remedy = "Correct this field."});
                }
            };
            require(0, wavelength_range_um.contains(point.values[0]),
                    "a wavelength " + wavelength_range_um.to_string() + " um");
            require(0,
                    functions.front().wavelengths_um.empty() ||
                        point.values[0] > functions.front().wavelengths_um.back(),
                    "wavelengths that ascend");
            for (std::size_t k = 0; k < functions.size(); ++k) {
                const NumberRange& range = keys.values[k]->range;
                require(k + 1, range.contains(point.values[k + 1]), "a number " + range.to_string());
                functions[k].wavelengths_um.push_back(point.values[0]);
                functions[k].values.push_back(point.values[k + 1]);
            }
        }
    });
    section.record_reference(*keys.file, absolute_path(file).string(), digest.text());
    return functions;
}

std::vector<specimen::SpectralFunction> read_spectral(const Section& section, const SpectralKeys& keys) {
    const auto is_given = [&](const Key* key) { return section.has(*key); };
    const bool by_keys = is_given(keys.wavelengths) || std::ranges::any_of(keys.values, is_given);
    if (section.has(*keys.file)) {
        if (by_keys) {
            section.fail(*keys.file, fmt::format("{} or {}, not both", keys.file->name, keys.wavelengths->name),
                         "Remove one of the two.");
        }
        return read_spectral_file(section, keys);
    }
    if (!by_keys) {
        return {};
    }
    const auto wavelengths = section.numbers(*keys.wavelengths);
    if (wavelengths.empty() ||
        std::ranges::adjacent_find(wavelengths, std::ranges::greater_equal()) != wavelengths.end()) {
        section.fail(*keys.wavelengths, "wavelengths that ascend", "Sort them, and give each once.");
    }
    std::vector<specimen::SpectralFunction> functions;
    for (const NumbersKey* key : keys.values) {
        functions.push_back({wavelengths, section.numbers(*key)});
        if (functions.back().values.size() != wavelengths.size()) {
            section.fail(*key, fmt::format("as many numbers as {}, {}", keys.wavelengths->name, wavelengths.size()),
                         "Give one for each wavelength.");
        }
    }
    return functions;
}

specimen::TabulatedBsdf read_tabulated(const Section& section, const LobeKeys& keys) {
    const TomlTable& table = section.table();
    const double limit = section.number(keys.reciprocity_limit);
    table.require(keys.file.name);
    const auto file = looked_for(table.file_path(keys.file.name));
    specimen::TabulatedBsdf bsdf;
    as_named(table, keys.file.name, file,
             [&] { bsdf = specimen::read_tabulated_bsdf(file, table.path() + "." + keys.file.name, limit); });
    Digest digest;
    for (const auto* values : {&bsdf.incidences, &bsdf.scatters, &bsdf.azimuths, &bsdf.values}) {
        digest.add_values(std::span<const double>(*values));
    }
    section.record_reference(keys.file, absolute_path(file).string(), digest.text());
    return bsdf;
}

// Reads a scatter model, its parameters, and their changes with the wavelength. Refuses keys of another model.
specimen::Lobe read_lobe(const Section& section, const LobeKeys& keys) {
    const auto& model = scatter_registry[section.choice(keys.scatter)];
    section.table().require(keys.scatter.name);
    specimen::Lobe lobe;
    lobe.model = model.name;
    lobe.parameters.clear();
    for (const auto& parameter : model.parameters) {
        lobe.parameters.push_back(
            section.number(*std::ranges::find(keys.parameters, parameter.name, &NumberKey::name)));
    }
    for (const Key* key : keys.table.keys) {
        if (!is_of(*key, lobe.model) && section.has(*key)) {
            section.note(*key, fmt::format("no such key for scatter = \"{}\"", lobe.model),
                         fmt::format("Remove it; it belongs to scatter = \"{}\".", fmt::join(key->kinds, "\" or \"")));
        }
    }
    if (is_of(keys.index_file, lobe.model)) {
        const auto index = read_spectral(section, {&keys.index_wavelengths,
                                                   {&keys.refractive_indices, &keys.extinctions},
                                                   &keys.index_file,
                                                   {"wavelength_um", "refractive_index", "extinction_coefficient"}});
        if (!index.empty()) {
            lobe.refractive_index = index[0];
            lobe.extinction_coefficient = index[1];
        }
    }
    if (model.from_file) {
        lobe.bsdf = read_tabulated(section, keys);
    }
    const auto reflectance = read_spectral(section, {&keys.reflectance_wavelengths,
                                                     {&keys.reflectances},
                                                     &keys.reflectance_file,
                                                     {"wavelength_um", "reflectance"}});
    if (!reflectance.empty()) {
        lobe.reflectance = reflectance[0];
    }
    return lobe;
}

// Reads the lobe of a table. If the height of the surface's finish is given, part of its light goes to a mirror lobe
// beside it.
std::vector<specimen::Lobe> read_lobes(const Section& section, const LobeKeys& keys) {
    specimen::Lobe lobe = read_lobe(section, keys);
    lobe.weight = section.number(keys.share);
    const auto sq = is_of(keys.sq, lobe.model) ? section.number_if_given(keys.sq) : std::nullopt;
    const auto wavelength = is_of(keys.sq, lobe.model) ? section.number_if_given(keys.sq_wavelength) : std::nullopt;
    if (sq.has_value() != wavelength.has_value()) {
        section.fail(sq ? keys.sq_wavelength : keys.sq, "sq_um and sq_wavelength_um together, or neither",
                     "Give both, or remove the one.");
    }
    std::vector<specimen::Lobe> lobes;
    if (sq) {
        const double scattered = specimen::total_scatter(from_um(*sq), *wavelength);
        specimen::Lobe mirror{.model = "mirror", .weight = lobe.weight * (1 - scattered), .parameters = {}};
        mirror.reflectance = lobe.reflectance;
        lobe.weight *= scattered;
        lobes.push_back(std::move(mirror));
    }
    lobes.push_back(std::move(lobe));
    std::erase_if(lobes, [](const auto& one) { return !(one.weight > 0); });
    return lobes;
}

// Reads one lobe from the table itself, or several from [[specimen.material.lobe]].
specimen::Material read_material(const TomlTable& table, ReadKeys& read) {
    const Section section(table, material_keys().table, read);
    const auto lobe_tables = table.optional_tables("lobe");
    specimen::Material material;
    material.lobes.clear();
    if (lobe_tables.empty()) {
        material.lobes = read_lobes(section, material_keys());
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
        for (specimen::Lobe& lobe : read_lobes(lobe_section, lobe_keys())) {
            reflectance += lobe.weight;
            material.lobes.push_back(std::move(lobe));
        }
        if (reflectance > 1 + specimen::weight_rounding) {
            lobe_section.fail(lobe_keys().share,
                              fmt::format("weights that add up to at most 1, not {:.6g}", reflectance),
                              "Choose smaller weights; what they leave of 1 is absorbed.");
        }
    }
    if (material.lobes.size() > specimen::most_lobes) {
        table.fail("lobe", fmt::format("at most {} lobes; one with sq_um is two", specimen::most_lobes),
                   "Leave the weakest out.");
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

specimen::Placement read_placement(const TomlTable& table, ReadKeys& read) {
    const auto& keys = placement_keys();
    const Section section(table, keys.table, read);
    return {
        .shift = {from_um(section.number(keys.x)), from_um(section.number(keys.y)), from_um(section.number(keys.z))},
        .rotation = section.number(keys.rotation) * radians_per_degree,
        .tilt_x = section.number(keys.tilt_x) * radians_per_degree,
        .tilt_y = section.number(keys.tilt_y) * radians_per_degree};
}

// Completes [specimen] by the keys of the standard that it names. The canonical text and the identity have these keys,
// so that neither depends on the place where the standard was found.
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
    return {&specimen_keys().table, &roughness_keys().table, &material_keys().table,
            &lobe_keys().table,     &reflectance_keys(),     &placement_keys().table};
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
    if (const auto placement = table.optional_table("placement")) {
        description.placement = read_placement(*placement, read);
    }
    configuration.specimen = std::move(description);
}

} // namespace vkfv
