#include "core/fourier.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace vkfv {
namespace {

using Complex = std::complex<double>;

// Transforms lines of `length` values, `count` of them, a thread's share at a time; value k of line n is at
// values[n * line_step + k * value_step].
void transform_lines(std::vector<Complex>& values, int count, std::size_t line_step, int length, std::size_t value_step,
                     bool inverse) {
    if (length == 1)
        return; // is its own transform; Eigen's takes none so short
    const auto transform = [&](int first, int end) {
        Eigen::FFT<double> fft; // holds the twiddle factors: not for several threads
        fft.SetFlag(Eigen::FFT<double>::Unscaled);
        std::vector<Complex> line(static_cast<std::size_t>(length)), transformed(line.size());
        for (int n = first; n < end; ++n) {
            Complex* const begin = values.data() + static_cast<std::size_t>(n) * line_step;
            for (std::size_t k = 0; k < line.size(); ++k)
                line[k] = begin[k * value_step];
            if (inverse)
                fft.inv(transformed.data(), line.data(), length);
            else
                fft.fwd(transformed.data(), line.data(), length);
            for (std::size_t k = 0; k < line.size(); ++k)
                begin[k * value_step] = transformed[k];
        }
    };
    // Starting a thread takes tens of microseconds, as does transforming this many values.
    constexpr std::size_t values_a_thread = std::size_t{1} << 14;
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    const int threads = static_cast<int>(std::clamp<std::size_t>(values.size() / values_a_thread, 1, cores));
    const int share = (count + threads - 1) / threads;
    std::vector<std::jthread> others;
    for (int first = share; first < count; first += share)
        others.emplace_back([&, first] { transform(first, std::min(count, first + share)); });
    transform(0, std::min(share, count));
}

void transform_grid(Grid<Complex>& grid, bool inverse) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    transform_lines(grid.values, grid.rows, columns, grid.columns, 1, inverse);
    transform_lines(grid.values, grid.columns, 1, grid.rows, columns, inverse);
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

int convenient_length(int least) {
    for (int length = std::max(1, least);; ++length) {
        int rest = length;
        for (const int factor : {2, 3, 5})
            while (rest % factor == 0)
                rest /= factor;
        if (rest == 1)
            return length;
    }
}

} // namespace vkfv
