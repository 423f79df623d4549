#include "optics/prescriptions/prescription_writer.hpp"

#include "core/mathematics/units.hpp"
#include "core/toml/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace vkfv::optics {

namespace {

// The shortest decimal near `guess` that satisfies `reads_back`; if there is none, the shortest that reads back as
// `guess`.
template <class Predicate>
std::string shortest(double guess, Predicate reads_back) {
    constexpr int most_digits = 17; // digits that distinguish all doubles
    for (int digits = 1; digits <= most_digits; ++digits) {
        const double candidate = std::strtod(fmt::format("{:.{}g}", guess, digits).c_str(), nullptr);
        if (reads_back(candidate)) {
            return fmt::format("{}", candidate);
        }
    }
    for (const double neighbour : {std::nextafter(guess, -INFINITY), std::nextafter(guess, INFINITY)}) {
        if (reads_back(neighbour)) {
            return fmt::format("{}", neighbour);
        }
    }
    return fmt::format("{}", guess);
}

std::string degrees(double angle) {
    return shortest(angle / radians_per_degree,
                    [&](double candidate) { return candidate * radians_per_degree == angle; });
}

std::string key_of(const std::string& name) {
    const bool bare = !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                              "0123456789_-") == std::string::npos;
    return bare ? name : toml_quoted(name);
}

std::string break_text(const CoordinateBreak& change) {
    std::vector<std::string> entries;
    const auto add = [&](const char* key, double value, const std::string& text) {
        if (value != 0) {
            entries.push_back(fmt::format("{} = {}", key, text));
        }
    };
    add("decentre_x_mm", change.decentre_x, fmt::format("{}", change.decentre_x));
    add("decentre_y_mm", change.decentre_y, fmt::format("{}", change.decentre_y));
    add("tilt_x_deg", change.tilt_x, degrees(change.tilt_x));
    add("tilt_y_deg", change.tilt_y, degrees(change.tilt_y));
    add("tilt_z_deg", change.tilt_z, degrees(change.tilt_z));
    if (change.tilt_first) {
        entries.push_back("tilt_first = true");
    }
    add("thickness_mm", change.thickness, fmt::format("{}", change.thickness));
    return entries.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(entries, ", "));
}

bool is_reciprocal(const std::string& text, double value) {
    return 1 / std::strtod(text.c_str(), nullptr) == value;
}

std::string reciprocal_text(double value) {
    return shortest(1 / value, [&](double candidate) { return 1 / candidate == value; });
}

// The radius as text if its reciprocal is the curvature to the last bit, else the curvature.
std::string curvature_text(double curvature) {
    const std::string radius = reciprocal_text(curvature);
    return is_reciprocal(radius, curvature) ? fmt::format("radius_mm = {}\n", radius)
                                            : fmt::format("curvature_per_mm = {}\n", curvature);
}

std::string surface_text(const PrescribedSurface& surface, bool is_last) {
    std::string text = "\n[[surface]]\n";
    if (!surface.breaks.empty()) {
        std::vector<std::string> breaks;
        for (const auto& change : surface.breaks) {
            breaks.push_back(break_text(change));
        }
        text += fmt::format("coordinate_breaks = [{}]\n", fmt::join(breaks, ", "));
    }
    if (surface.curvature != 0) {
        text += curvature_text(surface.curvature);
    }
    if (surface.ideal_power) {
        text += fmt::format("ideal_focal_length_mm = {}\n", reciprocal_text(*surface.ideal_power));
    }
    if (surface.conic != 0) {
        text += fmt::format("conic = {}\n", surface.conic);
    }
    const auto end = std::find_if(surface.aspheric.rbegin(), surface.aspheric.rend(), [](double coefficient) {
                         return coefficient != 0;
                     }).base();
    if (end != surface.aspheric.begin()) {
        text += fmt::format("aspheric = [{}]\n", fmt::join(surface.aspheric.begin(), end, ", "));
    }
    if (!is_last || surface.thickness != 0) {
        text += fmt::format("thickness_mm = {}\n", surface.thickness);
    }
    if (surface.medium_after.name != Medium::air().name) {
        text += fmt::format("medium = {}\n", toml_quoted(surface.medium_after.name));
    }
    if (surface.semi_diameter) {
        text += fmt::format("semi_diameter_mm = {}\n", *surface.semi_diameter);
    }
    if (surface.role != SurfaceRole::refracting) {
        text += fmt::format("role = {}\n", toml_quoted(name_of(surface.role)));
    }
    return text;
}

struct DispersionText {
    std::string operator()(const ConstantIndex& constant) const { return fmt::format("index = {}\n", constant.index); }
    std::string operator()(const IndexTable& table) const {
        return fmt::format("wavelengths_um = [{}]\nindices = [{}]\n", fmt::join(table.wavelengths_um, ", "),
                           fmt::join(table.indices, ", "));
    }
    std::string operator()(const ModelGlass& model) const {
        return fmt::format("nd = {}\nvd = {}\n", model.nd, model.vd);
    }
    std::string operator()(const GlassFormula& glass) const {
        return fmt::format("formula = {}\ncoefficients = [{}]\nrange_um = [{}, {}]\n",
                           toml_quoted(dispersion_formula_names[static_cast<std::size_t>(glass.formula) - 1]),
                           fmt::join(glass.coefficients, ", "), glass.minimum_um, glass.maximum_um);
    }
};

std::string medium_text(const Medium& medium, const std::string& default_source) {
    std::string text = fmt::format("\n[media.{}]\n", key_of(medium.name));
    if (!medium.source.empty() && medium.source != default_source) {
        text += fmt::format("source = {}\n", toml_quoted(medium.source));
    }
    return text + std::visit(DispersionText{}, medium.dispersion);
}

} // namespace

std::string prescription_text(const Prescription& prescription) {
    std::string text = fmt::format("title = {}\nsource = {}\nlicence = {}\n", toml_quoted(prescription.title),
                                   toml_quoted(prescription.source), toml_quoted(prescription.licence));
    if (prescription.source_distance) {
        text += fmt::format("source_distance_mm = {}\n", *prescription.source_distance);
    }
    const auto glasses = GlassCatalog::builtin();
    std::vector<Medium> own; // media that the built-in catalogue lacks
    const auto use = [&](const Medium& medium) {
        const auto is_same = [&](const Medium& other) { return other.name == medium.name; };
        const auto known = glasses.find(medium.name);
        if (medium.name != Medium::air().name && !(known && known->dispersion == medium.dispersion) &&
            std::none_of(own.begin(), own.end(), is_same)) {
            own.push_back(medium);
        }
    };
    use(prescription.medium_before);
    if (prescription.medium_before.name != Medium::air().name) {
        text += fmt::format("medium_before = {}\n", toml_quoted(prescription.medium_before.name));
    }
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        text += surface_text(prescription.surfaces[i], i + 1 == prescription.surfaces.size());
        use(prescription.surfaces[i].medium_after);
    }
    for (const auto& medium : own) {
        text += medium_text(medium, prescription.source);
    }
    return text;
}

} // namespace vkfv::optics
