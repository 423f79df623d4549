#include "statistics/random_stream.hpp"

#include "core/mathematics/units.hpp"

namespace vkfv::statistics {

namespace {

double uniform_of(std::uint32_t high, std::uint32_t low) {
    constexpr int dropped_bits = 12;
    const std::uint64_t bits = ((std::uint64_t{high} << 32) | low) >> dropped_bits;
    return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

} // namespace

std::array<double, 2> RandomStream::uniforms() {
    const auto bits = physics::f64::philox_4x32(counter_, seed_, image_, physics::f64::PHILOX_ROUNDS);
    ++counter_.z;
    return {uniform_of(bits.x, bits.y), uniform_of(bits.z, bits.w)};
}

// Box-Muller transform: G. E. P. Box, M. E. Muller, "A note on the generation of random normal deviates", Ann. Math.
// Statist. 29 (1958) 610.
double RandomStream::normal() {
    const auto [radius, angle] = uniforms();
    return std::sqrt(-2 * std::log(radius)) * std::cos(2 * pi * angle);
}

} // namespace vkfv::statistics
