#include "core/mathematics/line_transform.hpp"

#include "core/mathematics/complex_product.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cstddef>
#include <map>
#include <numbers>
#include <vector>

namespace vkfv {
namespace {

using Complex = std::complex<double>;

// The largest prime factor that KISS FFT transforms faster than a convolution does.
constexpr int largest_direct_factor = 13;

int largest_prime_factor(int number) {
    int largest = 1;
    for (int factor = 2; factor * factor <= number; ++factor) {
        for (; number % factor == 0; number /= factor) {
            largest = factor;
        }
    }
    return std::max(largest, number);
}

} // namespace

struct LineTransform::State {
    // By k n = (k² + n² - (k - n)²) / 2 the sums are a convolution of the values times turns[n] with the turns'
    // conjugates, times turns[k].
    struct Convolution {
        std::vector<Complex> turns;    // exp(-pi i n² / length)
        std::vector<Complex> response; // transform of the turns' conjugates, continued to both sides, over its length
        std::vector<Complex> line;
        std::vector<Complex> spectrum;
    };

    Eigen::FFT<double> fft;
    std::map<int, Convolution> convolutions; // by length

    Convolution make_convolution(int length);
    void convolve(Complex* to, const Complex* from, int length, bool inverse);
};

LineTransform::State::Convolution LineTransform::State::make_convolution(int length) {
    const auto n = static_cast<std::size_t>(length);
    const int padded = convenient_length(2 * length - 1);
    const auto size = static_cast<std::size_t>(padded);
    Convolution made{.turns = std::vector<Complex>(n),
                     .response = std::vector<Complex>(size),
                     .line = std::vector<Complex>(size),
                     .spectrum = std::vector<Complex>(size)};
    for (std::size_t k = 0; k < n; ++k) {
        // Whole periods are taken off the phase as integers, before it is rounded.
        made.turns[k] = std::polar(1.0, -std::numbers::pi * static_cast<double>(k * k % (2 * n)) / length);
        made.line[k] = made.line[(size - k) % size] = std::conj(made.turns[k]);
    }
    fft.fwd(made.response.data(), made.line.data(), padded);
    for (Complex& value : made.response) {
        value /= padded;
    }
    return made;
}

void LineTransform::State::convolve(Complex* to, const Complex* from, int length, bool inverse) {
    auto found = convolutions.find(length);
    if (found == convolutions.end()) {
        found = convolutions.emplace(length, make_convolution(length)).first;
    }
    auto& [turns, response, line, spectrum] = found->second;
    const auto n = static_cast<std::size_t>(length);
    const auto padded = static_cast<int>(line.size());
    // The inverse is the conjugate of the conjugates' transform.
    const auto value = [inverse](const Complex& number) { return inverse ? std::conj(number) : number; };
    for (std::size_t k = 0; k < n; ++k) {
        line[k] = product(value(from[k]), turns[k]);
    }
    std::fill(line.begin() + static_cast<std::ptrdiff_t>(n), line.end(), Complex());
    fft.fwd(spectrum.data(), line.data(), padded);
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
        spectrum[k] = product(spectrum[k], response[k]);
    }
    fft.inv(line.data(), spectrum.data(), padded);
    for (std::size_t k = 0; k < n; ++k) {
        to[k] = value(product(line[k], turns[k]));
    }
}

LineTransform::LineTransform() : state_(std::make_unique<State>()) {
    state_->fft.SetFlag(Eigen::FFT<double>::Unscaled);
}
LineTransform::~LineTransform() = default;

void LineTransform::forward(Complex* to, const Complex* from, int length) {
    if (largest_prime_factor(length) > largest_direct_factor) {
        state_->convolve(to, from, length, false);
    } else {
        state_->fft.fwd(to, from, length);
    }
}
void LineTransform::inverse(Complex* to, const Complex* from, int length) {
    if (largest_prime_factor(length) > largest_direct_factor) {
        state_->convolve(to, from, length, true);
    } else {
        state_->fft.inv(to, from, length);
    }
}

int convenient_length(int least) {
    for (int length = std::max(1, least);; ++length) {
        int rest = length;
        for (const int factor : {2, 3, 5}) {
            while (rest % factor == 0) {
                rest /= factor;
            }
        }
        if (rest == 1) {
            return length;
        }
    }
}

} // namespace vkfv
