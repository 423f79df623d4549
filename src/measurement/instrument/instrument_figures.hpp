// The figures that vkfv check prints of a configuration: the instrument's first-order data and quality, its scan,
// specimen and verdict.
#pragma once

#include "configuration/configuration.hpp"
#include "core/messages/warning.hpp"
#include "measurement/scene/specimen_view.hpp"
#include "measurement/scene/verdict.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

struct Figure {
    const char* name; // key in JSON, with its unit
    double value;     // not finite: undefined
    const char* meaning;
};

struct FigureGroup {
    const char* title;
    std::vector<Figure> figures;
};

// The configured scan; lengths in mm.
struct ScanFigures {
    std::size_t images = 0;
    std::uint64_t rays_per_image = 0;
    double first = 0; // height of the focal plane in the first image
    double last = 0;
};

struct SpecimenFigures {
    glm::dvec2 sides{0}; // mm, of its footprint
    Relief relief;
};

struct InstrumentFigures {
    std::vector<FigureGroup> groups;
    std::optional<ScanFigures> scan; // none without [scan]
    std::optional<SpecimenFigures> specimen;
    Verdict verdict;
    std::vector<Warning> warnings;
};

// Computes the figures without a device. Throws InputError.
InstrumentFigures instrument_figures(const Configuration& configuration);

// file: the configuration's name. Numbers that are not finite become null.
nlohmann::ordered_json instrument_json(const InstrumentFigures& figures, const std::filesystem::path& file);
// Tables for a terminal, with all figures or with those of a first look alone.
std::string instrument_text(const InstrumentFigures& figures, bool all);

} // namespace vkfv::measurement
