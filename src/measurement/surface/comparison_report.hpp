// The text, JSON and files of a comparison.
#pragma once

#include "measurement/surface/comparison.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace vkfv::measurement {

// JSON of the comparison. NaN (not measured, undefined) becomes null.
nlohmann::ordered_json comparison_json(const ComparisonRequest& request, const ComparisonResult& result);

// Tables for a terminal.
std::string comparison_text(const ComparisonRequest& request, const ComparisonResult& result);

// Writes into the folder, checksums last: compare.json, the deviation by spatial frequency (transfer.csv) and by slope
// (slope.csv), the profiles (profile.csv), deviation.tif, for repeated measurements random.tif, and compare.svg.
void write_comparison(const std::filesystem::path& folder, const ComparisonRequest& request,
                      const ComparisonResult& result);

} // namespace vkfv::measurement
