#include "specimen/random_heights.hpp"

#include "core/keys/section.hpp"
#include "core/threads/parallel_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace vkfv::specimen {
namespace {

constexpr std::int64_t largest_seed = 0xffffffffll; // seeds are 32-bit words

const NumberKey correlation_length_key =
    for_example("5.0", NumberKey("correlation_length_um", NumberRange::positive(),
                                 Default::in_words("none: it is needed where sq_um is not 0"),
                                 "Distance over which the autocorrelation of the random heights falls to 1/e."));

const IntegerKey random_seed_key("seed", 0, largest_seed, 1, "Of the random numbers that the surface is made of.");

// Filters one direction of a separable, periodic filter: `rows` lines of `columns` points each.
void filter_lines(Grid<double>& grid, const std::vector<double>& weights) {
    const int radius = static_cast<int>(weights.size()) - 1; // weights[k] applies at distance k
    const int columns = grid.columns;
    parallel_rows(columns, grid.rows, [&](int first, int end) {
        std::vector<double> padded(static_cast<std::size_t>(columns + 2 * radius));
        std::vector<double> sums(static_cast<std::size_t>(columns));
        for (int row = first; row < end; ++row) {
            for (int i = 0; i < columns + 2 * radius; ++i) {
                const int column = ((i - radius) % columns + columns) % columns;
                padded[static_cast<std::size_t>(i)] = grid(column, row);
            }
            // The loop over weights is outermost, so that neighbouring points are summed in parallel, each in the order
            // of the weights.
            const double* centre = padded.data() + radius;
            for (int column = 0; column < columns; ++column) {
                sums[static_cast<std::size_t>(column)] = weights[0] * centre[column];
            }
            for (int k = 1; k <= radius; ++k) {
                const double weight = weights[static_cast<std::size_t>(k)];
                for (int column = 0; column < columns; ++column) {
                    sums[static_cast<std::size_t>(column)] += weight * (centre[column + k] + centre[column - k]);
                }
            }
            std::ranges::copy(sums, grid.values.begin() + static_cast<std::ptrdiff_t>(grid.index(0, row)));
        }
    });
}

// The transposed grid, copied by blocks that fit into the cache.
Grid<double> transposed(const Grid<double>& grid) {
    constexpr int block = 32;
    Grid<double> result(grid.rows, grid.columns);
    parallel_rows(grid.columns, grid.rows, [&](int first, int end) {
        for (int top = first; top < end; top += block) {
            for (int left = 0; left < grid.columns; left += block) {
                for (int row = top; row < std::min(end, top + block); ++row) {
                    for (int column = left; column < std::min(grid.columns, left + block); ++column) {
                        result(row, column) = grid(column, row);
                    }
                }
            }
        }
    });
    return result;
}

} // namespace

void subtract_mean(Grid<double>& grid) {
    const double mean =
        std::reduce(grid.values.begin(), grid.values.end(), 0.0) / static_cast<double>(grid.values.size());
    for (double& value : grid.values) {
        value -= mean;
    }
}

double root_mean_square(const Grid<double>& grid) {
    const double sum = std::inner_product(grid.values.begin(), grid.values.end(), grid.values.begin(), 0.0);
    return std::sqrt(sum / static_cast<double>(grid.values.size()));
}

void add_random_heights(HeightField& field, const RandomHeights& random, double size, const SourceLocation& where) {
    require_um(std::isfinite(random.sq) && random.sq >= 0, where, "sq_um", random.sq, "a length, 0 or more");
    require_um(positive(random.correlation_length) && random.correlation_length <= size, where, "correlation_length_um",
               random.correlation_length, "a positive length, at most the size");
    Grid<double> noise = filtered_noise(field.heights.columns, field.heights.rows,
                                        0.5 * random.correlation_length / field.pitch_x, random.seed);
    subtract_mean(noise);
    const double scale = random.sq / root_mean_square(noise);
    for (std::size_t i = 0; i < noise.values.size(); ++i) {
        field.heights.values[i] += static_cast<float>(scale * noise.values[i]);
    }
}

std::vector<const Key*> random_heights_keys(const NumberKey& sq) {
    return {&sq, &correlation_length_key, &random_seed_key};
}

