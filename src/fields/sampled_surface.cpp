#include "fields/sampled_surface.hpp"

#include "core/mathematics/line_transform.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/threads/parallel_rows.hpp"
#include "specimen/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace vkfv::fields {

namespace {

constexpr double most_beyond = 0.1;      // share of points beyond the model that a surface may have: edges of steps
constexpr double worth_a_warning = 1e-4; // share
constexpr double margin_limits = 8;      // resolution limits, 1 / cutoff, that the margin is wide

double reflectance_of(const specimen::Specimen& specimen, double wavelength_um) {
    const auto& lobes = specimen.material.lobes;
    if (lobes.size() != 1 || lobes.front().model != "mirror") {
        throw InputError({.where = {},
                          .key = "specimen.material.scatter",
                          .found = lobes.empty() ? "no scatter" : lobes.front().model,
                          .expected = "\"mirror\" alone with a [reference_arm], whose waves follow from the heights",
                          .remedy = "Set specimen.material.scatter = \"mirror\", with roughness as heights."});
    }
    if (specimen.reflectance) {
        throw InputError({.where = {},
                          .key = "specimen.reflectance",
                          .found = "a pattern of reflectance",
                          .expected = "one reflectance with a [reference_arm]",
                          .remedy = "Remove the pattern."});
    }
    const auto& lobe = lobes.front();
    return lobe.weight * (lobe.reflectance.values.empty() ? 1 : lobe.reflectance.at(wavelength_um));
}

// Of two slopes to either side the gentler one, or 0 on a ridge: an edge beside a point does not count as its slope.
double gentler(double before, double after) {
    return before * after <= 0 ? 0 : std::abs(before) < std::abs(after) ? before : after;
}

Grid<glm::dvec2> slopes_of(const SampledSurface& surface) {
    const FieldGrid& grid = surface.grid;
    const auto& h = surface.heights;
    Grid<glm::dvec2> slopes(grid.columns, grid.rows, glm::dvec2(0));
    for (int row = 1; row + 1 < grid.rows; ++row) {
        for (int column = 1; column + 1 < grid.columns; ++column) {
            const double here = h(column, row);
            slopes(column, row) = glm::dvec2(gentler(here - h(column - 1, row), h(column + 1, row) - here),
                                             gentler(here - h(column, row - 1), h(column, row + 1) - here)) /
                                  grid.pitch;
        }
    }
    return slopes;
}

// An area so small that its mean height is that of its middle, for heights of points.
specimen::PixelArea spot_at(glm::dvec2 middle, double pitch) {
    constexpr double share = 1e-3; // of the pitch
    return {.middle = middle, .along_row = glm::dvec2(share * pitch, 0), .along_column = glm::dvec2(0, share * pitch)};
}

// A cell holds an edge where its mean height is not that of its middle.
template <class Place>
void find_edges(const specimen::Specimen& specimen, const PixelGrid& points, const Place& place, double wavelength,
                SampledSurface& surface) {
    constexpr double flat = 1.0 / 200; // of the wavelength: a phase of 0.06
    constexpr int side = 8;
    const auto means =
        specimen::truth(specimen, points.columns, points.rows, points.x0, points.y0, points.pitch_x, points.pitch_y)
            .height;
    for (std::size_t k = 0; k < means.values.size(); ++k) {
        if (std::abs(means.values[k] - surface.heights.values[k]) > flat * wavelength) {
            surface.edges.push_back(k);
        } else if (std::isfinite(means.values[k])) {
            surface.heights.values[k] = means.values[k]; // of a curved cell
        }
    }
    if (surface.edges.empty()) {
        return;
    }
    const PixelGrid list{.columns = SampledSurface::parts_of_edge,
                         .rows = static_cast<int>(surface.edges.size()),
                         .x0 = 0,
                         .y0 = 0,
                         .pitch_x = 1,
                         .pitch_y = 1};
    surface.edge_heights =
        specimen::truth(specimen, list, [&](int part, int edge) {
            const auto at = static_cast<int>(surface.edges[static_cast<std::size_t>(edge)]);
            const glm::dvec2 within((part % side + 0.5) / side - 0.5, (part / side + 0.5) / side - 0.5);
            return spot_at(place(at % points.columns, at / points.columns) + points.pitch_x * within, points.pitch_x);
        }).height.values;
    std::ranges::replace_if(
        surface.edge_heights, [](double height) { return !std::isfinite(height); }, 0.0);
}

double sinc(double x) { // sin(x) / x
    return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x;
}

[[noreturn]] void refuse(const char* what, double share, const std::string& limit, const std::string& remedy) {
    throw InputError({.where = {},
                      .key = "specimen",
                      .found = fmt::format("{} on {:.3g} % of the points", what, 100 * share),
                      .expected = fmt::format("{} on at most {:.3g} % with a [reference_arm]: waves of a height map "
                                              "hold no further",
                                              limit, 100 * most_beyond),
                      .remedy = remedy});
}

} // namespace

