// place: 7
#pragma once

#include "dimensions/feature.hpp"
#include "specimen/random_heights.hpp"
#include "specimen/square.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::specimen {

// Letters or other plateaus on a level ground, their flanks one pitch wide. From text, a letter a plateau; or from an
// image, whose grey values other than black are plateaus in ascending order.
struct Plateaus : Square {
    std::vector<double> heights; // over the ground, mm: one for each plateau, or one for all
    std::string text;            // what they read; else they are those of `file`
    std::string font;            // a name that OpenImageIO finds, or a file
    double text_width = 0;       // mm
    std::filesystem::path file;
    RandomHeights random; // over all of it

    static constexpr const char* name = "plateaus";
    static constexpr const char* meaning = "Letters or other plateaus on a level ground.";
    static std::vector<const Key*> keys();
    static Plateaus read(const Section& section);
    void raise(HeightField& field, double asked_pitch, const SourceLocation& where) const;
    std::optional<RandomHeights> random_heights() const;
    dimensions::Plateaus feature() const;
    bool operator==(const Plateaus&) const = default;
};

} // namespace vkfv::specimen
