// place: 6
#pragma once

#include "specimen/random_heights.hpp"
#include "specimen/square.hpp"

#include <optional>

namespace vkfv::specimen {

// A level plane with random heights.
struct Rough : Continuous {
    RandomHeights random;

    static constexpr const char* name = "rough";
    static constexpr const char* meaning = "A rough surface: random heights of a given autocorrelation.";
    static std::vector<const Key*> keys();
    static Rough read(const Section& section);
    Analytic function(const SourceLocation& where) const;
    std::optional<RandomHeights> random_heights() const { return random; }
    bool operator==(const Rough&) const = default;
};

} // namespace vkfv::specimen
