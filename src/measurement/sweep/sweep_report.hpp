// The results of a sweep, one row for each combination.
#pragma once

#include "configuration/configuration.hpp"

#include "core/mathematics/grid.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace vkfv::measurement {

// One combination of the parameters' values.
struct SweepRow {
    std::vector<std::string> values; // TOML texts, in the order of the parameters
    nlohmann::ordered_json figures;  // by name; numbers, or null where there is none
    Grid<float> picture;             // for the contact sheet
    std::string device;              // that traced it, as the results have it
};

// A figure of a row: null where it has no value (the noise of an image without light, say), as it is when read again.
nlohmann::ordered_json sweep_figure(double value);

// The combination's name, which is also the name of its folder: "g=0.3,N=1e7".
std::string sweep_name(const Sweep& sweep, const std::vector<std::string>& values);

// A value as a reader writes it: 1e+07 as 1e7, "backward" without its quotes.
std::string plain_text(const std::string& toml_text);

// The rows as CSV, and as Markdown.
std::string sweep_csv(const Sweep& sweep, const std::vector<SweepRow>& rows);
std::string sweep_markdown(const Sweep& sweep, const std::vector<SweepRow>& rows);

// The same for programs: what was varied, and for each combination its folder, its values by key and its figures by
// name.
std::string sweep_json(const Sweep& sweep, const std::vector<SweepRow>& rows);

// The first parameter down the rows, the last along the columns; those between are held at their first values.
std::string sweep_contact_sheet(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title);

// Figures over the last parameter, a curve for each value of the first; only where the last is a number.
std::string sweep_charts(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title);

} // namespace vkfv::measurement
