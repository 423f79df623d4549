#include "report/parameter_table.hpp"

#include "core/mathematics/units.hpp"
#include "report/declared_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
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
    const auto& p = parameters;
    const auto um = [](const char* name, double value) { return ParameterRow{name, "um", value * um_per_mm}; };
    const auto percent = [](const char* name, double value) { return ParameterRow{name, "percent", value * 100}; };
    return {um("Ra", p.ra),           um("Rq", p.rq),   um("Rz", p.rz),     um("Rp", p.rp),
            um("Rv", p.rv),           um("Rt", p.rt),   {"Rsk", "", p.rsk}, {"Rku", "", p.rku},
            {"Rdq", "", p.rdq},       um("Rsm", p.rsm), um("Rc", p.rc),     um("Rdc", p.rdc),
            um("Rk", p.rk),           um("Rpk", p.rpk), um("Rvk", p.rvk),   percent("Rmrk1", p.rmrk1),
            percent("Rmrk2", p.rmrk2)};
}

nlohmann::ordered_json json_of(const std::vector<ParameterRow>& rows) {
    auto object = nlohmann::ordered_json::object();
    for (const auto& row : rows) {
        object[row.key()] = row.value;
    }
    return object;
}

std::string slope_loss_text(const std::vector<ParameterRow>& rows) {
    constexpr double least_percent = 1;
    const auto loss = std::ranges::find(rows, "Sdq_loss", &ParameterRow::name);
    if (loss == rows.end() || !(loss->value >= least_percent)) {
        return {};
    }
    return fmt::format(
        "Sdq and Sdr depend on the distance of the points: with finer points Sdq would be at least {:.2g} % "
        "larger, Sdr {:.2g} %. Compare them at one sampling only, or remove shorter waves by an S-filter.",
        loss->value, 2 * loss->value);
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
    const char* filter = band.spline || band.robust ? surface::filter_name(band) : "Gaussian";
    if (band.s_filter > 0) {
        text += fmt::format(", S-filter {:g} um ({})", band.s_filter * um_per_mm, filter);
    }
    if (band.l_filter > 0) {
        text += fmt::format(", L-filter {:g} um ({})", band.l_filter * um_per_mm, filter);
    }
    return text;
}

} // namespace vkfv::report