FieldGrid field_grid(ImageSize pixels, double pitch, double cutoff) {
    FieldGrid grid{.pixels = pixels};
    grid.parts = std::max(1, static_cast<int>(std::ceil(2 * cutoff * pitch)));
    grid.pitch = pitch / grid.parts;
    const auto length = [&](int count) {
        const auto least = count * grid.parts + static_cast<int>(std::ceil(2 * margin_limits / (cutoff * grid.pitch)));
        return convenient_length(least);
    };
    grid.columns = length(pixels.columns);
    grid.rows = length(pixels.rows);
    grid.margin_x = (grid.columns - pixels.columns * grid.parts) / 2;
    grid.margin_y = (grid.rows - pixels.rows * grid.parts) / 2;
    return grid;
}

SampledSurface sample_surface(const specimen::Specimen& specimen, const FieldGrid& grid, double wavelength_um,
                              double aperture_sine) {
    if (std::holds_alternative<specimen::Mesh>(specimen.geometry)) {
        throw InputError({.where = {},
                          .key = "specimen.kind",
                          .found = "a mesh",
                          .expected = "heights over x and y with a [reference_arm]",
                          .remedy = "Choose a kind that is a height map, or remove [reference_arm]."});
    }
    const double amplitude = std::sqrt(reflectance_of(specimen, wavelength_um));
    SampledSurface surface{.grid = grid};
    const double x0 = -(grid.margin_x + 0.5 * (grid.pixels.columns * grid.parts - 1)) * grid.pitch;
    const double y0 = -(grid.margin_y + 0.5 * (grid.pixels.rows * grid.parts - 1)) * grid.pitch;
    const PixelGrid points{
        .columns = grid.columns, .rows = grid.rows, .x0 = x0, .y0 = y0, .pitch_x = grid.pitch, .pitch_y = grid.pitch};
    const auto place = [&](int column, int row) { return glm::dvec2(x0 + column * grid.pitch, y0 + row * grid.pitch); };
    surface.heights = specimen::truth(specimen, points,
                                      [&](int column, int row) { // of points, not areas
                                          return spot_at(place(column, row), grid.pitch);
                                      })
                          .height;
    find_edges(specimen, points, place, wavelength_um * mm_per_um, surface);
    surface.amplitude = Grid<double>(grid.columns, grid.rows, amplitude);
    surface.lowest = 1e300;
    surface.highest = -1e300;
    for (std::size_t k = 0; k < surface.heights.values.size(); ++k) {
        double& height = surface.heights.values[k];
        if (!std::isfinite(height)) {
            height = 0;
            surface.amplitude.values[k] = 0;
            continue;
        }
        surface.lowest = std::min(surface.lowest, height);
        surface.highest = std::max(surface.highest, height);
    }
    if (surface.lowest > surface.highest) {
        throw InputError({.where = {},
                          .key = "specimen",
                          .found = "no surface where the pixels look",
                          .expected = "a specimen in the field",
                          .remedy = "Make it larger, or move it."});
    }
    surface.slopes = slopes_of(surface);
    const double wavelength = wavelength_um * mm_per_um;
    const double most_step = wavelength / 4;                       // 2 k times it is pi
    const double most_bend = grid.pitch * grid.pitch / wavelength; // second difference of that radius
    const double horizon = std::sqrt(1 - aperture_sine * aperture_sine) / aperture_sine; // rise that hides the last ray
    std::size_t steep = 0, sharp = 0, shadowed = 0;
    for (int row = 1; row + 1 < grid.rows; ++row) {
        for (int column = 1; column + 1 < grid.columns; ++column) {
            if (!(surface.amplitude(column, row) > 0)) {
                continue;
            }
            const auto& h = surface.heights;
            const double here = h(column, row);
            const double rise = std::max({h(column + 1, row) - here, h(column - 1, row) - here,
                                          h(column, row + 1) - here, h(column, row - 1) - here});
            const double fall = std::max({here - h(column + 1, row), here - h(column - 1, row),
                                          here - h(column, row + 1), here - h(column, row - 1)});
            const double bend = std::max(std::abs(h(column + 1, row) - 2 * here + h(column - 1, row)),
                                         std::abs(h(column, row + 1) - 2 * here + h(column, row - 1)));
            steep += std::max(rise, fall) > most_step ? 1 : 0;
            sharp += bend > most_bend ? 1 : 0;
            shadowed += rise > horizon * grid.pitch ? 1 : 0;
        }
    }
    const double count = static_cast<double>(surface.heights.values.size());
    surface.steep = static_cast<double>(steep) / count;
    surface.sharp = static_cast<double>(sharp) / count;
    surface.shadowed = static_cast<double>(shadowed) / count;
    if (surface.sharp > most_beyond) {
        refuse("a curvature whose radius is below the wavelength", surface.sharp, "such curvature",
               "Take a smoother surface, whose roughness has a longer correlation length.");
    }
    if (surface.steep > most_beyond) {
        refuse("walls or slopes steeper than a quarter of the wavelength from point to point", surface.steep,
               fmt::format("slopes up to {:.3g}", most_step / grid.pitch), "Take a gentler surface.");
    }
    if (surface.shadowed > most_beyond) {
        refuse("shadow", surface.shadowed, "shadow", "Take a gentler surface, or a smaller aperture.");
    }
    return surface;
}

