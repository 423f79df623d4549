#include "dimensions/waves.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "dimensions/correlated_errors.hpp"
#include "dimensions/least_squares.hpp"
#include "surface/filter.hpp"

#include <algorithm>
#include <complex>
#include <limits>
#include <numeric>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

struct Point {
    double x, y, z;                 // mm, relative to the frame's origin and the heights' mean
    std::array<double, 2> distance; // mm, factors of the frequency's components in the phase
};

struct Points {
    std::vector<Point> all;
    std::vector<std::size_t> places; // indices into the map
    std::size_t components;          // number of components of a frequency
    double extent;                   // mm, over which frequencies are distinguished

    std::size_t unknowns(std::size_t waves) const { return 3 + waves * (2 + components); }
};

Points points_of(const HeightMap& map, const Frame& frame, bool radial) {
    Points points{.all = {}, .places = {}, .components = radial ? 1u : 2u, .extent = 0};
    double mean = 0;
    double left = std::numeric_limits<double>::infinity(), bottom = left, right = -left, top = -left;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = map.height(column, row); std::isfinite(z)) {
                const double x = map.x(column) - frame.x, y = map.y(row) - frame.y;
                const double r = std::hypot(x, y);
                points.all.push_back({x, y, z, radial ? std::array{r, 0.0} : std::array{x, y}});
                points.places.push_back(map.height.index(column, row));
                left = std::min(left, x);
                right = std::max(right, x);
                bottom = std::min(bottom, y);
                top = std::max(top, y);
                // Radial waves extend from the frame's origin, others over the diagonal of what is measured.
                points.extent = radial ? std::max(points.extent, r) : std::hypot(right - left, top - bottom);
                mean += z;
            }
    for (auto& point : points.all)
        point.z -= mean / static_cast<double>(points.all.size());
    return points;
}

double turns(const Wave& wave, const Point& point) {
    return wave.frequency[0] * point.distance[0] + wave.frequency[1] * point.distance[1];
}

// The fit's functions at a point: 1, x, y; cosine and sine of each wave; and with `derivatives` those by the wave's
// frequencies.
void functions_at(const Point& point, const std::vector<Wave>& waves, const Points& points, bool derivatives,
                  std::span<double> functions) {
    std::size_t next = 3;
    std::ranges::copy(std::array{1.0, point.x, point.y}, functions.begin());
    for (const auto& wave : waves) {
        const double angle = 2 * pi * turns(wave, point);
        const double cosine = std::cos(angle), sine = std::sin(angle);
        functions[next++] = cosine;
        functions[next++] = sine;
        if (derivatives) {
            const double slope = -2 * pi * wave.amplitude * std::sin(angle - wave.phase);
            for (std::size_t k = 0; k < points.components; ++k)
                functions[next++] = slope * point.distance[k];
        }
    }
}

