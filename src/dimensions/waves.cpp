#include "dimensions/waves.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "dimensions/least_squares.hpp"
#include "dimensions/statistics.hpp"
#include "surface/filter.hpp"

#include <algorithm>
#include <complex>
#include <numeric>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

struct Point {
    double x, y, z;                 // mm, about the frame's origin and the heights' mean
    std::array<double, 2> distance; // what frequencies are multiplied by
};

struct Points {
    std::vector<Point> all;
    std::vector<std::size_t> places; // in the map
    std::size_t components;          // of a frequency
    double extent;                   // mm

    std::size_t unknowns(std::size_t waves) const { return 3 + waves * (2 + components); }
};

Points points_of(const HeightMap& map, const Frame& frame, bool radial) {
    Points points{.all = {}, .places = {}, .components = radial ? 1u : 2u, .extent = 0};
    double mean = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = map.height(column, row); std::isfinite(z)) {
                const double x = map.x(column) - frame.x, y = map.y(row) - frame.y;
                const double r = std::hypot(x, y);
                points.all.push_back({x, y, z, radial ? std::array{r, 0.0} : std::array{x, y}});
                points.places.push_back(map.height.index(column, row));
                points.extent = std::max(points.extent, 2 * r);
                mean += z;
            }
    for (auto& point : points.all)
        point.z -= mean / static_cast<double>(points.all.size());
    // The diagonal's, or the radius': the shorter of what frequencies can be told apart over.
    if (radial)
        points.extent /= 2;
    return points;
}

double turns(const Wave& wave, const Point& point) {
    return wave.frequency[0] * point.distance[0] + wave.frequency[1] * point.distance[1];
}

// 1, x, y; of each wave cosine and sine; and with `derivatives` what a change of its frequencies changes.
void functions_at(const Point& point, const std::vector<Wave>& waves, const Points& points, bool derivatives,
                  std::vector<double>& functions) {
    functions.assign({1.0, point.x, point.y});
    for (const auto& wave : waves) {
        const double angle = 2 * pi * turns(wave, point);
        const double cosine = std::cos(angle), sine = std::sin(angle);
        functions.insert(functions.end(), {cosine, sine});
        if (derivatives) {
            const double slope = -2 * pi * wave.amplitude * std::sin(angle - wave.phase);
            for (std::size_t k = 0; k < points.components; ++k)
                functions.push_back(slope * point.distance[k]);
        }
    }
}

std::optional<LeastSquares::Solution> solved(const Points& points, const std::vector<Wave>& waves, bool derivatives,
                                             std::size_t stride = 1) {
    std::vector<double> functions;
    LeastSquares squares(derivatives ? points.unknowns(waves.size()) : 3 + 2 * waves.size());
    for (std::size_t k = 0; k < points.all.size(); k += stride) {
        functions_at(points.all[k], waves, points, derivatives, functions);
        squares.add(functions, points.all[k].z);
    }
    return squares.solve();
}

void take_amplitudes(std::vector<Wave>& waves, const std::vector<double>& unknowns, std::size_t per_wave) {
    for (std::size_t k = 0; k < waves.size(); ++k) {
        const double cosine = unknowns[3 + per_wave * k], sine = unknowns[4 + per_wave * k];
        waves[k].amplitude = std::hypot(cosine, sine);
        waves[k].phase = std::atan2(sine, cosine);
    }
}

// Of the frequencies given and their neighbours along their own direction, wave by wave, those of greatest amplitude.
void choose_starts(const Points& points, std::vector<Wave>& waves) {
    const std::size_t stride = points.all.size() / 50'000 + 1;
    for (auto& wave : waves) {
        const Wave given = wave;
        Wave best = given;
        const double step = 0.25 / points.extent * given.period();
        for (const double steps : {0.0, -1.0, 1.0, -2.0, 2.0}) {
            std::vector<Wave> one{given};
            for (double& component : one.front().frequency)
                component *= 1 + steps * step;
            if (const auto solution = solved(points, one, false, stride)) {
                take_amplitudes(one, solution->unknowns, 2);
                if (one.front().amplitude > best.amplitude)
                    best = one.front();
            }
        }
        wave = best;
    }
    if (const auto solution = solved(points, waves, false, stride))
        take_amplitudes(waves, solution->unknowns, 2);
}

