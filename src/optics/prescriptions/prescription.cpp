#include "optics/prescriptions/prescription.hpp"

#include "core/files/assets.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/toml/toml_reader.hpp"
#include "optics/media/medium_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace vkfv::optics {

const char* name_of(SurfaceRole role) {
    switch (role) {
    case SurfaceRole::aperture_stop:
        return "aperture stop";
    case SurfaceRole::field_stop:
        return "field stop";
    case SurfaceRole::illumination_aperture:
        return "illumination aperture";
    case SurfaceRole::refracting:
        break;
    }
    return "";
}

namespace {

// Lengths in mm: wider than any microscope, and far from values whose squares overflow.
constexpr NumberRange length_range = {.minimum = 0, .maximum = 1e6};
constexpr NumberRange offset_range = {.minimum = -length_range.maximum, .maximum = length_range.maximum};
constexpr NumberRange tilt_range_deg = {.minimum = -360, .maximum = 360};

// The media that a prescription may name: its own, then those of catalogues.
struct Media {
    std::map<std::string, Medium> own;
    const GlassCatalog& glasses;
};

Medium medium_named(const Media& media, const TomlTable& table, std::string_view key) {
    const auto name = table.optional_string(key);
    if (!name || *name == "air") {
        return Medium::air();
    }
    if (const auto found = media.own.find(*name); found != media.own.end()) {
        return found->second;
    }
    try {
        if (auto found = media.glasses.find(*name)) {
            return std::move(*found);
        }
    } catch (const InputError& error) { // catalogues disagree or the record is faulty
        table.note(key, error.problem().expected, error.problem().remedy);
        return Medium::air();
    }
    std::vector<std::string> names = {"air"};
    for (const auto& [known, medium] : media.own) {
        names.push_back(known);
    }
    const auto meant = nearest_word(*name, names); // names of the file's own media
    table.fail(key, fmt::format("a medium (one of {}, or a glass of a catalogue)", fmt::join(names, ", ")),
               (meant ? fmt::format("Did you mean \"{}\"? ", *meant) : "") + remedy_for_unknown_glass(*name));
    return Medium::air();
}

CoordinateBreak read_coordinate_break(const TomlTable& table) {
    const auto offset = [&](const char* key) { return table.optional_number(key, offset_range).value_or(0); };
    const auto tilt = [&](const char* key) {
        return table.optional_number(key, tilt_range_deg).value_or(0) * radians_per_degree;
    };
    return {.decentre_x = offset("decentre_x_mm"),
            .decentre_y = offset("decentre_y_mm"),
            .tilt_x = tilt("tilt_x_deg"),
            .tilt_y = tilt("tilt_y_deg"),
            .tilt_z = tilt("tilt_z_deg"),
            .tilt_first = table.optional_boolean("tilt_first").value_or(false),
            .thickness = offset("thickness_mm")};
}

PrescribedSurface read_surface(const TomlTable& table, const Media& media) {
    PrescribedSurface surface;
    for (const auto& change : table.optional_tables("coordinate_breaks")) {
        surface.breaks.push_back(read_coordinate_break(change));
    }
    if (table.has("radius_mm")) {
        const double radius = table.number("radius_mm");
        if (table.has("curvature_per_mm")) {
            table.note("curvature_per_mm", "a radius or a curvature, not both", "Remove one of the two.");
        }
        surface.curvature = radius == 0 ? 0 : 1 / radius;
        if (!std::isfinite(surface.curvature)) {
            table.fail("radius_mm", "a radius whose reciprocal is finite", "Leave it out for a plane.");
        }
    } else {
        surface.curvature = table.optional_number("curvature_per_mm").value_or(0);
    }
    surface.conic = table.optional_number("conic").value_or(0);
    const auto coefficients = table.optional_numbers("aspheric").value_or(std::vector<double>{});
    if (coefficients.size() > surface.aspheric.size()) {
        table.fail("aspheric", fmt::format("at most {} coefficients, a4 to a16", surface.aspheric.size()),
                   "Leave out higher terms.");
    }
    std::copy(coefficients.begin(), coefficients.end(), surface.aspheric.begin());
    const std::string ideal = "ideal_focal_length_mm";
    if (const auto focal_length = table.optional_number(ideal, offset_range)) {
        for (const char* key : {"radius_mm", "curvature_per_mm", "conic", "aspheric"}) {
            if (table.has(key)) {
                table.note(key, "no shape of an ideal lens, which is thin and plane", "Remove one of the two.");
            }
        }
        surface.ideal_power = 1 / *focal_length;
        if (!std::isfinite(*surface.ideal_power)) {
            table.fail(ideal, "a focal length whose reciprocal is finite", "Leave it out for a plane.");
        }
    }
    surface.medium_after = medium_named(media, table, "medium");
    surface.semi_diameter = table.optional_number("semi_diameter_mm", NumberRange::positive());
    const std::string aperture_stop = name_of(SurfaceRole::aperture_stop);
    if (const auto role = table.optional_choice("role", {aperture_stop, name_of(SurfaceRole::field_stop)})) {
        surface.role = *role == aperture_stop ? SurfaceRole::aperture_stop : SurfaceRole::field_stop;
    }
    return surface;
}

void read_surfaces(const std::vector<TomlTable>& tables, const Media& media, Prescription& prescription) {
    bool has_aperture_stop = false;
    bool has_field_stop = false;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        auto surface = read_surface(tables[i], media);
        surface.thickness = i + 1 < tables.size() ? tables[i].number("thickness_mm", length_range)
                                                  : tables[i].optional_number("thickness_mm", length_range).value_or(0);
        for (const auto& [role, seen] : {std::pair{SurfaceRole::aperture_stop, &has_aperture_stop},
                                         std::pair{SurfaceRole::field_stop, &has_field_stop}}) {
            if (surface.role == role && std::exchange(*seen, true)) {
                tables[i].note("role", "one surface of this role", "Mark the one that limits the light.");
            }
        }
        prescription.surfaces.push_back(std::move(surface));
    }
}

