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

// Letters or other plateaus on a level ground, with flanks one pitch wide. They come from text, one plateau a letter,
// or from an image, in which each grey value other than black is a plateau, in ascending order.
struct Plateaus : Square {
    std::vector<double> heights; // mm, above the ground; one for each plateau, or one for all
    std::string text;            // letters; empty: plateaus from `file`
    std::string font;            // a name that OpenImageIO finds, or a file
    double text_width = 0;       // mm
    std::filesystem::path file;
    RandomHeights random; // added to the ground and the plateaus

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
