// The discrete Fourier transform of one line of any length, by Eigen's port of KISS FFT.
#pragma once

#include <complex>
#include <memory>

namespace vkfv {

// Transforms of lines. KISS FFT takes length times p operations for a prime factor p of the length; where the largest p
// exceeds 13, the transform is therefore made as a convolution by transforms of a longer convenient length (L.
// Bluestein, "A linear filtering approach to the computation of discrete Fourier transform", 1970). The object keeps
// the twiddle factors of all lengths used so far and is not thread-safe: each thread needs its own.
class LineTransform {
  public:
    LineTransform();
    ~LineTransform();
    LineTransform(const LineTransform&) = delete;
    LineTransform& operator=(const LineTransform&) = delete;

    // The sums of values times exp(-2 pi i k n / length), or with +2 pi i for the inverse; neither is scaled. `length`
    // >= 2; `to` and `from` do not overlap.
    void forward(std::complex<double>* to, const std::complex<double>* from, int length);
    void inverse(std::complex<double>* to, const std::complex<double>* from, int length);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// The smallest number >= `least` with no prime factor above 5.
int convenient_length(int least);

} // namespace vkfv
