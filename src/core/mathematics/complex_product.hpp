#pragma once

#include <complex>

namespace vkfv {

// The product without std::complex's treatment of infinities and NaN, which costs a call.
inline std::complex<double> product(std::complex<double> a, std::complex<double> b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

} // namespace vkfv
