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
    std::string title; // how the report heads its column: "RMS deviation"; empty: by its key
    std::string unit;  // as keys spell it: "um", "um3_per_um2", "deg", "percent"; empty: a number
    double factor = 1; // from the units of the inside (mm, rad, shares of 1) to that unit
};

// place: the schema, and the way to the object in it: "results", "results.curves", "sweep.rows.figures".
// name: the key, with or without its unit: "rms_deviation". Throws std::logic_error if no figure has it.
DeclaredFigure declared_figure(std::string_view place, std::string_view name);

// Figures by their names and in the units of the inside become what is written: by their keys and in their units.
// Objects and lists among them likewise. Throws std::logic_error for a name that the schema does not declare.
nlohmann::ordered_json as_declared(std::string_view place, const nlohmann::ordered_json& figures);

} // namespace vkfv::report
