#include "optics/prescription.hpp"

#include "core/error.hpp"
#include "core/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace vkfv::optics {

namespace {

constexpr double wavelength_tolerance_um = 0.01; // beyond the tabulated range
constexpr NumberRange index_range = {.minimum = 1, .maximum = 5};
// Of any length; wide of every microscope, and far from where squares overflow.
constexpr NumberRange length_range = {.minimum = 0, .maximum = 1e6};

std::filesystem::path asset_in(const std::filesystem::path& assets, const std::filesystem::path& folder,
                               const std::string& name) {
    return assets / folder / (name + ".toml");
}

bool names_a_path(const std::string& name) {
    return name.ends_with(".toml");
}

Medium read_medium(const TomlTable& table, const std::string& name) {
    Medium medium{.name = name,
                  .wavelengths_um = table.numbers("wavelengths_um", NumberRange::positive()),
                  .indices = table.numbers("indices", index_range)};
    if (medium.wavelengths_um.empty() ||
        std::adjacent_find(medium.wavelengths_um.begin(), medium.wavelengths_um.end(),
                           [](double a, double b) { return a >= b; }) != medium.wavelengths_um.end()) {
        table.fail("wavelengths_um", "at least one wavelength in um, ascending", "Sort the wavelengths.");
    }
    if (medium.indices.size() != medium.wavelengths_um.size()) {
        table.fail("indices", fmt::format("{} indices, one a wavelength", medium.wavelengths_um.size()),
                   "Give as many indices as wavelengths.");
    }
    return medium;
}

Medium medium_named(const std::map<std::string, Medium>& media, const TomlTable& table,
                    std::string_view key) {
    const auto name = table.optional_string(key);
    if (!name || *name == "air") {
        return Medium::air();
    }
    const auto found = media.find(*name);
    if (found == media.end()) {
        std::vector<std::string> names = {"air"};
        for (const auto& [known, medium] : media) {
            names.push_back(known);
        }
        table.fail(key, fmt::format("a medium (one of {})", fmt::join(names, ", ")),
                   fmt::format("Describe it in [media.{}], or correct its name.", *name));
    }
    return found->second;
}

PrescribedSurface read_surface(const TomlTable& table, const std::map<std::string, Medium>& media) {
    PrescribedSurface surface;
    if (table.has("radius_mm")) {
        const double radius = table.number("radius_mm");
        if (table.has("curvature_per_mm")) {
            table.fail("curvature_per_mm", "a radius or a curvature, not both", "Remove one of the two.");
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
    surface.medium_after = medium_named(media, table, "medium");
    surface.semi_diameter = table.optional_number("semi_diameter_mm", NumberRange::positive());
    if (const auto role = table.optional_choice("role", {"aperture stop", "field stop"})) {
        surface.role = *role == "aperture stop" ? PrescribedSurface::Role::aperture_stop
                                                : PrescribedSurface::Role::field_stop;
    }
    return surface;
}

} // namespace

Medium Medium::air() {
    return {.name = "air", .wavelengths_um = {}, .indices = {1.0}};
}

double Medium::index(double wavelength_um) const {
    if (wavelengths_um.empty()) {
        return indices.front();
    }
    if (!(wavelength_um >= wavelengths_um.front() - wavelength_tolerance_um &&
          wavelength_um <= wavelengths_um.back() + wavelength_tolerance_um)) {
        throw InputError({.where = {},
                          .key = fmt::format("index of {}", name),
                          .found = fmt::format("{} um", wavelength_um),
                          .expected = fmt::format("a wavelength within 0.01 um of {} um to {} um",
                                                  wavelengths_um.front(), wavelengths_um.back()),
                          .remedy = "Choose such a wavelength, or add indices to the prescription."});
    }
    // The three nearest of an ascending table are neighbours.
    const std::size_t count = std::min<std::size_t>(3, wavelengths_um.size());
    std::size_t first = 0;
    while (first + count < wavelengths_um.size() &&
           wavelength_um - wavelengths_um[first] > wavelengths_um[first + count] - wavelength_um) {
        ++first;
    }
    // Cauchy's formula is the polynomial in 1 / lambda^2 through the points; in Lagrange's form it is exact
    // there.
    const auto abscissa = [&](std::size_t i) { return 1 / (wavelengths_um[i] * wavelengths_um[i]); };
    const double x = 1 / (wavelength_um * wavelength_um);
    double sum = 0;
    for (std::size_t i = first; i < first + count; ++i) {
        double weight = 1;
        for (std::size_t j = first; j < first + count; ++j) {
            if (j != i) {
                weight *= (x - abscissa(j)) / (abscissa(i) - abscissa(j));
            }
        }
        sum += weight * indices[i];
    }
    return sum;
}

Prescription Prescription::reversed() const {
    Prescription result = *this;
    const std::size_t count = surfaces.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t mirrored = count - 1 - i;
        PrescribedSurface& surface = result.surfaces[i];
        surface = surfaces[mirrored];
        surface.curvature = -surface.curvature;
        for (double& coefficient : surface.aspheric) {
            coefficient = -coefficient;
        }
        surface.medium_after = mirrored == 0 ? medium_before : surfaces[mirrored - 1].medium_after;
        surface.thickness = mirrored == 0 ? surfaces.back().thickness : surfaces[mirrored - 1].thickness;
    }
    if (count > 0) {
        result.medium_before = surfaces.back().medium_after;
    }
    return result;
}

std::optional<std::filesystem::path> find_prescription(const std::string& name,
                                                       const std::filesystem::path& folder,
                                                       const std::filesystem::path& base) {
    std::error_code code;
    const auto is_file = [&](const std::filesystem::path& path) {
        return std::filesystem::is_regular_file(path, code);
    };
    if (names_a_path(name)) {
        const auto path = base / name;
        return is_file(path) ? std::optional(path) : std::nullopt;
    }
    auto beside = std::filesystem::absolute(base, code).lexically_normal();
    while (!beside.empty()) {
        const auto path = asset_in(beside / "assets", folder, name);
        if (is_file(path)) {
            return path;
        }
        if (beside == beside.parent_path()) {
            break;
        }
        beside = beside.parent_path();
    }
    const auto installed = asset_in(VKFV_ASSETS_DIR, folder, name);
    return is_file(installed) ? std::optional(installed) : std::nullopt;
}

Prescription load_prescription(const std::string& name, const std::filesystem::path& folder,
                               const std::filesystem::path& base) {
    const auto file = find_prescription(name, folder, base);
    if (!file) {
        throw InputError({.where = {.file = base},
                          .key = "prescription",
                          .found = "\"" + name + "\"",
                          .expected = names_a_path(name) ? "an existing file"
                                                         : fmt::format("a file assets/{}/{}.toml",
                                                                       folder.generic_string(), name),
                          .remedy = "Correct the name, or give the path of a prescription (.toml)."});
    }
    const TomlTable root = TomlTable::open(*file);
    Prescription prescription;
    prescription.file = *file;
    prescription.name = file->stem().string();
    prescription.title = root.optional_string("title").value_or(prescription.name);
    prescription.source = root.string("source");
    prescription.licence = root.string("licence");
    prescription.source_distance = root.optional_number("source_distance_mm", length_range);

    std::map<std::string, Medium> media;
    if (const auto tables = root.optional_table("media")) {
        for (const auto& key : tables->keys()) {
            media[key] = read_medium(tables->table(key), key);
        }
    }
    prescription.medium_before = medium_named(media, root, "medium_before");
    const auto tables = root.tables("surface");
    bool has_aperture_stop = false;
    bool has_field_stop = false;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        auto surface = read_surface(tables[i], media);
        surface.thickness = i + 1 < tables.size()
                                ? tables[i].number("thickness_mm", length_range)
                                : tables[i].optional_number("thickness_mm", length_range).value_or(0);
        for (const auto& [role, seen] :
             {std::pair{PrescribedSurface::Role::aperture_stop, &has_aperture_stop},
              std::pair{PrescribedSurface::Role::field_stop, &has_field_stop}}) {
            if (surface.role == role && std::exchange(*seen, true)) {
                tables[i].fail("role", "one surface of this role", "Mark the one that limits the light.");
            }
        }
        prescription.surfaces.push_back(std::move(surface));
    }
    root.reject_unknown_keys();
    return prescription;
}

} // namespace vkfv::optics