Prescription read_prescription(const TomlTable& root, const std::filesystem::path& file, const GlassCatalog& glasses) {
    Prescription prescription;
    prescription.file = file;
    prescription.name = file.stem().string();
    root.collect_problems(); // one error reports all problems
    prescription.title = root.optional_string("title").value_or(prescription.name);
    prescription.source = root.string("source");
    prescription.licence = root.string("licence");
    prescription.source_distance = root.optional_number("source_distance_mm", length_range);

    Media media{.own = {}, .glasses = glasses};
    if (const auto tables = root.optional_table("media")) {
        for (const auto& key : tables->keys()) {
            media.own[key] = Medium::air(); // a medium of that name must exist even if its table is faulty
            tables->attempt(key, [&] { media.own[key] = read_medium(tables->table(key), key, prescription.source); });
        }
    }
    prescription.medium_before = medium_named(media, root, "medium_before");
    root.attempt("surface", [&] { read_surfaces(root.tables("surface"), media, prescription); });
    root.reject_unknown_keys();
    return prescription;
}

} // namespace

Prescription load_prescription(const std::string& name, const std::filesystem::path& folder,
                               const std::filesystem::path& base, const GlassCatalog& glasses) {
    const auto file = find_asset(name, folder, base);
    if (!file) {
        throw InputError({.where = {.file = base},
                          .key = "prescription",
                          .found = "\"" + name + "\"",
                          .expected = "an existing file; " + searched_for_asset(name, folder, base),
                          .remedy = "Correct the name, or give the path of a prescription (.toml)."});
    }
    return read_prescription(TomlTable::open(*file), *file, glasses);
}

Prescription parse_prescription(std::string_view text, const std::filesystem::path& file, const GlassCatalog& glasses) {
    return read_prescription(TomlTable::parse(text, file), file, glasses);
}

} // namespace vkfv::optics