void reflect(const SampledSurface& surface, double wave_number, double zero, Grid<std::complex<double>>& wave) {
    parallel_rows(wave.columns, wave.rows, [&](int first, int end) {
        for (std::size_t k = wave.index(0, first); k < wave.index(0, end); ++k) {
            // The mean over a plane cell.
            const glm::dvec2 turn = surface.slopes.values[k] * (wave_number * surface.grid.pitch / 2);
            wave.values[k] = std::polar(1.0, -wave_number * (surface.heights.values[k] - zero)) *
                             (surface.amplitude.values[k] * sinc(turn.x) * sinc(turn.y));
        }
    });
    constexpr auto parts = static_cast<std::size_t>(SampledSurface::parts_of_edge);
    parallel_rows(static_cast<int>(parts), static_cast<int>(surface.edges.size()), [&](int first, int end) {
        for (auto edge = static_cast<std::size_t>(first); edge < static_cast<std::size_t>(end); ++edge) {
            std::complex<double> sum = 0;
            for (std::size_t part = 0; part < parts; ++part) {
                sum += std::polar(1.0, -wave_number * (surface.edge_heights[edge * parts + part] - zero));
            }
            const std::size_t k = surface.edges[edge];
            wave.values[k] = sum * (surface.amplitude.values[k] / static_cast<double>(parts));
        }
    });
}

std::vector<Warning> warnings_of(const SampledSurface& surface) {
    std::vector<Warning> warnings;
    const double beyond = std::max({surface.steep, surface.sharp, surface.shadowed});
    if (beyond > worth_a_warning) {
        warnings.push_back({.code = "edges-by-kirchhoff",
                            .key = "specimen",
                            .value = {},
                            .works = "a surface without edges",
                            .sentence = fmt::format("{:.2g} % of the surface is an edge, a wall or shadow, where waves "
                                                    "of a height map are wrong by construction (docs/fields.md).",
                                                    100 * beyond)});
    }
    return warnings;
}

} // namespace vkfv::fields
