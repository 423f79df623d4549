// Random heights from filtered white noise.
#pragma once

#include "specimen/lengths.hpp"
#include "specimen/specimen.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace vkfv {
class Key;
class NumberKey;
class Section;
} // namespace vkfv

namespace vkfv::specimen {

// A normal random field with the autocorrelation exp(-(r/l)^2) and mean 0, periodic over its grid.
struct RandomHeights {
    double sq = 0;                 // mm, root mean square height, met exactly
    double correlation_length = 0; // mm, l of the autocorrelation
    std::uint32_t seed = 0;

    bool operator==(const RandomHeights&) const = default;
};

// Adds white noise on the field's grid, filtered by a Gaussian of standard deviation l / 2, with its mean removed and
// scaled to sq. size: side of the specimen, mm. Throws InputError for invalid values.
void add_random_heights(HeightField& field, const RandomHeights& random, double size, const SourceLocation& where);

// The keys of a kind with random heights, whose sq_um is its own key, and their values.
std::vector<const Key*> random_heights_keys(const NumberKey& sq);
RandomHeights read_random_heights(const Section& section, double sq, double pitch);

const Key& seed_key();
std::uint32_t read_seed(const Section& section);

// White Gaussian noise of unit standard deviation, filtered by a periodic Gaussian of standard deviation `kernel` (in
// points; 0: no filter) whose weights sum to 1. Its bits depend only on std::mt19937_64 and the C library's log, sin
// and cos.
Grid<double> filtered_noise(int columns, int rows, double kernel, std::uint32_t seed);

void subtract_mean(Grid<double>& grid);
double root_mean_square(const Grid<double>& grid);

// Throws InputError if noise on a grid over a rectangle (mm), filtered with this standard deviation (mm), would take
// too long. key: the pitch's key in [specimen].
void check_work_of_noise(double width, double height, double pitch, double deviation, const SourceLocation& where,
                         const std::string& key);

} // namespace vkfv::specimen