std::optional<Waves> fitted(const HeightMap& map, const Points& points, std::vector<Wave> waves) {
    const std::size_t per_wave = 2 + points.components;
    if (points.all.size() < 2 * points.unknowns(waves.size()))
        return std::nullopt;
    for (const auto& wave : waves)
        if (!(wave.period() * 1.5 <= points.extent))
            return std::nullopt;
    choose_starts(points, waves);
    const std::vector<Wave> start = waves;
    std::optional<LeastSquares::Solution> solution;
    bool settled = false;
    for (int iteration = 0; iteration < 30 && !settled; ++iteration) {
        solution = solved(points, waves, true);
        if (!solution)
            return std::nullopt;
        settled = true;
        take_amplitudes(waves, solution->unknowns, per_wave);
        for (std::size_t k = 0; k < waves.size(); ++k)
            for (std::size_t component = 0; component < points.components; ++component) {
                const double change = solution->unknowns[3 + per_wave * k + 2 + component];
                waves[k].frequency[component] += change;
                settled = settled && std::abs(change) * points.extent < 1e-9;
                if (!(std::abs(waves[k].frequency[component] - start[k].frequency[component]) * points.extent < 2))
                    return std::nullopt;
            }
    }
    if (!settled)
        return std::nullopt;
    Waves result{.waves = waves};
    Grid<double> residues(map.columns(), map.rows(), surface::undefined);
    std::vector<double> functions;
    double squares = 0;
    for (std::size_t k = 0; k < points.all.size(); ++k) {
        functions_at(points.all[k], waves, points, true, functions);
        const double rest =
            points.all[k].z - std::inner_product(functions.begin(), functions.end(), solution->unknowns.begin(), 0.0);
        residues.values[points.places[k]] = rest;
        squares += rest * rest;
    }
    const auto count = static_cast<double>(points.all.size());
    result.residue = std::sqrt(squares / count);
    const double variance =
        squares / (count - static_cast<double>(points.unknowns(waves.size()))) * correlated_points(residues);
    for (std::size_t k = 0; k < waves.size(); ++k) {
        const double* variances = &solution->variances[3 + per_wave * k];
        Wave& wave = result.waves[k];
        const double cosine = std::cos(wave.phase), sine = std::sin(wave.phase);
        wave.amplitude_error = std::sqrt(variance * (cosine * cosine * variances[0] + sine * sine * variances[1]));
        double along = 0;
        for (std::size_t component = 0; component < points.components; ++component)
            along += std::pow(wave.frequency[component] * wave.period(), 2) * variances[2 + component];
        wave.period_error = std::sqrt(variance * along) * wave.period() * wave.period();
    }
    return result;
}

} // namespace

std::optional<Waves> fitted_waves(const HeightMap& map, const Frame& frame,
                                  const std::vector<std::array<double, 2>>& frequencies) {
    std::vector<Wave> waves;
    for (const auto& frequency : frequencies)
        waves.push_back({.frequency = frequency});
    return fitted(map, points_of(map, frame, false), std::move(waves));
}

std::optional<Waves> fitted_radial_wave(const HeightMap& map, const Frame& frame, double frequency) {
    return fitted(map, points_of(map, frame, true), {{.frequency = {frequency, 0}}});
}

std::optional<std::array<double, 2>> strongest_frequency(const HeightMap& map,
                                                         const std::optional<std::array<double, 2>>& apart) {
    const HeightMap level = surface::remove_plane(map, surface::least_squares_plane(map));
    const auto window = [](int k, int count) { return std::pow(std::sin(pi * (k + 0.5) / count), 2); };
    Grid<std::complex<double>> spectrum(convenient_length(2 * map.columns()), convenient_length(2 * map.rows()));
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = level.height(column, row); std::isfinite(z))
                spectrum(column, row) = z * window(column, map.columns()) * window(row, map.rows());
    fourier_transform(spectrum);
    const double width = map.columns() * map.pitch_x, height = map.rows() * map.pitch_y;
    double largest = 0;
    std::array<double, 2> strongest{};
    for (int row = 0; row < spectrum.rows; ++row)
        for (int column = 0; 2 * column <= spectrum.columns; ++column) {
            const std::array frequency{fourier_frequency(column, spectrum.columns) / map.pitch_x,
                                       fourier_frequency(row, spectrum.rows) / map.pitch_y};
            // What the plane has taken a part of.
            if (std::hypot(frequency[0] * width, frequency[1] * height) < 1.5)
                continue;
            if (apart) {
                const double cross = frequency[0] * (*apart)[1] - frequency[1] * (*apart)[0];
                if (std::abs(cross) < std::sin(20 * radians_per_degree) * std::hypot(frequency[0], frequency[1]) *
                                          std::hypot((*apart)[0], (*apart)[1]))
                    continue;
            }
            if (const double size = std::abs(spectrum(column, row)); size > largest) {
                largest = size;
                strongest = frequency;
            }
        }
    return largest > 0 ? std::optional(strongest) : std::nullopt;
}

} // namespace vkfv::dimensions
