#include "measurement/fit/fit_documents.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/calibration/certificate.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"
#include "report/reader_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_fit_documents { // files of a unity build share the unnamed namespace

using Json = nlohmann::ordered_json;
using report::reader_figure;

constexpr double high_correlation = 0.95;
constexpr double percent = 100;

// A group of statistics with the places of its values.
struct Placed {
    StatisticGroup group;
    std::size_t first;
};

std::vector<Placed> placed_groups(const StatisticsLayout& layout) {
    auto groups = statistic_groups(layout);
    std::vector<Placed> placed;
    placed.reserve(groups.size());
    std::size_t first = 0;
    for (StatisticGroup& group : groups) {
        const auto count = static_cast<std::size_t>(group.count);
        placed.push_back({std::move(group), first});
        first += count;
    }
    return placed;
}

std::vector<double> part_of(const std::vector<double>& values, const Placed& placed) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(placed.first);
    return {begin, begin + placed.group.count};
}

std::string value_text(double value, double uncertainty) {
    return report::reader_number(value, report::form_for(value, uncertainty));
}

std::string with_unit(const std::string& text, const std::string& unit) {
    const std::string shown = report::reader_unit(unit);
    return shown.empty() ? text : fmt::format("{} {}", text, shown);
}

void add_verdict(const Fit& fit, std::vector<std::string>& remarks) {
    const auto& found = fit.search.fit;
    const std::string misfit = fmt::format(
        "what the fit leaves of the statistics has {:.3g} times the mean square that stacks of the model have, which "
        "chance makes as large in {:.2g} % of cases",
        found.misfit, percent * found.misfit_probability);
    if (fit.describes()) {
        remarks.push_back(fmt::format("The model describes the stack: {}.", misfit));
    } else {
        remarks.push_back(fmt::format("The model does not describe the stack: {}. Standard uncertainties are enlarged "
                                      "by its square root, {:.3g}; "
                                      "they hold only if what the model lacks moves the statistics like chance does.",
                                      misfit, fit.enlargement()));
    }
}

void add_untold(const Fit& fit, std::vector<std::string>& remarks) {
    const auto fitted = fit.fitted();
    const auto& alike = fit.search.fit.alike;
    std::vector<std::string> keys;
    keys.reserve(fitted.size());
    for (std::size_t k = 0; k < fitted.size(); ++k) {
        const FittedParameter& one = fitted[k];
        if (alike[k]) {
            keys.push_back(one.parameter.key);
        } else if (!one.determined) {
            remarks.push_back(fmt::format("The stack does not tell {}: no statistic follows it beyond chance, and it "
                                          "was held at {:.4g}, where the search left it.",
                                          one.parameter.key, one.parameter.value(fit.search.place[k])));
        } else if (!one.told && fit.search.settled) {
            remarks.push_back(fmt::format(
                "The stack does not tell {}: its standard uncertainty is more than a third of what is known beforehand "
                "({}).",
                one.parameter.key, one.parameter.known_range()));
        }
    }
    if (!keys.empty()) {
        remarks.push_back(fmt::format("The stack does not tell {} apart: some of them change its statistics in one and "
                                      "the same way. Free fewer of them.",
                                      fmt::join(keys, " and ")));
    }
}

void add_correlations(const Fit& fit, std::vector<std::string>& remarks) {
    for (std::size_t second = 1; second < fit.parameters.size(); ++second) {
        for (std::size_t first = 0; first < second; ++first) {
            const double correlation = fit.correlation(first, second);
            if (std::abs(correlation) > high_correlation) {
                remarks.push_back(
                    fmt::format("The stack tells {} and {} together only: their correlation is {:.3f}, so "
                                "that a change of one is made up for by the other.",
                                fit.parameters[first].key, fit.parameters[second].key, correlation));
            }
        }
    }
}

