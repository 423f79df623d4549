// The report of a stack as one page.
#pragma once

#include "measurement/evaluation_figures.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

// What one evaluation shows of itself.
struct EvaluationPicture {
    std::vector<Figures> figures;
    std::string svg; // heights, truth and deviation
    std::vector<StandardDimension> dimensions{};
};

struct StackPage {
    std::string title;
    EvaluationPicture plain;
    std::optional<EvaluationPicture> diffracted;
    nlohmann::ordered_json
        results;               // of results.json: the evaluation's settings, points by state, what is said of the run
    std::string layout;        // the instrument as SVG; empty: not known
    std::string configuration; // TOML; empty: none
};

// HTML; without times, so that it is the same bytes whenever the stack is traced.
std::string stack_page(const StackPage& content);

} // namespace vkfv::measurement