RandomHeights read_random_heights(const Section& section, double sq, double pitch) {
    RandomHeights random{.sq = sq, .correlation_length = pitch}; // heights that are all zero need no length
    if (sq > 0 || section.has(correlation_length_key)) {
        random.correlation_length = from_um(section.number(correlation_length_key));
    }
    random.seed = read_seed(section);
    return random;
}

const Key& seed_key() {
    return random_seed_key;
}

std::uint32_t read_seed(const Section& section) {
    return static_cast<std::uint32_t>(section.integer(random_seed_key));
}

Grid<double> filtered_noise(int columns, int rows, double kernel, std::uint32_t seed) {
    Grid<double> noise(columns, rows);
    std::mt19937_64 generator(seed);
    // 53 random bits give the middle of a cell of (0, 1); the standard library's distributions differ between
    // libraries.
    const auto uniform = [&] { return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53; };
    // Uniform numbers are drawn in sequence; all cores turn them into normal deviates.
    for (std::size_t i = 0; i < noise.values.size(); ++i) {
        noise.values[i] = uniform();
    }
    const double unpaired = noise.values.size() % 2 == 1 ? uniform() : 0;
    const std::size_t pairs = (noise.values.size() + 1) / 2;
    constexpr std::size_t pairs_a_row = 4096;
    parallel_rows(pairs_a_row, static_cast<int>((pairs + pairs_a_row - 1) / pairs_a_row), [&](int first, int end) {
        const std::size_t last = std::min(pairs, static_cast<std::size_t>(end) * pairs_a_row);
        for (std::size_t pair = static_cast<std::size_t>(first) * pairs_a_row; pair < last; ++pair) {
            // Box-Muller transform: G. E. P. Box, M. E. Muller, "A note on the generation of random normal deviates"
            // (1958).
            const std::size_t i = 2 * pair;
            const bool whole = i + 1 < noise.values.size();
            const double r = std::sqrt(-2 * std::log(noise.values[i]));
            const double phi = 2 * pi * (whole ? noise.values[i + 1] : unpaired);
            noise.values[i] = r * std::cos(phi);
            if (whole) {
                noise.values[i + 1] = r * std::sin(phi);
            }
        }
    });
    if (kernel > 0) {
        // Beyond six standard deviations weights are below 2e-8 of the first.
        std::vector<double> weights(static_cast<std::size_t>(std::ceil(6 * kernel)) + 1);
        double sum = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const double z = static_cast<double>(k) / kernel;
            weights[k] = std::exp(-0.5 * z * z);
            sum += (k == 0 ? 1 : 2) * weights[k];
        }
        for (double& weight : weights) {
            weight /= sum;
        }
        filter_lines(noise, weights);
        noise = transposed(noise);
        filter_lines(noise, weights);
        noise = transposed(noise);
    }
    return noise;
}

// The work is the drawing of random numbers, and a filter of 12 standard deviations of points per point in each
// direction.
void check_work_of_noise(double width, double height, double pitch, double deviation, const SourceLocation& where,
                         const std::string& key) {
    constexpr double most_steps = 0x1p34;    // takes half a minute on one processor core
    constexpr double steps_of_drawing = 256; // also limits memory: 1.6 GB for the 2^26 points that remain at most
    const double columns = std::ceil(width / pitch) + 1, rows = std::ceil(height / pitch) + 1;
    const double points = columns * rows, taps = 12 * deviation / pitch;
    if (!(points * (steps_of_drawing + taps) > most_steps)) {
        return;
    }
    // The suggested pitch lets either part take half of the steps.
    const double area = width * height;
    const double least = std::max(std::cbrt(2 * 12 * deviation * area / most_steps),
                                  std::sqrt(2 * steps_of_drawing * area / most_steps));
    throw InputError(
        {where, "specimen." + key, fmt::format("{:.6g}", pitch * um_per_mm),
         fmt::format("a pitch that makes fewer points than {:.6g} x {:.6g}, each a mean over {:.3g} others", columns,
                     rows, 2 * taps),
         fmt::format("Choose {} >= {:.3g}, or a smaller specimen.", key, least * um_per_mm)});
}

} // namespace vkfv::specimen
