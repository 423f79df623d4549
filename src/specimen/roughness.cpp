#include "specimen/roughness.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/threads/parallel_rows.hpp"
#include "specimen/analytic.hpp"
#include "specimen/description.hpp"
#include "specimen/random_heights.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <future>
#include <numeric>
#include <span>

namespace vkfv::specimen {

using physics::f64::surface_height;

namespace {

// Removes wavelengths shorter or longer than these (in points) from a periodic grid's spectrum.
void keep_wavelengths(Grid<double>& grid, double shortest, double longest) {
    Grid<std::complex<double>> spectrum(grid.columns, grid.rows);
    std::ranges::copy(grid.values, spectrum.values.begin());
    fourier_transform(spectrum);
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const double frequency =
                std::hypot(fourier_frequency(column, grid.columns), fourier_frequency(row, grid.rows));
            if (frequency * longest < 1 || frequency * shortest > 1) {
                spectrum(column, row) = 0;
            }
        }
    }
    inverse_fourier_transform(spectrum);
    std::ranges::transform(spectrum.values, grid.values.begin(), [](const auto& value) { return value.real(); });
}

// Filtered noise of unit standard deviation before the filter.
Grid<double> unit_roughness(int columns, int rows, const Roughness& roughness) {
    const double kernel = roughness.kernel / roughness.pitch;
    if (!roughness.shortest && !roughness.longest) {
        return filtered_noise(columns, rows, kernel, roughness.seed);
    }
    Grid<double> whole = filtered_noise(convenient_length(columns), convenient_length(rows), kernel, roughness.seed);
    keep_wavelengths(whole, roughness.shortest.value_or(0) / roughness.pitch,
                     roughness.longest ? *roughness.longest / roughness.pitch : 1e300);
    Grid<double> part(columns, rows);
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            part(column, row) = whole(column, row);
        }
    }
    return part;
}

// The mean of |value - mean| over a line.
double mean_deviation(std::span<const double> line) {
    const auto count = static_cast<double>(line.size());
    const double mean = std::reduce(line.begin(), line.end(), 0.0) / count;
    return std::accumulate(line.begin(), line.end(), 0.0,
                           [&](double sum, double value) { return sum + std::abs(value - mean); }) /
           count;
}

} // namespace

RoughnessHeights roughness_heights(const Grid<double>& heights) {
    RoughnessHeights result;
    auto sq = std::async(std::launch::async, [&] {
        Grid<double> about_mean = heights;
        subtract_mean(about_mean);
        return root_mean_square(about_mean);
    });
    auto sa = std::async(std::launch::async, [&] { return mean_deviation(heights.values); });
    std::vector<double> of_rows(static_cast<std::size_t>(heights.rows));
    parallel_rows(heights.columns, heights.rows, [&](int first, int end) {
        for (int row = first; row < end; ++row) {
            of_rows[static_cast<std::size_t>(row)] = mean_deviation(
                std::span(heights.values).subspan(heights.index(0, row), static_cast<std::size_t>(heights.columns)));
        }
    });
    // Several neighbouring columns are copied together, because a single one would fetch all of the memory.
    constexpr int together = 16;
    std::vector<double> of_columns(static_cast<std::size_t>(heights.columns));
    parallel_bands(heights.columns, together, [&](int first, int end) {
        Grid<double> columns(heights.rows, end - first);
        for (int row = 0; row < heights.rows; ++row) {
            for (int column = first; column < end; ++column) {
                columns(row, column - first) = heights(column, row);
            }
        }
        for (int column = first; column < end; ++column) {
            of_columns[static_cast<std::size_t>(column)] =
                mean_deviation(std::span(columns.values)
                                   .subspan(columns.index(0, column - first), static_cast<std::size_t>(heights.rows)));
        }
    });
    double rows = 0, columns = 0;
    for (const double each : of_columns) {
        columns += each / heights.columns;
    }
    for (const double each : of_rows) {
        rows += each / heights.rows;
    }
    result.ra = 0.5 * (rows + columns);
    result.sq = sq.get();
    result.sa = sa.get();
    return result;
}

