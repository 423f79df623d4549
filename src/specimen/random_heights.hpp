// Random heights: white noise, and what a filter leaves of it.
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

// A normal random field with the autocorrelation exp(-(r/l)^2), of mean 0, periodic over its grid.
struct RandomHeights {
    double sq = 0;                 // root mean square height, mm, which is met exactly
    double correlation_length = 0; // l, mm
    std::uint32_t seed = 0;

    bool operator==(const RandomHeights&) const = default;
};

// White noise on the field's grid, filtered by a Gaussian of standard deviation l / 2, its mean removed and scaled.
// size: side of the specimen, mm. Throws InputError for values that do not fit.
void add_random_heights(HeightField& field, const RandomHeights& random, double size, const SourceLocation& where);

// Keys of a kind that has random heights besides its own sq_um, and their values.
std::vector<const Key*> random_heights_keys(const NumberKey& sq);
RandomHeights read_random_heights(const Section& section, double sq, double pitch);

const Key& seed_key();
std::uint32_t read_seed(const Section& section);

// White Gaussian noise of unit standard deviation, filtered by a Gaussian of standard deviation `kernel` (in
// points; 0: not at all) whose weights have the sum 1; periodic. Bits depend on std::mt19937_64 and the C
// library's log, sin and cos alone.
Grid<double> filtered_noise(int columns, int rows, double kernel, std::uint32_t seed);

void subtract_mean(Grid<double>& grid);
double root_mean_square(const Grid<double>& grid);

// Throws InputError for a grid over a rectangle (mm) whose points a filter of this standard deviation (mm) would go
// over for too long. key: of the pitch, in [specimen].
void check_work_of_noise(double width, double height, double pitch, double deviation, const SourceLocation& where,
                         const std::string& key);

} // namespace vkfv::specimen
