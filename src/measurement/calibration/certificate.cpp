#include "measurement/calibration/certificate.hpp"

#include "core/mathematics/units.hpp"
#include "report/page.hpp"
#include "report/reader_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace vkfv::measurement {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const CertificateFigure& figure) {
    return {{"key", figure.key},
            {"title", figure.title},
            {"unit", figure.unit},
            {"value", figure.value},
            {"standard_uncertainty", figure.standard_uncertainty},
            {"degrees_of_freedom", figure.degrees_of_freedom},
            {"expanded_uncertainty_95", figure.expanded_uncertainty()}};
}

Json json_of(const CertificateTable& table) {
    return {{"caption", table.caption}, {"columns", table.columns}, {"rows", table.rows}};
}

std::string chart_svg(const report::Chart& chart) {
    constexpr glm::dvec2 size(560, 380), margin(16, 16);
    report::Svg svg;
    report::draw_chart(svg, margin, size, chart.title,
                       report::axis_over(chart.curves, 0, chart.x_label, chart.x_decades),
                       report::axis_over(chart.curves, 1, chart.y_label), chart.curves);
    return svg.document(size + 2.0 * margin, chart.title);
}

std::vector<std::string> figure_row(const CertificateFigure& figure) {
    const std::string unit = report::reader_unit(figure.unit);
    const double expanded = figure.expanded_uncertainty();
    const bool known = std::isfinite(figure.value) && expanded > 0;
    const auto form = report::form_for(figure.value, known ? figure.standard_uncertainty : 0);
    return {figure.title,
            unit,
            known ? report::reader_number(figure.value, form) : report::reader_figure(figure.value),
            known ? report::reader_number(figure.standard_uncertainty, form) : "–",
            known ? report::reader_number(expanded, form) : "–",
            std::isfinite(figure.degrees_of_freedom) && known ? report::reader_number(figure.degrees_of_freedom) : "–"};
}

const std::vector<std::string>& figure_heads() {
    static const std::vector<std::string> heads = {"figure", "unit", "value", "u", "U (95 %)", "degrees of freedom"};
    return heads;
}

void add_table(report::Page& page, const CertificateTable& table) {
    std::vector<std::vector<std::string>> texts(table.rows.size() + 1);
    texts.front() = table.columns;
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        std::vector<double> values;
        for (const auto& row : table.rows) {
            values.push_back(row[column]);
        }
        const auto written = report::reader_column(values);
        for (std::size_t k = 0; k < written.size(); ++k) {
            texts[k + 1].push_back(written[k]);
        }
    }
    page.table(table.caption, texts);
}

} // namespace

std::array<ConditionRow, 9> condition_rows(const Conditions& c) {
    return {{{"pixel_um", "pixel on the specimen", "um", c.pitch * um_per_mm},
             {"window_um", "focus window", "um", c.window * um_per_mm},
             {"optical_resolution_um", "0.61 λ / NA", "um", c.resolution * um_per_mm},
             {"scan_range_um", "scan", "um", c.range * um_per_mm},
             {"scan_step_um", "step", "um", c.step * um_per_mm},
             {"focus_curve_deviation_um", "standard deviation of a focus curve", "um", c.curve_deviation * um_per_mm},
             {"s_filter_um", "nesting index of the S-filter", "um", c.s_filter() * um_per_mm},
             {"pixels_x", "pixels along x", "", static_cast<double>(c.pixels.columns)},
             {"pixels_y", "pixels along y", "", static_cast<double>(c.pixels.rows)}}};
}

std::string scan_text(const Conditions& conditions) {
    return fmt::format("{:.3g} µm of the scan, in steps of {:.3g} µm", conditions.range * um_per_mm,
                       conditions.step * um_per_mm);
}

std::vector<std::vector<std::string>> conditions_table(const Conditions& conditions) {
    std::vector<std::vector<std::string>> table{{"", "value"}};
    for (const auto& row : condition_rows(conditions)) {
        const std::string unit = report::reader_unit(row.unit);
        table.push_back(
            {unit.empty() ? row.words : fmt::format("{} / {}", row.words, unit), report::reader_number(row.value)});
    }
    return table;
}

nlohmann::ordered_json certificate_json(const Certificate& certificate) {
    Json json = {{"statement", not_traceable},
                 {"limits", smooth_standards},
                 {"program", certificate.program},
                 {"instrument", certificate.title},
                 {"identity_digest", certificate.identity_digest},
                 {"devices", certificate.devices},
                 {"first_seed", certificate.conditions.seed},
                 {"small", certificate.conditions.small},
                 {"camera", certificate.conditions.camera}};
    for (const auto& row : condition_rows(certificate.conditions)) {
        json["conditions"][row.key] = row.value;
    }
    json["characteristics"] = Json::array();
    for (const auto& entry : certificate.entries) {
        Json one = {{"name", entry.characteristic->name},
                    {"title", entry.characteristic->title},
                    {"standard", entry.characteristic->standard},
                    {"procedure", entry.characteristic->procedure},
                    {"equation", entry.characteristic->equation},
                    {"figures", Json::array()},
                    {"tables", Json::array()},
                    {"remarks", entry.findings.remarks},
                    {"trials", entry.trials}};
        for (const auto& figure : entry.findings.figures) {
            one["figures"].push_back(json_of(figure));
        }
        for (const auto& table : entry.findings.tables) {
            one["tables"].push_back(json_of(table));
        }
        json["characteristics"].push_back(std::move(one));
    }
    return json;
}

std::string certificate_page(const Certificate& certificate) {
    report::Page page;
    page.section("figures", "Characteristics");
    page.paragraph(not_traceable);
    if (certificate.conditions.small) {
        page.paragraph(fmt::format("With --small the standards were measured in the middle of the field and on {}; "
                                   "figures that depend on field and scan are those of this part.",
                                   scan_text(certificate.conditions)));
    }
    std::vector<std::vector<std::string>> all{figure_heads()};
    for (const auto& entry : certificate.entries) {
        for (const auto& figure : entry.findings.figures) {
            all.push_back(figure_row(figure));
        }
    }
    page.table("All figures, with the standard uncertainty u and the expanded uncertainty U", all);
    page.paragraph(smooth_standards);
    for (const auto& entry : certificate.entries) {
        const Characteristic& characteristic = *entry.characteristic;
        page.section("characteristic-" + std::to_string(&entry - certificate.entries.data()), characteristic.title);
        page.paragraph(characteristic.standard);
        page.paragraph(characteristic.procedure);
        for (const auto& chart : entry.findings.charts) {
            page.picture(chart_svg(chart), chart.title);
        }
        for (const auto& table : entry.findings.tables) {
            add_table(page, table);
        }
        for (const auto& remark : entry.findings.remarks) {
            page.paragraph(remark);
        }
    }
    page.section("conditions", "Conditions");
    page.picture(certificate.layout, "The instrument to scale, with rays");
    auto table = conditions_table(certificate.conditions);
    table.push_back({"device", fmt::format("{}", fmt::join(certificate.devices, "; "))});
    table.push_back({"first seed", fmt::format("{}", certificate.conditions.seed)});
    table.push_back({"digest of the instrument", certificate.identity_digest});
    table.push_back({"program", certificate.program});
    page.table("Conditions", table);
    page.paragraph("No input of this instrument states an uncertainty of its own; the uncertainties above are those of "
                   "the procedures alone.");
    page.folded("Configuration of the instrument", certificate.configuration);
    return page.document("Virtual calibration: " + certificate.title, not_traceable);
}

} // namespace vkfv::measurement
