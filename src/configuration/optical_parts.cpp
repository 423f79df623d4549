#include "configuration/optical_parts.hpp"

#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/files/assets.hpp"
#include "core/files/digest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv {

namespace {

constexpr NumberRange offset_range = {.minimum = -1e6, .maximum = 1e6}; // mm

std::string digest_of(const optics::Medium& medium) {
    return Digest().add(medium.dispersion_text()).text();
}

std::string content_digest(const optics::Prescription& prescription) {
    Digest digest;
    const auto add_medium = [&](const optics::Medium& medium) { digest.add(medium.dispersion_text() + ";"); };
    add_medium(prescription.medium_before);
    for (const auto& surface : prescription.surfaces) {
        for (const auto& change : surface.breaks) {
            digest.add(fmt::format("{} {} {} {} {} {} {};", change.decentre_x, change.decentre_y, change.tilt_x,
                                   change.tilt_y, change.tilt_z, change.tilt_first, change.thickness));
        }
        digest.add(fmt::format("{} {} {} {} {} {} {};", surface.curvature, surface.conic,
                               fmt::join(surface.aspheric, " "), surface.thickness, surface.semi_diameter.value_or(0),
                               surface.ideal_power.value_or(0), static_cast<int>(surface.role)));
        add_medium(surface.medium_after);
    }
    digest.add(fmt::format("{}", prescription.source_distance.value_or(0)));
    return digest.text();
}

std::string remedy_for_prescription(const std::string& name, const std::string& folder,
                                    const std::filesystem::path& base) {
    const auto meant = nearest_word(name, asset_names(folder, base));
    return fmt::format("{}Correct the name, or give the path of a prescription (.toml).",
                       meant ? fmt::format("Did you mean \"{}\"? ", *meant) : "");
}

const FileKey glass_catalogs = [] {
    FileKey key(glass_catalogs_key, Default::in_words("none"),
                "Glass catalogues (AGF files) besides the built-in one, as a list of paths.");
    key.type = Key::Type::texts;
    return key;
}();

const NumberKey decentre_x("decentre_x_mm", offset_range, 0.0, "Shift along x.");
const NumberKey decentre_y("decentre_y_mm", offset_range, 0.0, "Shift along y.");
const NumberKey tilt_x("tilt_x_deg", tilt_range_deg, 0.0, "Turn about x.");
const NumberKey tilt_y("tilt_y_deg", tilt_range_deg, 0.0, "Turn about y.");
const NumberKey tilt_z("tilt_z_deg", tilt_range_deg, 0.0, "Turn about z.");
const BooleanKey tilt_first("tilt_first", false, "Whether the turns come before the shifts.");
const NumbersKey global("global_mm", offset_range, Default::in_words("where the part stands without it"),
                        "Place of the first vertex: x, y and z from the object's plane on.");

} // namespace

const KeyTable& root_keys() {
    static const KeyTable table{.path = "",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "Keys at the top of the file.",
                                .subject = "",
                                .kind = "",
                                .keys = {&glass_catalogs}};
    return table;
}

void read_glass_catalogs(const TomlTable& root, Configuration& configuration) {
    const std::string key = glass_catalogs_key;
    configuration.glasses = optics::GlassCatalog::builtin();
    std::vector<std::string> paths;
    for (const auto& path : root.optional_file_paths(key)) {
        const auto file = looked_for(path);
        root.attempt(fmt::format("{}[{}]", key, paths.size()),
                     [&] { as_named(root, key, file, [&] { configuration.glasses.add(file); }); });
        paths.push_back(toml_quoted(absolute_path(path).string()));
    }
    // The identity does without the catalogues, since it has the digests of the parts made of their glasses.
    if (!paths.empty()) {
        configuration.canonical += fmt::format("{} = [{}]\n", key, fmt::join(paths, ", "));
        configuration.places[key] = root.where(key);
    }
}

optics::Prescription read_prescription(const Section& section, const TextKey& key, const Configuration& configuration,
                                       const std::string& folder, const std::optional<std::string>& fallback) {
    const TomlTable& table = section.table();
    std::string name = fallback ? table.optional_string(key.name).value_or(*fallback) : table.string(key.name);
    if (name.ends_with(".toml")) {
        name = absolute_path(table.file_path(key.name)).string();
    }
    const auto base = absolute_path(configuration.file).parent_path(); // the file may have no folder in its path
    if (!find_asset(name, folder, base)) {
        section.note(key,
                     fmt::format("{}; {}",
                                 name.ends_with(".toml")
                                     ? "an existing file"
                                     : fmt::format("the name of a file in assets/{}, without .toml", folder),
                                 searched_for_asset(name, folder, base)),
                     remedy_for_prescription(name, folder, base));
        return optics::Prescription();
    }
    optics::Prescription prescription;
    if (table.sound(glass_catalogs_key)) { // otherwise its glasses may be in an unread catalogue
        table.attempt(key.name,
                      [&] { prescription = optics::load_prescription(name, folder, base, configuration.glasses); });
    }
    if (prescription.surfaces.empty()) { // the problem is noted already
        return prescription;
    }
    // The name of an installed file means this file from anywhere. The path of any other file is kept.
    if (!comes_with_program(prescription.file, folder)) {
        name = absolute_path(prescription.file).string();
    }
    section.record_reference(key, name, content_digest(prescription));
    return prescription;
}

optics::Medium read_glass(const Section& section, const TextKey& key, const Configuration& configuration) {
    const TomlTable& table = section.table();
    const std::string name = table.optional_string(key.name).value_or(key.fallback_text());
    std::optional<optics::Medium> glass;
    try {
        glass = name == optics::Medium::air().name ? optics::Medium::air() : configuration.glasses.find(name);
    } catch (const InputError& error) { // catalogues disagree, or the glass's record is wrong
        section.note(key, error.problem().expected, error.problem().remedy);
        return optics::Medium::air();
    }
    if (!glass) {
        if (table.sound(glass_catalogs_key)) { // otherwise the glass may be in an unread catalogue
            section.note(key, "the name of a glass, built in or of a catalogue",
                         "Correct the name, or add its catalogue to glass_catalogs.");
        }
        return optics::Medium::air();
    }
    section.record_reference(key, name, digest_of(*glass));
    return *glass;
}

std::vector<const Key*> with_placement(std::vector<const Key*> keys) {
    keys.insert(keys.end(), {&decentre_x, &decentre_y, &tilt_x, &tilt_y, &tilt_z, &tilt_first, &global});
    return keys;
}

optics::Placement read_placement(const Section& section) {
    optics::Placement placement;
    placement.change.decentre_x = section.number(decentre_x);
    placement.change.decentre_y = section.number(decentre_y);
    placement.change.tilt_x = section.number(tilt_x) * radians_per_degree;
    placement.change.tilt_y = section.number(tilt_y) * radians_per_degree;
    placement.change.tilt_z = section.number(tilt_z) * radians_per_degree;
    placement.change.tilt_first = section.boolean(tilt_first);
    if (section.has(global)) {
        const auto point = section.numbers(global);
        if (point.size() != 3) {
            section.note(global, "three numbers: x, y and z in mm, from the object's plane on",
                         "Give the place of the first vertex.");
        } else {
            placement.global = glm::dvec3(point[0], point[1], point[2]);
        }
    }
    return placement;
}

} // namespace vkfv
