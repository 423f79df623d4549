#include "core/mathematics/fourier.hpp"

#include "core/threads/parallel_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <vector>

namespace vkfv {
namespace {

using Complex = std::complex<double>;

// Distributes `count` lines among threads: task(first, end, fft), where fft holds the twiddle factors of its thread.
template <class Task>
void share_lines(int count, std::size_t values, const Task& task) {
    // Starting a thread takes tens of microseconds, as does transforming this many values.
    constexpr std::size_t values_a_thread = std::size_t{1} << 14;
    const auto threads = std::clamp<std::size_t>(values / values_a_thread, 1, static_cast<std::size_t>(core_count()));
    parallel_shares(count, static_cast<int>(threads), [&](int first, int end) {
        LineTransform fft;
        task(first, end, fft);
    });
}

// The number of lines copied together, as neighbouring columns share cache lines.
constexpr int lines_at_once = 8;

// Calls task(line, fft) on copies of `count` lines of `length` values, in buffers of `padded` values with zeros behind
// them, and copies the first `length` values back. Value k of line n is at values[n * line_step + k * value_step].
template <class Task>
void over_lines(std::vector<Complex>& values, int count, std::size_t line_step, int length, std::size_t value_step,
                int padded, const Task& task) {
    share_lines(count, values.size(), [&](int first, int end, LineTransform& fft) {
        const auto n = static_cast<std::size_t>(length), size = static_cast<std::size_t>(padded);
        std::vector<Complex> lines(size * lines_at_once);
        for (int start = first; start < end; start += lines_at_once) {
            const auto some = static_cast<std::size_t>(std::min(lines_at_once, end - start));
            Complex* const begin = values.data() + static_cast<std::size_t>(start) * line_step;
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t line = 0; line < some; ++line)
                    lines[line * size + k] = begin[line * line_step + k * value_step];
            for (std::size_t line = 0; line < some; ++line) {
                std::fill_n(lines.begin() + static_cast<std::ptrdiff_t>(line * size + n), size - n, Complex());
                task(lines.data() + line * size, fft);
            }
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t line = 0; line < some; ++line)
                    begin[line * line_step + k * value_step] = lines[line * size + k];
        }
    });
}

// Transforms lines; the arguments are those of over_lines().
void transform_lines(std::vector<Complex>& values, int count, std::size_t line_step, int length, std::size_t value_step,
                     bool inverse) {
    if (length == 1)
        return; // a single value is its own transform; LineTransform needs two or more
    over_lines(values, count, line_step, length, value_step, length, [&](Complex* line, LineTransform& fft) {
        thread_local std::vector<Complex> transformed;
        transformed.resize(static_cast<std::size_t>(length));
        if (inverse)
            fft.inverse(transformed.data(), line, length);
        else
            fft.forward(transformed.data(), line, length);
        std::ranges::copy(transformed, line);
    });
}

// Convolves lines with symmetric weights; the arguments are those of over_lines().
void convolve_lines(std::vector<Complex>& values, int count, std::size_t line_step, int length, std::size_t value_step,
                    const std::vector<double>& weights) {
    const int reach = static_cast<int>(weights.size()) - 1;
    const int padded = std::max(2, convenient_length(length + reach)); // prevents wrapping
    const auto size = static_cast<std::size_t>(padded);
    std::vector<Complex> kernel(size), spectrum(size);
    for (std::size_t k = 0; k < weights.size(); ++k)
        kernel[k] = kernel[(size - k) % size] = weights[k];
    LineTransform own;
    own.forward(spectrum.data(), kernel.data(), padded);
    std::vector<double> gain(size); // real, as the weights are symmetric
    for (std::size_t k = 0; k < size; ++k)
        gain[k] = spectrum[k].real() / padded;
    over_lines(values, count, line_step, length, value_step, padded, [&](Complex* line, LineTransform& fft) {
        thread_local std::vector<Complex> transformed;
        transformed.resize(size);
        fft.forward(transformed.data(), line, padded);
        for (std::size_t k = 0; k < size; ++k)
            transformed[k] *= gain[k];
        fft.inverse(line, transformed.data(), padded);
    });
}

