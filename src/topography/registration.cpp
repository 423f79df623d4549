#include "topography/registration.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "core/threads/parallel_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>

namespace vkfv::topography {
namespace {

using Spectrum = Grid<std::complex<double>>;

struct Part {
    int column = 0;
    int row = 0;
    int columns = 0;
    int rows = 0;
};

struct Shift {
    double x = 0;
    double y = 0;
    double certainty = 0; // at most 1
};

// Weights of four neighbours at a fraction of their middle interval.
std::array<double, 4> cubic_weights(double t) {
    return {((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1, ((-1.5 * t + 2) * t + 0.5) * t,
            (0.5 * t - 0.5) * t * t};
}

// The cut-out of the image at the part's place plus the shift, interpolated between pixels by cubic convolution. Beyond
// the image its border is repeated.
Grid<double> cut_out(const Grid<float>& image, const Part& part, const Shift& from) {
    const double left = std::floor(from.x), top = std::floor(from.y);
    const auto along_x = cubic_weights(from.x - left), along_y = cubic_weights(from.y - top);
    const int first_column = part.column + static_cast<int>(left) - 1, first_row = part.row + static_cast<int>(top) - 1;
    const auto pixel = [&](int column, int row) -> double {
        return image(std::clamp(column, 0, image.columns - 1), std::clamp(row, 0, image.rows - 1));
    };
    Grid<double> between_columns(part.columns, part.rows + 3);
    for (int row = 0; row < between_columns.rows; ++row) {
        for (int column = 0; column < part.columns; ++column) {
            for (int i = 0; i < 4; ++i) {
                between_columns(column, row) +=
                    along_x[static_cast<std::size_t>(i)] * pixel(first_column + column + i, first_row + row);
            }
        }
    }
    Grid<double> result(part.columns, part.rows);
    for (int row = 0; row < part.rows; ++row) {
        for (int column = 0; column < part.columns; ++column) {
            for (int i = 0; i < 4; ++i) {
                result(column, row) += along_y[static_cast<std::size_t>(i)] * between_columns(column, row + i);
            }
        }
    }
    return result;
}

// The spectrum of the part minus its mean. The part fades to zero at its edges, which would otherwise agree wherever
// the images differ.
Spectrum windowed_spectrum(const Grid<float>& image, const Part& part, const Shift& from) {
    const Grid<double> values = cut_out(image, part, from);
    const double mean = std::accumulate(values.values.begin(), values.values.end(), 0.0) /
                        (static_cast<double>(part.columns) * part.rows);
    const auto hann = [](int k, int count) { return 0.5 - 0.5 * std::cos(2 * pi * (k + 0.5) / count); };
    Spectrum spectrum(part.columns, part.rows);
    for (int row = 0; row < part.rows; ++row) {
        for (int column = 0; column < part.columns; ++column) {
            spectrum(column, row) = (values(column, row) - mean) * hann(column, part.columns) * hann(row, part.rows);
        }
    }
    fourier_transform(spectrum);
    return spectrum;
}

// The cross-spectrum of the reference's part and the other image's, which begins at `from`: phases differ by -2 pi (f,
// shift). Frequencies count by their power in both: where the images have little power, noise and the fading edges
// would decide.
Spectrum cross_spectrum(const Spectrum& reference, const Grid<float>& image, const Part& part, const Shift& from) {
    Spectrum cross = reference;
    const Spectrum other = windowed_spectrum(image, part, from);
    double mean = 0;
    for (std::size_t k = 0; k < cross.values.size(); ++k) {
        cross.values[k] = std::conj(cross.values[k]) * other.values[k];
        mean += std::abs(cross.values[k]) / static_cast<double>(cross.values.size());
    }
    // Fine waves are out of focus in one image or the other, and noise affects both.
    constexpr double finest = 0.15; // cycles a pixel
    for (int row = 0; row < part.rows; ++row) {
        for (int column = 0; column < part.columns; ++column) {
            const double frequency =
                std::hypot(fourier_frequency(column, part.columns), fourier_frequency(row, part.rows));
            auto& value = cross(column, row);
            value *= std::exp(-0.5 * (frequency / finest) * (frequency / finest)) / (std::abs(value) + mean);
        }
    }
    return cross;
}

// The remaining shift of less than a pixel, from the plane through the phases.
Shift slope_of_phases(const Spectrum& cross) {
    double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
    for (int row = 0; row < cross.rows; ++row) {
        for (int column = 0; column < cross.columns; ++column) {
            const double along_x = fourier_frequency(column, cross.columns);
            const double along_y = fourier_frequency(row, cross.rows);
            const auto value = cross(column, row);
            const double weight = std::abs(value), turns = -std::arg(value) / (2 * pi);
            xx += weight * along_x * along_x;
            xy += weight * along_x * along_y;
            yy += weight * along_y * along_y;
            x += weight * along_x * turns;
            y += weight * along_y * turns;
        }
    }
    const double determinant = xx * yy - xy * xy;
    return determinant > 0 ? Shift{.x = (yy * x - xy * y) / determinant, .y = (xx * y - xy * x) / determinant}
                           : Shift{};
}

// The shift to whole pixels, by the highest correlation; its certainty is this correlation over that of identical
// images.
Shift whole_shift(Spectrum cross) {
    double total = 0;
    for (const auto& value : cross.values) {
        total += std::abs(value);
    }
    inverse_fourier_transform(cross);
    const int reach_x = cross.columns / 4, reach_y = cross.rows / 4;
    Shift best{.certainty = -1};
    for (int y = -reach_y; y <= reach_y; ++y) {
        for (int x = -reach_x; x <= reach_x; ++x) {
            const double here = cross((x + cross.columns) % cross.columns, (y + cross.rows) % cross.rows).real();
            if (here > best.certainty) {
                best = {.x = static_cast<double>(x), .y = static_cast<double>(y), .certainty = here};
            }
        }
    }
    const double whole = total / static_cast<double>(cross.values.size());
    best.certainty = whole > 0 ? std::max(0.0, best.certainty / whole) : 0;
    return best;
}

// The first pass compares the same place in both images; each later one compares the places found so far, so that both
// show the same in the end. The plane through the phases underestimates the rest of a shift, because noise has no slope
// and the fading edges do not move; the next pass finds the remainder.
Shift shift_of(const Grid<float>& reference, const Grid<float>& image, const Part& part) {
    constexpr int most_passes = 6;
    constexpr double settled = 0.01; // pixel
    const Spectrum here = windowed_spectrum(reference, part, {});
    Shift found;
    for (int pass = 0; pass < most_passes; ++pass) {
        const Spectrum cross = cross_spectrum(here, image, part, found);
        Shift rest = whole_shift(cross);
        found.certainty = rest.certainty;
        if (rest.x == 0 && rest.y == 0) {
            rest = slope_of_phases(cross);
        }
        found.x += rest.x;
        found.y += rest.y;
        if (std::hypot(rest.x, rest.y) < settled) {
            break;
        }
    }
    return found;
}

// The part in the middle, at most 1024 pixels a side: enough for a hundredth of a pixel.
Part middle_part(int columns, int rows) {
    constexpr int most = 1024;
    Part part{.column = 0, .row = 0, .columns = std::min(columns, most), .rows = std::min(rows, most)};
    part.column = (columns - part.columns) / 2;
    part.row = (rows - part.rows) / 2;
    return part;
}

} // namespace

ImageTransform ImageTransform::then(const ImageTransform& next) const {
    return {.shift_x = next.scale * shift_x + next.shift_x,
            .shift_y = next.scale * shift_y + next.shift_y,
            .scale = scale * next.scale};
}

ImageTransform ImageTransform::inverse() const {
    return {.shift_x = -shift_x / scale, .shift_y = -shift_y / scale, .scale = 1 / scale};
}

ImageTransform registered(const Grid<float>& reference, const Grid<float>& image, Registration what) {
    const int columns = image.columns, rows = image.rows;
    if (what == Registration::none) {
        return {};
    }
    if (what == Registration::shift) {
        const Shift shift = shift_of(reference, image, middle_part(columns, rows));
        return {.shift_x = shift.x, .shift_y = shift.y};
    }
    return measured_transform(reference, image).transform;
}

MeasuredTransform measured_transform(const Grid<float>& reference, const Grid<float>& image) {
    const int columns = image.columns, rows = image.rows;
    struct PartShift {
        Shift shift;
        double from_x;
        double from_y;
    };
    std::vector<PartShift> parts;
    // Weighted least squares of shift + (scale - 1) (point - middle) through the parts' shifts.
    double weight = 0, x = 0, y = 0, at_x = 0, at_y = 0, squares = 0, products = 0;
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            const Part part{.column = i * columns / 4, .row = j * rows / 4, .columns = columns / 2, .rows = rows / 2};
            const Shift shift = shift_of(reference, image, part);
            const double from_x = part.column + 0.5 * (part.columns - columns);
            const double from_y = part.row + 0.5 * (part.rows - rows);
            parts.push_back({shift, from_x, from_y});
            weight += shift.certainty;
            x += shift.certainty * shift.x;
            y += shift.certainty * shift.y;
            at_x += shift.certainty * from_x;
            at_y += shift.certainty * from_y;
            squares += shift.certainty * (from_x * from_x + from_y * from_y);
            products += shift.certainty * (from_x * shift.x + from_y * shift.y);
        }
    }
    if (!(weight > 0)) {
        return {};
    }
    const double spread = squares - (at_x * at_x + at_y * at_y) / weight;
    const double slope = spread > 0 ? (products - (at_x * x + at_y * y) / weight) / spread : 0;
    const ImageTransform transform{
        .shift_x = (x - slope * at_x) / weight, .shift_y = (y - slope * at_y) / weight, .scale = 1 + slope};
    double residual = 0;
    for (const auto& [shift, from_x, from_y] : parts) {
        const double off_x = shift.x - transform.shift_x - slope * from_x;
        const double off_y = shift.y - transform.shift_y - slope * from_y;
        residual += shift.certainty * (off_x * off_x + off_y * off_y);
    }
    // Four of the nine parts, of half the side each, do not overlap: they give eight independent shifts, and three
    // values are fitted to these.
    constexpr double independent = 4, free_values = 5;
    const double variance = residual / weight * independent / free_values; // for either component of a shift
    return {.transform = transform,
            .shift_deviation = std::sqrt(variance / independent),
            .scale_deviation = spread > 0 ? std::sqrt(variance / independent * weight / spread) : 0};
}

std::vector<ImageTransform> in_common_frame(std::span<const ImageTransform> from_neighbour) {
    std::vector<ImageTransform> from_first;
    for (const ImageTransform& step : from_neighbour) {
        from_first.push_back(from_first.empty() ? ImageTransform{} : from_first.back().then(step));
    }
    if (from_first.empty()) {
        return from_first;
    }
    const ImageTransform to_first = from_first[from_first.size() / 2].inverse();
    for (ImageTransform& transform : from_first) {
        transform = to_first.then(transform);
    }
    return from_first;
}

Channels resampled(const Channels& image, const ImageTransform& transform) {
    Channels result;
    for (const Grid<float>& channel : image) {
        Grid<float>& target = result.emplace_back(channel.columns, channel.rows);
        const double middle_x = 0.5 * (channel.columns - 1), middle_y = 0.5 * (channel.rows - 1);
        const auto value = [&](int column, int row) {
            return channel(std::clamp(column, 0, channel.columns - 1), std::clamp(row, 0, channel.rows - 1));
        };
        parallel_rows(channel.columns, channel.rows, [&](int first, int end) {
            for (int row = first; row < end; ++row) {
                const double y = middle_y + transform.scale * (row - middle_y) + transform.shift_y;
                const int below = static_cast<int>(std::floor(y));
                const auto along_y = cubic_weights(y - below);
                for (int column = 0; column < channel.columns; ++column) {
                    const double x = middle_x + transform.scale * (column - middle_x) + transform.shift_x;
                    const int left = static_cast<int>(std::floor(x));
                    const auto along_x = cubic_weights(x - left);
                    double sum = 0;
                    for (int j = 0; j < 4; ++j) {
                        for (int i = 0; i < 4; ++i) {
                            sum += along_y[static_cast<std::size_t>(j)] * along_x[static_cast<std::size_t>(i)] *
                                   value(left - 1 + i, below - 1 + j);
                        }
                    }
                    target(column, row) = static_cast<float>(sum);
                }
            }
        });
    }
    return result;
}

} // namespace vkfv::topography
