// The text, tables and files of a comparison.
#pragma once

#include "measurement/surface/comparison.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace vkfv::measurement {

// NaN (not measured, undefined) becomes null.
nlohmann::ordered_json comparison_json(const ComparisonRequest& request, const ComparisonResult& result);

// Tables for a person.
std::string comparison_text(const ComparisonRequest& request, const ComparisonResult& result);

// Into the folder, checksums last: compare.json, deviation by spatial frequency (transfer.csv) and by slope
// (slope.csv), the profiles (profile.csv), deviation.tif, of repeated measurements random.tif, and compare.svg.
void write_comparison(const std::filesystem::path& folder, const ComparisonRequest& request,
                      const ComparisonResult& result);

} // namespace vkfv::measurement