void transform_grid(Grid<Complex>& grid, bool inverse) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    transform_lines(grid.values, grid.rows, columns, grid.columns, 1, inverse);
    transform_lines(grid.values, grid.columns, 1, grid.rows, columns, inverse);
}

// The cosine transform of lines; the arguments are those of transform_lines(). Two real lines form one complex one.
void cosine_lines(std::vector<double>& values, int count, std::size_t line_step, int length, std::size_t value_step,
                  bool inverse) {
    if (length == 1)
        return;
    const auto n = static_cast<std::size_t>(length);
    std::vector<Complex> turns(n); // exp(-i pi k / (2 n))
    for (std::size_t k = 0; k < n; ++k)
        turns[k] = std::polar(1.0, -std::numbers::pi * static_cast<double>(k) / (2.0 * length));
    // Values of even index come first in ascending order, those of odd index follow in descending order.
    const auto place = [n](std::size_t k) { return k % 2 == 0 ? k / 2 : n - 1 - k / 2; };
    share_lines((count + 1) / 2, values.size(), [&](int first, int end, LineTransform& fft) {
        std::vector<Complex> line(n), transformed(n);
        for (int pair = first; pair < end; ++pair) {
            double* const a = values.data() + static_cast<std::size_t>(2 * pair) * line_step;
            double* const b = 2 * pair + 1 < count ? a + line_step : nullptr;
            if (!inverse) {
                for (std::size_t k = 0; k < n; ++k)
                    line[place(k)] = {a[k * value_step], b ? b[k * value_step] : 0};
                fft.forward(transformed.data(), line.data(), length);
                for (std::size_t k = 0; k < n; ++k) {
                    const Complex at = transformed[k], mirrored = std::conj(transformed[(n - k) % n]);
                    a[k * value_step] = (turns[k] * (at + mirrored)).real() / 2;
                    if (b)
                        b[k * value_step] = (turns[k] * (at - mirrored)).imag() / 2;
                }
            } else {
                // V[k] = exp(i pi k / 2n) (X[k] - i X[n - k]), with X[n] = 0; the line is V of `a` plus i times V of
                // `b`.
                for (std::size_t k = 0; k < n; ++k) {
                    const auto value = [&](const double* x) {
                        return std::conj(turns[k]) * Complex(x[k * value_step], k == 0 ? 0 : -x[(n - k) * value_step]);
                    };
                    line[k] = value(a) + (b ? Complex(0, 1) * value(b) : 0);
                }
                fft.inverse(transformed.data(), line.data(), length);
                for (std::size_t k = 0; k < n; ++k) {
                    const Complex at = transformed[place(k)] / static_cast<double>(length);
                    a[k * value_step] = at.real();
                    if (b)
                        b[k * value_step] = at.imag();
                }
            }
        }
    });
}

void cosine_grid(Grid<double>& grid, bool inverse) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    cosine_lines(grid.values, grid.rows, columns, grid.columns, 1, inverse);
    cosine_lines(grid.values, grid.columns, 1, grid.rows, columns, inverse);
}

} // namespace

void fourier_transform(Grid<Complex>& grid) {
    transform_grid(grid, false);
}

void inverse_fourier_transform(Grid<Complex>& grid) {
    transform_grid(grid, true);
    const double factor = 1.0 / static_cast<double>(grid.values.size());
    for (Complex& value : grid.values)
        value *= factor;
}

void convolve(Grid<Complex>& grid, const std::vector<double>& along_x, const std::vector<double>& along_y) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    convolve_lines(grid.values, grid.rows, columns, grid.columns, 1, along_x);
    convolve_lines(grid.values, grid.columns, 1, grid.rows, columns, along_y);
}

void cosine_transform(Grid<double>& grid) {
    cosine_grid(grid, false);
}

void inverse_cosine_transform(Grid<double>& grid) {
    cosine_grid(grid, true);
}

} // namespace vkfv
