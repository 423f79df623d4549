// What --check says of a configuration: the instrument's first-order data and quality, and what its exposures will be.
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
    const char* name; // as in JSON, with its unit
    double value;     // not finite: undefined
    const char* meaning;
};

struct FigureGroup {
    const char* title;
    std::vector<Figure> figures;
};

// Lengths in mm.
struct ScanFigures {
    std::size_t images = 0;
    std::uint64_t rays_per_image = 0;
    double first = 0; // height of the focal plane
    double last = 0;
};

struct SpecimenFigures {
    glm::dvec2 sides{0}; // of its footprint
    Relief relief;
};

struct InstrumentFigures {
    std::vector<FigureGroup> groups;
    std::optional<ScanFigures> scan; // none without [scan]
    std::optional<SpecimenFigures> specimen;
    Verdict verdict;
    std::vector<Warning> warnings;
};

// Needs no device. Throws InputError.
InstrumentFigures instrument_figures(const Configuration& configuration);

// file: of the configuration. What is not finite becomes null.
nlohmann::ordered_json instrument_json(const InstrumentFigures& figures, const std::filesystem::path& file);
// Tables for a person: of all figures, or of those that matter at first.
std::string instrument_text(const InstrumentFigures& figures, bool all);

} // namespace vkfv::measurement
