// The discrete Fourier transform of one line, by Eigen's port of KISS FFT.
#pragma once

#include <complex>
#include <memory>

namespace vkfv {

// It keeps the twiddle factors of the lengths that it has met: one for each thread.
class LineTransform {
  public:
    LineTransform();
    ~LineTransform();
    LineTransform(const LineTransform&) = delete;
    LineTransform& operator=(const LineTransform&) = delete;

    // Sums of values times exp(-2 pi i k n / length), and with +2 pi i for the inverse; neither is scaled. `length` is
    // 2 or more, and `to` no part of `from`.
    void forward(std::complex<double>* to, const std::complex<double>* from, int length);
    void inverse(std::complex<double>* to, const std::complex<double>* from, int length);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace vkfv
