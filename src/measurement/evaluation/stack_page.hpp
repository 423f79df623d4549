// The report of a stack as one page of HTML.
#pragma once

#include "measurement/evaluation/evaluation_figures.hpp"
#include "measurement/evaluation/page_data.hpp"
#include "scan/ledger_table.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace vkfv::measurement {

// The parts of the page that belong to one evaluation.
struct EvaluationPage {
    std::vector<Figures> figures;
    std::vector<StandardDimension> dimensions;
    EvaluationData data;
};

struct StackPage {
    std::string title;
    std::string summary; // one line: what was measured, by what; empty: not known
    EvaluationPage plain;
    std::optional<EvaluationPage> diffracted;
    EvaluationData frames;
    nlohmann::ordered_json results; // from results.json: settings, points by state, and the run
    scan::MeanLedger ledger;        // empty: not known
    std::string layout;             // the instrument as SVG; empty: not known
    std::string configuration;      // TOML; empty: none
};

// Returns HTML. It has no times, so that it is the same bytes whenever the stack is traced; the page takes them from
// timings.js in its folder, if there is such a file.
std::string stack_page(const StackPage& content);

} // namespace vkfv::measurement
