#include "measurement/sweep/sweep_report.hpp"

#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "report/chart.hpp"
#include "report/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace vkfv::measurement {

namespace {

std::optional<double> number_of(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

struct Extent {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    void include(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    // Tells whether the axis should be logarithmic.
    bool spans_decades() const { return least > 0 && most > 5 * least; }
};

std::string cell_text(const nlohmann::ordered_json& value) {
    return value.is_number_float()
               ? (std::isfinite(value.get<double>()) ? fmt::format("{:.5g}", value.get<double>()) : "")
           : value.is_string() ? value.get<std::string>()
           : value.is_null()   ? ""
                               : json_text(value, JsonLayout::one_line);
}

// The text as a cell of a Markdown table.
std::string markdown_cell(const std::string& text) {
    std::string result;
    for (const char character : safe_line(text)) {
        result += character == '|' ? "\\|" : std::string(1, character);
    }
    return result;
}

std::string table_text(const Sweep& sweep, const std::vector<SweepRow>& rows, bool markdown) {
    const char* between = markdown ? " | " : ",";
    std::vector<std::string> names;
    for (const auto& row : rows) {
        for (const auto& [name, figure] : row.figures.items()) {
            if (std::ranges::find(names, name) == names.end()) {
                names.push_back(name);
            }
        }
    }
    const auto line = [&](const std::vector<std::string>& cells) {
        std::string text = markdown ? "| " : "";
        for (std::size_t k = 0; k < cells.size(); ++k) {
            text += (k == 0 ? "" : between) + (markdown ? markdown_cell(cells[k]) : csv_cell(cells[k]));
        }
        return text + (markdown ? " |\n" : "\n");
    };
    std::vector<std::string> cells;
    for (const auto& parameter : sweep.parameters) {
        cells.push_back(parameter.label);
    }
    cells.insert(cells.end(), names.begin(), names.end());
    std::string text = line(cells);
    if (markdown) {
        text += line(std::vector<std::string>(cells.size(), "---"));
    }
    for (const auto& row : rows) {
        cells.clear();
        std::ranges::transform(row.values, std::back_inserter(cells), plain_text);
        for (const auto& name : names) {
            cells.push_back(row.figures.contains(name) ? cell_text(row.figures.at(name)) : "");
        }
        text += line(cells);
    }
    return text;
}

} // namespace

nlohmann::ordered_json sweep_figure(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

std::string plain_text(const std::string& toml_text) {
    if (const auto value = number_of(toml_text)) {
        const double decade = *value > 0 ? std::log10(*value) : 0;
        return decade >= 4 && decade == std::floor(decade) ? fmt::format("1e{:.0f}", decade)
                                                           : fmt::format("{}", *value);
    }
    return toml_text.size() > 1 && toml_text.front() == '"' ? toml_text.substr(1, toml_text.size() - 2) : toml_text;
}

std::string sweep_name(const Sweep& sweep, const std::vector<std::string>& values) {
    std::string name;
    for (std::size_t k = 0; k < values.size(); ++k) {
        name += fmt::format("{}{}={}", k == 0 ? "" : ",", sweep.parameters[k].label, plain_text(values[k]));
    }
    std::ranges::replace(name, '/', '_');
    return safe_line(name);
}

std::string sweep_csv(const Sweep& sweep, const std::vector<SweepRow>& rows) {
    return table_text(sweep, rows, false);
}

std::string sweep_markdown(const Sweep& sweep, const std::vector<SweepRow>& rows) {
    return table_text(sweep, rows, true);
}

std::string sweep_json(const Sweep& sweep, const std::vector<SweepRow>& rows) {
    using Json = nlohmann::ordered_json;
    const auto value_of = [](const std::string& toml_text) {
        const auto number = number_of(toml_text);
        return number ? Json(*number) : Json(plain_text(toml_text));
    };
    auto parameters = Json::array(), records = Json::array();
    for (const auto& [key, label, values] : sweep.parameters) {
        parameters.push_back({{"key", key}, {"label", label}});
        std::ranges::transform(values, std::back_inserter(parameters.back()["values"]), value_of);
    }
    for (const auto& row : rows) {
        auto values = Json::object();
        for (std::size_t k = 0; k < row.values.size(); ++k) {
            values[sweep.parameters[k].key] = value_of(row.values[k]);
        }
        records.push_back(
            {{"folder", sweep_name(sweep, row.values)}, {"values", std::move(values)}, {"figures", row.figures}});
    }
    const Json object = {{"of", sweep.stacks ? "stacks" : "images"},
                         {"repeats", sweep.repeats},
                         {"parameters", std::move(parameters)},
                         {"rows", std::move(records)}};
    return json_text(object) + "\n";
}

std::string sweep_contact_sheet(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title) {
    const auto& down = sweep.parameters.front();
    const auto& along = sweep.parameters.back();
    const bool one_axis = sweep.parameters.size() == 1;
    report::ContactSheet sheet;
    sheet.title = title;
    sheet.column_label = along.label;
    std::ranges::transform(along.values, std::back_inserter(sheet.column_values), plain_text);
    if (one_axis) {
        sheet.row_values = {""};
    } else {
        sheet.row_label = down.label;
        std::ranges::transform(down.values, std::back_inserter(sheet.row_values), plain_text);
    }
    for (const auto& row : rows) {
        bool shown = true;
        for (std::size_t k = 1; k + 1 < sweep.parameters.size(); ++k) {
            shown = shown && row.values[k] == sweep.parameters[k].values.front();
        }
        if (shown) {
            sheet.images.push_back(row.picture);
            const auto first = row.figures.begin();
            sheet.notes.push_back(fmt::format("{} {}", first.key(), cell_text(first.value())));
        }
    }
    return report::contact_sheet(sheet);
}

std::string sweep_charts(const Sweep& sweep, const std::vector<SweepRow>& rows, const std::string& title) {
    constexpr glm::dvec2 panel{430, 330};
    constexpr double margin = 24, head = 56;
    report::Svg svg;
    svg.text({margin, 34}, title, "font-size=\"19\" fill=\"#111111\"");
    int place = 0;
    for (const auto& [name, unused] : rows.front().figures.items()) {
        std::vector<report::Curve> curves;
        Extent x_extent, y_extent;
        for (const auto& row : rows) {
            const auto x = number_of(row.values.back());
            if (!x || !row.figures.contains(name) || !row.figures.at(name).is_number()) {
                continue;
            }
            std::string curve_name;
            for (std::size_t k = 0; k + 1 < row.values.size(); ++k) {
                curve_name +=
                    fmt::format("{}{} = {}", k == 0 ? "" : ", ", sweep.parameters[k].label, plain_text(row.values[k]));
            }
            auto found = std::ranges::find(curves, curve_name, &report::Curve::name);
            if (found == curves.end()) {
                curves.push_back({.name = curve_name, .points = {}, .spreads = {}, .markers = true});
                found = curves.end() - 1;
            }
            const double y = row.figures.at(name).get<double>();
            found->points.emplace_back(*x, y);
            x_extent.include(*x);
            y_extent.include(y);
        }
        if (curves.empty()) {
            continue;
        }
        const glm::dvec2 corner =
            glm::dvec2(margin, head) + (panel + glm::dvec2(margin)) * glm::dvec2(place % 3, place / 3);
        ++place;
        report::draw_chart(svg, corner, panel, name,
                           report::axis_over(curves, 0, sweep.parameters.back().label, x_extent.spans_decades()),
                           report::axis_over(curves, 1, "", y_extent.spans_decades()), curves);
    }
    return svg.document(glm::dvec2(margin, head) +
                            (panel + glm::dvec2(margin)) * glm::dvec2(std::min(std::max(place, 1), 3), (place + 2) / 3),
                        title);
}

} // namespace vkfv::measurement
