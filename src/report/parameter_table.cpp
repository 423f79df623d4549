#include "report/parameter_table.hpp"

#include "core/mathematics/units.hpp"
#include "report/declared_figures.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vkfv::report {

std::string ParameterRow::key() const {
    return unit.empty() ? name : name + "_" + unit;
}

std::vector<ParameterRow> parameter_rows(const surface::ArealParameters& parameters) {
    std::vector<ParameterRow> rows;
    for (const auto& [name, value] : surface::named_parameters(parameters)) {
        const auto declared = declared_figure("results.parameters", name);
        rows.push_back({std::string(name), declared.unit, value * declared.factor});
    }
    return rows;
}

std::vector<ParameterRow> parameter_rows(const surface::ProfileParameters& parameters) {
    return {{"Ra", "um", parameters.ra * um_per_mm},
            {"Rq", "um", parameters.rq * um_per_mm},
            {"Rz", "um", parameters.rz * um_per_mm}};
}

nlohmann::ordered_json json_of(const std::vector<ParameterRow>& rows) {
    auto object = nlohmann::ordered_json::object();
    for (const auto& row : rows) {
        object[row.key()] = row.value;
    }
    return object;
}

std::string number_text(double value) {
    return std::isnan(value) ? "-" : fmt::format("{:.6g}", value);
}

nlohmann::ordered_json treatment_json(const surface::Band& band) {
    return {{"form", surface::form_name(band.form)},
            {"s_filter_um", band.s_filter * um_per_mm},
            {"l_filter_um", band.l_filter * um_per_mm},
            {"filter", surface::filter_name(band)}};
}

std::string treatment_text(const surface::Band& band) {
    std::string text = "form " + surface::form_name(band.form);
    const char* filter = band.spline ? surface::filter_name(band) : "Gaussian";
    if (band.s_filter > 0) {
        text += fmt::format(", S-filter {:g} um ({})", band.s_filter * um_per_mm, filter);
    }
    if (band.l_filter > 0) {
        text += fmt::format(", L-filter {:g} um ({})", band.l_filter * um_per_mm, filter);
    }
    return text;
}

} // namespace vkfv::report
