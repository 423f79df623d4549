#include "measurement/budget/measurand.hpp"

#include "report/parameter_table.hpp"
#include "surface/areal_parameters.hpp"

#include <cmath>

namespace vkfv::measurement {

namespace {

std::vector<MeasurandValue> dimensions_of(const Evaluation& evaluation) {
    std::vector<MeasurandValue> values;
    for (const StandardDimension& dimension : evaluation.dimensions) {
        const auto row = dimension.in_unit();
        values.push_back({.name = row.name, .unit = row.unit, .measured = row.measured, .truth = row.truth});
    }
    return values;
}

// The parameters of ISO 25178-2 of the levelled surfaces.
std::vector<MeasurandValue> parameters_of(const Evaluation& evaluation) {
    std::vector<MeasurandValue> values;
    const auto measured = report::parameter_rows(surface::areal_parameters(evaluation.levelled.pair.measured));
    const auto truth = report::parameter_rows(surface::areal_parameters(evaluation.levelled.pair.truth));
    for (std::size_t k = 0; k < measured.size(); ++k) {
        values.push_back({.name = measured[k].name,
                          .unit = measured[k].unit,
                          .measured = measured[k].value,
                          .truth = truth[k].value});
    }
    return values;
}

} // namespace

std::optional<MeasurandValue> measurand(const Evaluation& evaluation, const std::string& name) {
    for (const auto& values_of : {dimensions_of, parameters_of}) { // parameters take long
        const auto values = values_of(evaluation);
        for (const bool whole : {true, false}) { // "Sq" is not "Sqz"
            for (const auto& value : values) {
                const bool named = whole ? value.name == name : value.name.starts_with(name + " ");
                if (named) {
                    return std::isfinite(value.error()) ? std::optional(value) : std::nullopt;
                }
            }
        }
    }
    return std::nullopt;
}

std::vector<std::string> measurands(const Evaluation& evaluation) {
    std::vector<std::string> names;
    for (const auto& values_of : {dimensions_of, parameters_of}) {
        for (const auto& value : values_of(evaluation)) {
            names.push_back(value.name);
        }
    }
    return names;
}

} // namespace vkfv::measurement