// A chart of a group's values over the focal height: measured, fitted, and where 95 % of measurements would lie.
std::string chart_of(const Fit& fit, const Placed& placed) {
    constexpr glm::dvec2 size(560, 300), margin(12, 12);
    constexpr double factor = 1.96; // of a normal distribution
    report::Curve measured{.name = "measured", .points = {}, .spreads = {}, .line = false, .markers = true};
    report::Curve fitted{.name = "fitted", .points = {}, .spreads = {}};
    report::Curve above{.name = "95 % of measurements", .points = {}, .spreads = {}};
    report::Curve below{.name = "", .points = {}, .spreads = {}};
    for (std::size_t k = 0; k < static_cast<std::size_t>(placed.group.count); ++k) {
        const double z = fit.positions[k] * um_per_mm;
        const std::size_t at = placed.first + k;
        const double expected = fit.search.fit.expected[at], spread = factor * fit.search.fit.deviation[at];
        measured.points.emplace_back(z, fit.measured[at]);
        fitted.points.emplace_back(z, expected);
        above.points.emplace_back(z, expected + spread);
        below.points.emplace_back(z, expected - spread);
    }
    const std::vector<report::Curve> curves = {std::move(measured), std::move(fitted), std::move(above),
                                               std::move(below)};
    report::Svg svg;
    report::draw_chart(svg, margin, size, placed.group.title, report::axis_over(curves, 0, "z / µm"),
                       report::axis_over(curves, 1, placed.group.title), curves);
    return svg.document(size + 2.0 * margin, placed.group.title);
}

void add_parameters(report::Page& page, const std::vector<FittedParameter>& parameters) {
    std::vector<std::vector<std::string>> table{
        {"parameter", "start", "estimate", "u", "95 % from", "to", "Cramér-Rao bound", "u / bound", "told"}};
    table.reserve(parameters.size() + 1);
    for (const FittedParameter& one : parameters) {
        const auto shown = [&](double value) {
            return std::isfinite(value) ? value_text(value, one.standard_uncertainty) : std::string("–");
        };
        table.push_back(
            {one.parameter.key, with_unit(report::reader_number(one.parameter.start), one.parameter.unit),
             with_unit(shown(one.estimate), one.parameter.unit), reader_figure(one.standard_uncertainty),
             shown(one.low), shown(one.high), reader_figure(one.bound),
             std::isfinite(one.uncertainty_ratio) ? fmt::format("{:.2f}", one.uncertainty_ratio) : std::string("–"),
             one.told ? "yes" : "no"});
    }
    page.table("Parameters", table);
}

void add_correlation_table(report::Page& page, const Fit& fit) {
    std::vector<std::string> head = {"correlation"};
    head.reserve(fit.parameters.size() + 1);
    for (const FreeParameter& parameter : fit.parameters) {
        head.push_back(parameter.key);
    }
    std::vector<std::vector<std::string>> table = {std::move(head)};
    table.reserve(fit.parameters.size() + 1);
    for (std::size_t row = 0; row < fit.parameters.size(); ++row) {
        std::vector<std::string> cells = {fit.parameters[row].key};
        cells.reserve(fit.parameters.size() + 1);
        for (std::size_t column = 0; column < fit.parameters.size(); ++column) {
            const double correlation = fit.correlation(row, column);
            cells.push_back(std::isfinite(correlation) ? fmt::format("{:.3f}", correlation) : std::string("–"));
        }
        table.push_back(std::move(cells));
    }
    page.table("Correlations", table);
}

void add_statistics(report::Page& page, const Fit& fit) {
    std::vector<std::vector<std::string>> table{{"statistic", "measured", "fitted", "standard deviation"}};
    for (const Placed& placed : placed_groups(fit.layout)) {
        if (placed.group.of_images) {
            page.picture(chart_of(fit, placed), placed.group.title);
            continue;
        }
        for (std::size_t k = 0; k < placed.group.names.size(); ++k) {
            const std::size_t at = placed.first + k;
            table.push_back({fmt::format("{}: {}", placed.group.title, placed.group.names[k]),
                             reader_figure(fit.measured[at]), reader_figure(fit.search.fit.expected[at]),
                             reader_figure(fit.search.fit.deviation[at])});
        }
    }
    if (table.size() > 1) {
        page.table("Statistics of the whole stack", table);
    }
}

template <class Value>
Json square_of(std::size_t side, const Value& value) {
    Json rows = Json::array();
    for (std::size_t row = 0; row < side; ++row) {
        Json cells = Json::array();
        for (std::size_t column = 0; column < side; ++column) {
            cells.push_back(value(row, column));
        }
        rows.push_back(std::move(cells));
    }
    return rows;
}

} // namespace of_fit_documents
} // namespace

std::vector<std::string> remarks_of(const Fit& fit) {
    using namespace of_fit_documents;
    std::vector<std::string> remarks;
    add_verdict(fit, remarks);
    add_untold(fit, remarks);
    add_correlations(fit, remarks);
    if (!fit.search.settled) {
        remarks.emplace_back(
            "The search has not settled: the last change is larger than the steps by which slopes were "
            "taken, so that estimates lie beyond the places that were tried, and none is told. Begin nearer, with "
            "--start.");
    }
    if (!fit.layout.brightness) {
        remarks.emplace_back("The brightness of the whole stack does not count, since exposure and gain of the images "
                             "are not known: a reflectance or a power cannot be told.");
    }
    return remarks;
}

