// place: 16
#pragma once

#include "specimen/square.hpp"

namespace vkfv::specimen {

// Type ADT (ISO 25178-70), by a rule: a texture that repeats itself, the sum of all waves of its square period with
// wave numbers (m, n), 1 <= m^2 + n^2 <= orders^2, one of each pair of opposite ones, in ascending order of m, then n:
//   z = c sum_k (m^2 + n^2)^(-(1 + hurst) / 2) cos(2 pi ((m x + n y) / period + k g)),  k = 1, 2, ...,
// g = (sqrt(5) - 1) / 2, and c such that the root mean square over a period is sq.
struct Deterministic : Square {
    double sq = 0;     // mm
    double period = 0; // mm, side of the repeated tile
    int orders = 0;
    double hurst = 0; // Hurst exponent, by which short waves fall

    static constexpr const char* name = "deterministic";
    static constexpr const char* meaning =
        "Type ADT of ISO 25178-70: a texture made of waves by a rule, which repeats itself.";
    static std::vector<const Key*> keys();
    static Deterministic read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    bool operator==(const Deterministic&) const = default;
};

} // namespace vkfv::specimen
