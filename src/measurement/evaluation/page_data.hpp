// The data for the report's scripts: frames, maps, focus curves and distributions of heights of a stack, small enough
// for a page however large the stack.
#pragma once

#include "measurement/evaluation/evaluation.hpp"
#include "report/page.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace vkfv::measurement {

// An evaluation as data of a page: JSON, and blobs in base64 that the JSON names by their id.
struct EvaluationData {
    nlohmann::ordered_json json;
    std::vector<std::pair<std::string, std::string>> blobs;
};

// name: the evaluation's name among the `count` evaluations of a page, which share the page's room.
EvaluationData evaluation_data(const std::string& name, const Evaluation& evaluation, int count);

// The images of a stack as data of a page. unit: the unit of their values.
EvaluationData frames_data(const report::Frames& frames, const std::string& unit);

// Adds the data to the page, with the scripts that show them. ledger: of the stack's light.
void add_data(report::Page& page, const EvaluationData& frames, const std::vector<EvaluationData>& evaluations,
              const nlohmann::ordered_json& ledger);

} // namespace vkfv::measurement
