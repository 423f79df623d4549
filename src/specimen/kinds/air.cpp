#include "specimen/kinds/air.hpp"

#include "core/keys/section.hpp"
#include "core/mathematics/fourier.hpp"
#include "specimen/kinds/surface_file.hpp"
#include "specimen/random_heights.hpp"
#include "specimen/refined.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace vkfv::specimen {
namespace {

constexpr int most_points_of_spectrum = 8192; // along a side: 1 GiB of complex numbers

const IntegerKey tiles_key("tiles", 1, 64, 4, "Sub-surfaces along each side.");
const NumberKey tile_size_key =
    for_example("0.1", NumberKey("tile_size_mm", NumberRange::positive(), needed, "Side of a sub-surface."));
const NumberKey air_sq_key =
    for_example("1.0", NumberKey("sq_um", NumberRange::at_least(0), needed,
                                 "Root mean square height of each sub-surface; not with a file."));
const NumberKey roll_off_key =
    for_example("50.0", NumberKey("roll_off_wavelength_um", NumberRange::positive(), needed,
                                  "Above it the power spectrum is constant; not with a file."));
const NumberKey shortest_key =
    for_example("10.0", NumberKey("shortest_wavelength_um", NumberRange::positive(), needed,
                                  "Below it there is nothing; at least two pitches, not with a file."));
const NumberKey hurst_key =
    for_example("0.8", NumberKey("hurst_exponent", NumberRange::within(0, 1), needed,
                                 "H: between the two wavelengths the power falls with the frequency as f^(-2 (1 + H)); "
                                 "not with a file."));
const FileKey air_file_key("file", Default::in_words("none: the sub-surfaces are random"),
                           "A measured surface, whose middle each of the sub-surfaces repeats.");

// The power spectral density relative to its constant part; 0 at the frequency 0, as the mean is 0.
double relative_power(const Air& d, double frequency) {
    if (frequency == 0 || frequency * d.shortest > 1 + 1e-9)
        return 0;
    return std::pow(std::max(1.0, frequency * d.roll_off), -2 * (1 + d.hurst));
}

HeightField generated(const Air& d, int points, double pitch, std::uint32_t seed) {
    const Grid<double> noise = filtered_noise(points, points, 0, seed);
    Grid<std::complex<double>> spectrum(points, points);
    std::copy(noise.values.begin(), noise.values.end(), spectrum.values.begin());
    fourier_transform(spectrum);
    for (int m = 0; m < points; ++m)
        for (int l = 0; l < points; ++l)
            spectrum(l, m) *= std::sqrt(
                relative_power(d, std::hypot(fourier_frequency(l, points), fourier_frequency(m, points)) / pitch));
    inverse_fourier_transform(spectrum);
    Grid<double> surface(points, points);
    std::transform(spectrum.values.begin(), spectrum.values.end(), surface.values.begin(),
                   [](const std::complex<double>& value) { return value.real(); });
    const double square = std::inner_product(surface.values.begin(), surface.values.end(), surface.values.begin(), 0.0);
    const double scale = d.sq / std::sqrt(square / static_cast<double>(surface.values.size()));
    HeightField field{.heights = Grid<float>(points, points)};
    std::transform(surface.values.begin(), surface.values.end(), field.heights.values.begin(),
                   [scale](double height) { return static_cast<float>(scale * height); });
    return field;
}

HeightField measured(const Air& d, int points, double pitch, const SourceLocation& where) {
    const HeightField surface = SurfaceFile{.file = d.file}.heights(where); // the whole surface, levelled
    const double side = (points - 1) * pitch, tolerance = 1e-9 * side;
    if (surface.x_max() - surface.x_min < side - tolerance || surface.y_max() - surface.y_min < side - tolerance)
        throw InputError({where, "specimen.tile_size_mm", fmt::format("{}", d.size / d.tiles),
                          fmt::format("at most the surface's {:.6g} x {:.6g} mm", surface.x_max() - surface.x_min,
                                      surface.y_max() - surface.y_min),
                          "Choose a smaller sub-surface or a larger file."});
    HeightField field = on_grid(surface, -0.5 * side, -0.5 * side, points, points, pitch);
    double sum = 0;
    for (const float height : field.heights.values)
        sum += static_cast<double>(height);
    const double mean = sum / static_cast<double>(field.heights.values.size());
    for (float& height : field.heights.values)
        height = static_cast<float>(static_cast<double>(height) - mean);
    return field;
}

// The number of points along a sub-surface.
int points_of(const Air& d, const HeightField& field, double pitch, const SourceLocation& where) {
    const auto check = [&](bool condition, const char* key, double found, const std::string& expected) {
        if (!condition)
            throw InputError({where, fmt::format("specimen.{}", key), fmt::format("{:.6g}", found * um_per_mm),
                              expected, "Correct the value in the configuration."});
    };
    const int points = (field.heights.columns - 1) / d.tiles;
    check(points * d.tiles == field.heights.columns - 1, "pitch_um", pitch,
          fmt::format("a length that divides the sub-surface's {} um", d.size / d.tiles * um_per_mm));
    if (d.file.empty()) {
        check(d.shortest >= 2 * field.pitch_x * (1 - 1e-9), "shortest_wavelength_um", d.shortest,
              fmt::format("at least two pitches, {} um", 2 * field.pitch_x * um_per_mm));
        check(d.shortest <= d.roll_off, "shortest_wavelength_um", d.shortest,
              fmt::format("at most the roll-off wavelength, {} um", d.roll_off * um_per_mm));
        check(d.roll_off <= d.size / d.tiles * (1 + 1e-9), "roll_off_wavelength_um", d.roll_off,
              fmt::format("at most the sub-surface's {} um", d.size / d.tiles * um_per_mm));
        check(
            points <= most_points_of_spectrum, "pitch_um", pitch,
            fmt::format("at most {} points along a sub-surface, so that its spectrum fits into memory; for its {} um a "
                        "pitch of {:.3g}",
                        most_points_of_spectrum, d.size / d.tiles * um_per_mm,
                        d.size / d.tiles / most_points_of_spectrum * um_per_mm));
    }
    return points;
}

} // namespace

