// What the report's scripts show of a stack: frames, maps, focus curves and distributions of heights, small enough for
// a page however large the stack.
#pragma once

#include "measurement/evaluation/evaluation.hpp"
#include "report/page.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace vkfv::measurement {

// An evaluation for the page: what is in JSON, and base64 that stands apart from it, by id.
struct EvaluationData {
    nlohmann::ordered_json json;
    std::vector<std::pair<std::string, std::string>> blobs;
};

// name: of the evaluation among `count` of a page, which share its room.
EvaluationData evaluation_data(const std::string& name, const Evaluation& evaluation, int count);

// The images of a stack. unit: of their values.
EvaluationData frames_data(const report::Frames& frames, const std::string& unit);

// Into the page, with the scripts that show them. ledger: of the stack's light.
void add_data(report::Page& page, const EvaluationData& frames, const std::vector<EvaluationData>& evaluations,
              const nlohmann::ordered_json& ledger);

} // namespace vkfv::measurement