nlohmann::ordered_json fit_json(const Fit& fit) {
    using namespace of_fit_documents;
    const auto& found = fit.search.fit;
    Json json = {{"statement", not_traceable},
                 {"program", fit.program},
                 {"stack", fit.stack},
                 {"configuration", fit.title},
                 {"devices", fit.devices},
                 {"first_seed", fit.first_seed},
                 {"replicates", fit.replicates},
                 {"model_stacks", fit.stacks},
                 {"model_describes", fit.describes()},
                 {"misfit", found.misfit},
                 {"misfit_probability", found.misfit_probability},
                 {"enlargement", fit.enlargement()},
                 {"settled", fit.search.settled},
                 {"degrees_of_freedom", found.degrees_of_freedom},
                 {"parameters", Json::array()}};
    for (const FittedParameter& one : fit.fitted()) {
        json["parameters"].push_back({{"key", one.parameter.key},
                                      {"unit", one.parameter.unit},
                                      {"start", one.parameter.start},
                                      {"told", one.told},
                                      {"estimate", one.estimate},
                                      {"standard_uncertainty", one.standard_uncertainty},
                                      {"low", one.low},
                                      {"high", one.high},
                                      {"cramer_rao_bound", one.bound},
                                      {"uncertainty_over_bound", one.uncertainty_ratio}});
    }
    const std::size_t side = fit.parameters.size();
    json["covariance"] =
        square_of(side, [&](std::size_t row, std::size_t column) { return fit.covariance(row, column); });
    json["correlation"] =
        square_of(side, [&](std::size_t row, std::size_t column) { return fit.correlation(row, column); });
    json["statistics"] = Json::array();
    for (const Placed& placed : placed_groups(fit.layout)) {
        Json z; // null: not of images
        if (placed.group.of_images) {
            z = Json::array();
            for (std::size_t k = 0; k < static_cast<std::size_t>(placed.group.count); ++k) {
                z.push_back(fit.positions[k] * um_per_mm);
            }
        }
        json["statistics"].push_back({{"name", placed.group.name},
                                      {"title", placed.group.title},
                                      {"z_um", std::move(z)},
                                      {"names", placed.group.names},
                                      {"measured", part_of(fit.measured, placed)},
                                      {"fitted", part_of(found.expected, placed)},
                                      {"standard_deviation", part_of(found.deviation, placed)}});
    }
    json["remarks"] = remarks_of(fit);
    return json;
}

std::string fit_page(const Fit& fit, const std::string& configuration) {
    using namespace of_fit_documents;
    report::Page page;
    page.section("result", "Result");
    for (const std::string& remark : remarks_of(fit)) {
        page.paragraph(remark);
    }
    add_parameters(page, fit.fitted());
    page.paragraph(
        "Intervals of 95 % by Student's distribution. The Cramér-Rao bound is the least standard uncertainty that any "
        "unbiased estimate by these statistics can have, if they are normal. Both are known by the replicates alone, "
        "so that their ratio may be below 1 by chance. A parameter is told if the search has settled and its "
        "standard uncertainty is at most a third of what is known of it beforehand.");
    add_correlation_table(page, fit);
    page.section("statistics", "Statistics");
    page.paragraph("Measured, and as the fitted model makes them in the mean, with the range of 95 % of measurements. "
                   "None depends on which texture was drawn but by chance.");
    add_statistics(page, fit);
    page.section("conditions", "Conditions");
    page.table("Conditions", {{"", "value"},
                              {"stack", fit.stack},
                              {"images", fmt::format("{} of {} x {} pixels", fit.layout.images,
                                                     fit.layout.pixels.columns, fit.layout.pixels.rows)},
                              {"squares of focus curves / pixels", fmt::format("{}", fit.layout.window)},
                              {"replicates", fmt::format("{}", fit.replicates)},
                              {"stacks of the model", fmt::format("{}", fit.stacks)},
                              {"device", fmt::format("{}", fmt::join(fit.devices, "; "))},
                              {"first seed", fmt::format("{}", fit.first_seed)},
                              {"program", fit.program}});
    page.folded("Configuration", configuration);
    return page.document("Fit: " + fit.title, not_traceable);
}

} // namespace vkfv::measurement