std::vector<const Key*> Air::keys() {
    return {&tiles_key,    &tile_size_key, &square_pitch_key(), &air_sq_key,  &seed_key(),
            &roll_off_key, &shortest_key,  &hurst_key,          &air_file_key};
}

Air Air::read(const Section& section) {
    Air air;
    air.tiles = static_cast<int>(section.integer(tiles_key));
    air.size = air.tiles * section.number(tile_size_key);
    air.pitch = read_square_pitch(section);
    if (section.has(air_file_key)) {
        for (const Key* key :
             std::initializer_list<const Key*>{&air_sq_key, &seed_key(), &roll_off_key, &shortest_key, &hurst_key}) {
            if (section.has(*key)) {
                section.note(*key, "no such key with a file of a measured surface",
                             "Remove it, or remove file for sub-surfaces from a power spectrum.");
            }
        }
        air.file = section.file(air_file_key);
        return air;
    }
    air.sq = from_um(section.number(air_sq_key));
    air.seed = read_seed(section);
    air.roll_off = from_um(section.number(roll_off_key));
    air.shortest = from_um(section.number(shortest_key));
    air.hurst = section.number(hurst_key);
    return air;
}

void Air::raise(HeightField& field, double asked_pitch, const SourceLocation& where) const {
    const int points = points_of(*this, field, asked_pitch, where);
    std::optional<HeightField> repeated;
    if (!file.empty())
        repeated = measured(*this, points, field.pitch_x, where);
    if (repeated && !repeated->interpolated.empty())
        field.interpolated.assign(field.heights.values.size(), false);
    for (int tile_row = 0; tile_row < tiles; ++tile_row)
        for (int tile_column = 0; tile_column < tiles; ++tile_column) {
            // The multiplier keeps seeds of sub-surfaces distinct between neighbouring seeds.
            const auto number = static_cast<std::uint32_t>(tile_row * tiles + tile_column);
            const HeightField tile =
                repeated ? *repeated : generated(*this, points, field.pitch_x, seed * 0x9e3779b1u + number);
            // The last row and column of the footprint repeat the first ones of their sub-surface.
            const auto end = [&](int at) { return at + 1 == tiles ? points + 1 : points; };
            for (int row = 0; row < end(tile_row); ++row)
                for (int column = 0; column < end(tile_column); ++column) {
                    const std::size_t to = field.heights.index(tile_column * points + column, tile_row * points + row);
                    const std::size_t from = tile.heights.index(column % points, row % points);
                    field.heights.values[to] = tile.heights.values[from];
                    if (!tile.interpolated.empty())
                        field.interpolated[to] = tile.interpolated[from];
                }
        }
}

} // namespace vkfv::specimen
