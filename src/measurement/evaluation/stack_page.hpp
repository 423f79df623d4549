// The report of a stack as one page.
#pragma once

#include "measurement/evaluation/evaluation_figures.hpp"
#include "measurement/evaluation/page_data.hpp"
#include "scan/ledger_table.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// What one evaluation shows of itself.
struct EvaluationPage {
    std::vector<Figures> figures;
    std::vector<StandardDimension> dimensions;
    EvaluationData data;
};

struct StackPage {
    std::string title;
    EvaluationPage plain;
    std::optional<EvaluationPage> diffracted;
    EvaluationData frames;
    nlohmann::ordered_json
        results;               // of results.json: the evaluation's settings, points by state, what is said of the run
    scan::MeanLedger ledger;   // empty: not known
    std::string layout;        // the instrument as SVG; empty: not known
    std::string configuration; // TOML; empty: none
};

// HTML; without times, so that it is the same bytes whenever the stack is traced. These it takes from timings.js beside
// it, if that is there.
std::string stack_page(const StackPage& content);

} // namespace vkfv::measurement
