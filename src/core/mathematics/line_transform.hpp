// The discrete Fourier transform of one line, by Eigen's port of KISS FFT.
#pragma once

#include <complex>
#include <memory>

namespace vkfv {

// Transforms of lines. The object keeps the twiddle factors of all lengths used so far and is not thread-safe: each
// thread needs its own.
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

} // namespace vkfv
