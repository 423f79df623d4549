// Keys, units and titles of the figures that vkfv writes, as assets/schemas declares them. The schemas are embedded
// when vkfv is built.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace vkfv::report {

// A figure: a property of an object that a schema describes.
struct DeclaredFigure {
    std::string key;   // "rms_deviation_um"
    std::string title; // heading of its column in the report: "RMS deviation"; empty: made from its key
    std::string unit;  // unit as keys spell it: "um", "um3_per_um2", "deg", "percent"; empty: a number
    double factor = 1; // factor from the units used inside (mm, rad, shares of 1) to that unit
};

// The declaration of a figure. place: the schema, and the path of the object in it: "results", "results.curves",
// "sweep.rows.figures". name: the key, with or without its unit: "rms_deviation". Throws std::logic_error if no figure
// has it.
DeclaredFigure declared_figure(std::string_view place, std::string_view name);

// Converts figures by name, in the units used inside, to those by key in the declared units, also in objects and lists
// among them. Throws std::logic_error for a name that the schema does not declare.
nlohmann::ordered_json as_declared(std::string_view place, const nlohmann::ordered_json& figures);

} // namespace vkfv::report
