// The results of a sweep, with a row for each combination.
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
    nlohmann::ordered_json figures;  // by name; a number, or null without a value
    Grid<float> picture;             // for the contact sheet
    std::string device;              // device that traced it, as named in the results
};

// A figure of a row. It is null where it has no value (the noise of an image without light, for example), as when it is
// read again.
nlohmann::ordered_json sweep_figure(double value);

// The combination's name, which is also the name of its folder: "g=0.3,N=1e7".
std::string sweep_name(const Sweep& sweep, const std::vector<std::string>& values);

// A value as readers write it: 1e+07 as 1e7, "backward" without its quotes.
std::string plain_text(const std::string& toml_text);

// The rows as CSV, and as Markdown.
std::string sweep_csv(const Sweep& sweep, const std::vector<SweepRow>& rows);
std::string sweep_markdown(const Sweep& sweep, const std::vector<SweepRow>& rows);

// The results as JSON: the swept parameters, and for each combination its folder, its values by key and its figures by
// name.
std::string sweep_json(const Sweep& sweep, const std::vector<SweepRow>& rows);

// SVG with the first parameter down the rows and the last along the columns. The parameters between are held at their
// first values.
std::string sweep_contact_sheet(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title);

// Charts as SVG of the figures over the last parameter, with a curve for each combination of the other parameters.
// There are none unless the last parameter is a number.
std::string sweep_charts(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title);

} // namespace vkfv::measurement