std::optional<LeastSquares::Solution> solved(const Points& points, const std::vector<Wave>& waves, bool derivatives,
                                             std::size_t stride = 1) {
    const std::size_t unknowns = derivatives ? points.unknowns(waves.size()) : 3 + 2 * waves.size();
    std::vector<double> functions(unknowns);
    LeastSquares squares(unknowns);
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

// Chooses, wave by wave, among the given frequency and its neighbours along its own direction, the one of greatest
// amplitude.
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

// Subtracts the mean at each phase of one wave, or of two: harmonics common to all periods are the standard's shape,
// not scatter of the heights. Returns the number of means.
double remove_periodic_part(Grid<double>& residues, const Points& points, const std::vector<Wave>& waves) {
    constexpr double points_a_mean = 24;
    constexpr int most_phases = 256;
    if (waves.size() > 2)
        return 0;
    const double means = static_cast<double>(points.all.size()) / points_a_mean;
    const int phases =
        static_cast<int>(std::min<double>(most_phases, waves.size() == 1 ? means / 4 : std::sqrt(means)));
    if (phases < 4)
        return 0;
    const int second_phases = waves.size() == 2 ? phases : 1;
    // A point contributes to the means at the four phases around its own, with bilinear weights.
    const auto shares_of = [&](const Point& point, const auto& visit) {
        std::array<int, 2> lower{}, upper{};
        std::array<double, 2> share{};
        for (std::size_t k = 0; k < waves.size(); ++k) {
            const double turn = turns(waves[k], point), place = (turn - std::floor(turn)) * phases;
            lower[k] = static_cast<int>(place) % phases;
            upper[k] = (lower[k] + 1) % phases;
            share[k] = place - std::floor(place);
        }
        for (const bool up : {false, true})
            for (const bool second_up : {false, true})
                if (const double weight = (up ? share[0] : 1 - share[0]) * (second_up ? share[1] : 1 - share[1]);
                    weight > 0)
                    visit(up ? upper[0] : lower[0], second_up ? upper[1] : lower[1], weight);
    };
    // Several passes are needed, as each mean over the neighbourhood of a phase rounds the edges of lines.
    constexpr int passes = 4;
    for (int pass = 0; pass < passes; ++pass) {
        Grid<double> sums(phases, second_phases), counts(phases, second_phases);
        for (std::size_t k = 0; k < points.all.size(); ++k)
            shares_of(points.all[k], [&](int first, int second, double weight) {
                sums(first, second) += weight * residues.values[points.places[k]];
                counts(first, second) += weight;
            });
        for (std::size_t k = 0; k < points.all.size(); ++k) {
            double mean = 0;
            shares_of(points.all[k], [&](int first, int second, double weight) {
                mean += weight * sums(first, second) / counts(first, second);
            });
            residues.values[points.places[k]] -= mean;
        }
    }
    return static_cast<double>(phases) * second_phases;
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
    std::vector<double> functions(points.unknowns(waves.size()));
    std::vector<std::size_t> number(residues.values.size()); // index of the point at a place
    double squares = 0;
    for (std::size_t k = 0; k < points.all.size(); ++k) {
        functions_at(points.all[k], waves, points, true, functions);
        const double rest =
            points.all[k].z - std::inner_product(functions.begin(), functions.end(), solution->unknowns.begin(), 0.0);
        residues.values[points.places[k]] = rest;
        number[points.places[k]] = k;
        squares += rest * rest;
    }
    result.residue = std::sqrt(squares / static_cast<double>(points.all.size()));
    const double taken = remove_periodic_part(residues, points, waves);
    const auto covariance = fit_covariance(
        residues, *solution,
        [&](std::size_t place, std::span<double> values) {
            functions_at(points.all[number[place]], waves, points, true, values);
        },
        taken);
    // The standard error of a linear combination of changes of the waves: for each wave k, the weights of its cosine,
    // its sine and its frequencies, in the order of the unknowns.
    const auto error_of = [&](std::initializer_list<std::pair<std::size_t, std::array<double, 4>>> changes) {
        std::vector<double> weights(points.unknowns(waves.size()));
        for (const auto& [k, change] : changes)
            std::copy_n(change.begin(), per_wave, weights.begin() + static_cast<std::ptrdiff_t>(3 + per_wave * k));
        return covariance.standard_error(weights);
    };
    for (std::size_t k = 0; k < waves.size(); ++k) {
        Wave& wave = result.waves[k];
        const auto& f = wave.frequency;
        const double size = std::hypot(f[0], f[1]), period = wave.period();
        wave.amplitude_error = error_of({{k, {std::cos(wave.phase), std::sin(wave.phase), 0, 0}}});
        wave.period_error = error_of({{k, {0, 0, f[0] / size, f[1] / size}}}) * period * period;
    }
    if (waves.size() == 2 && points.components == 2) {
        const auto turn = [](const Wave& wave, double sign) {
            const double square = std::pow(wave.frequency[0], 2) + std::pow(wave.frequency[1], 2);
            return std::array{0.0, 0.0, -sign * wave.frequency[1] / square, sign * wave.frequency[0] / square};
        };
        result.angle_error = error_of({{0, turn(waves[0], -1)}, {1, turn(waves[1], 1)}});
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
            // Lower frequencies are skipped, as the plane has removed a part of them.
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