void check_roughness(double width, double height, const Roughness& roughness, const SourceLocation& where) {
    const auto fail = [&](const std::string& key, double found, const std::string& expected) {
        throw InputError({where, "specimen.roughness." + key, fmt::format("{:.6g}", found * um_per_mm), expected,
                          "Correct the value in the configuration."});
    };
    if (!(std::isfinite(roughness.noise) && roughness.noise >= 0)) {
        fail("noise_um", roughness.noise, "a length, 0 or more");
    }
    const double extent = std::max(width, height);
    if (!(roughness.kernel >= 0 && roughness.kernel <= extent)) {
        fail("kernel_um", roughness.kernel, fmt::format("a length from 0 to the specimen's {} um", extent * um_per_mm));
    }
    if (!positive(roughness.pitch)) {
        fail("pitch_um", roughness.pitch, positive_um());
    }
    for (const auto& [key, value] : {std::pair("sq_um", roughness.sq), std::pair("ra_um", roughness.ra)}) {
        if (value && !(std::isfinite(*value) && *value >= 0)) {
            fail(key, *value, "a length, 0 or more");
        }
    }
    if (roughness.shortest && !(*roughness.shortest >= 2 * roughness.pitch * (1 - 1e-9))) {
        fail("shortest_wavelength_um", *roughness.shortest,
             fmt::format("at least two pitches, {:.6g} um", 2 * roughness.pitch * um_per_mm));
    }
    if (roughness.longest &&
        !(*roughness.longest > roughness.shortest.value_or(2 * roughness.pitch) && *roughness.longest <= extent)) {
        fail("longest_wavelength_um", *roughness.longest,
             fmt::format("more than the shortest wavelength and at most the specimen's {:.6g} um", extent * um_per_mm));
    }
    check_work_of_noise(width, height, roughness.pitch, roughness.kernel, where, "roughness.pitch_um");
}

void add_roughness(HeightField& field, const Roughness& roughness, const SourceLocation& where) {
    check_roughness(field.x_max() - field.x_min, field.y_max() - field.y_min, roughness, where);
    // Pitches that agree to 1e-9 count as equal, to allow for the rounding of a quotient.
    const double coarsest = std::max(field.pitch_x, field.pitch_y);
    if (roughness.pitch < coarsest * (1 - 1e-9)) {
        throw InputError({where, "specimen.roughness.pitch_um", fmt::format("{:.6g}", roughness.pitch * um_per_mm),
                          fmt::format("a length no less than the specimen's pitch, {} um", coarsest * um_per_mm),
                          "Give the roughness a coarser pitch or the specimen a finer one."});
    }
    HeightField own;
    own.x_min = field.x_min;
    own.y_min = field.y_min;
    own.pitch_x = own.pitch_y = roughness.pitch;
    const auto points = [&](int count, double pitch) {
        return static_cast<int>(std::ceil((count - 1) * pitch / roughness.pitch * (1 - 1e-9))) + 1;
    };
    own.heights = Grid<float>(points(field.heights.columns, field.pitch_x), points(field.heights.rows, field.pitch_y));
    Grid<double> noise = unit_roughness(own.heights.columns, own.heights.rows, roughness);
    double scale = roughness.noise;
    const RoughnessHeights unit = roughness_heights(noise);
    if (roughness.sq || roughness.ra) {
        if (!(unit.sq > 1e-12)) {
            throw InputError({where, "specimen.roughness.longest_wavelength_um", "no wavelength that fits",
                              "a band with wavelengths that the specimen's size has: its size over 1, 2, 3, ...",
                              "Widen the band of wavelengths."});
        }
        subtract_mean(noise);
        scale = roughness.sq ? *roughness.sq / unit.sq : *roughness.ra / unit.ra;
    }
    std::transform(noise.values.begin(), noise.values.end(), own.heights.values.begin(),
                   [&](double value) { return static_cast<float>(scale * value); });
    spdlog::info("roughness: Sq {:.4g} um, Sa {:.4g} um, Ra {:.4g} um of noise {:.4g} um, kernel {:.4g} um, pitch "
                 "{:.4g} um",
                 scale * unit.sq * um_per_mm, scale * unit.sa * um_per_mm, scale * unit.ra * um_per_mm,
                 scale * um_per_mm, roughness.kernel * um_per_mm, roughness.pitch * um_per_mm);

    const bool same_grid = std::abs(roughness.pitch - field.pitch_x) <= 1e-9 * roughness.pitch &&
                           std::abs(roughness.pitch - field.pitch_y) <= 1e-9 * roughness.pitch;
    const physics::f64::SpecimenRecord record = record_of_lattice(own);
    const LatticeScene scene{&own};
    parallel_rows(field.heights.columns, field.heights.rows, [&](int first, int end) {
        for (int row = first; row < end; ++row) {
            for (int column = 0; column < field.heights.columns; ++column) {
                const double added = same_grid ? scene.lattice_at(column, row)
                                               : surface_height(scene, record, field.x_min + column * field.pitch_x,
                                                                field.y_min + row * field.pitch_y)
                                                     .height;
                field.heights(column, row) = static_cast<float>(field.heights(column, row) + added);
            }
        }
    });
}

} // namespace vkfv::specimen
