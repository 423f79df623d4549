#include "measurement/budget/budget_documents.hpp"

#include "measurement/calibration/certificate.hpp"
#include "report/chart.hpp"
#include "report/page.hpp"
#include "report/reader_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace vkfv::measurement {

namespace {
namespace of_budget_documents { // files of a unity build share the unnamed namespace

using Json = nlohmann::ordered_json;

const char* name_of(UncertainInput::Distribution distribution) {
    using Distribution = UncertainInput::Distribution;
    switch (distribution) {
    case Distribution::normal:
        return "normal";
    case Distribution::student:
        return "t";
    case Distribution::rectangular:
        return "rectangular";
    case Distribution::triangular:
        return "triangular";
    case Distribution::arcsine:
        return "arcsine";
    }
    return "";
}

std::string freedom_text(double degrees) {
    return std::isfinite(degrees) ? report::reader_figure(degrees) : std::string("∞");
}

// Bars of the contributions' magnitudes, the largest first.
std::string contributions_svg(const Budget& budget, const std::string& unit) {
    constexpr double width = 640, row = 22, names = 260, top = 28, bar = 14;
    std::vector<std::pair<std::string, double>> bars;
    for (const BudgetRow& one : budget.rows) {
        bars.emplace_back(one.input.key, std::abs(one.contribution.value));
    }
    bars.emplace_back("noise", budget.noise.value);
    if (budget.texture) {
        bars.emplace_back("texture", budget.texture->value);
    }
    std::ranges::stable_sort(bars, std::greater(), &std::pair<std::string, double>::second);
    const double most = std::max(bars.front().second, 1e-300);
    report::Svg svg;
    const std::string title =
        fmt::format("Contributions to the standard uncertainty{}", unit.empty() ? "" : " / " + unit);
    svg.text({8, 16}, title, "font-weight=\"bold\"");
    for (std::size_t k = 0; k < bars.size(); ++k) {
        const double y = top + row * static_cast<double>(k);
        const double length = (width - names - 90) * bars[k].second / most;
        svg.text({names - 8, y + bar - 3}, bars[k].first, "text-anchor=\"end\"");
        svg.rectangle({names, y}, {std::max(length, 0.5), bar}, fmt::format("fill=\"{}\"", report::line_colours[0]));
        svg.text({names + length + 6, y + bar - 3}, report::reader_figure(bars[k].second));
    }
    return svg.document({width, top + row * static_cast<double>(bars.size()) + 8}, title);
}

// The histogram of the trials' errors as an outline, and both intervals above it.
std::string histogram_svg(const Budget& budget, const std::string& unit) {
    constexpr glm::dvec2 size(560, 340), margin(16, 16);
    std::vector<double> errors = budget.errors;
    std::erase_if(errors, [](double error) { return !std::isfinite(error); });
    const auto [least, most] = std::ranges::minmax(errors);
    const auto bins = static_cast<std::size_t>(std::clamp(std::sqrt(static_cast<double>(errors.size())), 8.0, 40.0));
    const double width = (most > least ? most - least : 1) / static_cast<double>(bins);
    std::vector<double> counts(bins);
    for (const double error : errors) {
        counts[std::min(bins - 1, static_cast<std::size_t>((error - least) / width))] += 1;
    }
    const double highest = *std::ranges::max_element(counts);
    report::Curve outline{.name = "trials", .points = {{least, 0}}, .spreads = {}};
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const double left = least + width * static_cast<double>(bin);
        outline.points.insert(outline.points.end(), {{left, counts[bin]}, {left + width, counts[bin]}});
    }
    outline.points.emplace_back(least + width * static_cast<double>(bins), 0);
    const double expanded = budget.by_parts.expanded_uncertainty();
    const double low = budget.nominal.error() - expanded, high = budget.nominal.error() + expanded;
    const auto interval = [&](const char* name, double from, double to, double place) {
        return report::Curve{
            .name = name, .points = {{from, place * highest}, {to, place * highest}}, .spreads = {}, .markers = true};
    };
    const double from = std::min(least, low), to = std::max(most, high), beside = to > from ? 0.05 * (to - from) : 1;
    const report::Axis x{
        .from = from - beside, .to = to + beside, .label = fmt::format("error{}", unit.empty() ? "" : " / " + unit)};
    report::Svg svg;
    report::draw_chart(svg, margin, size, "Errors of the trials", x,
                       {.from = 0, .to = 1.35 * highest, .label = "trials"},
                       std::vector{std::move(outline),
                                   interval("95 % of the trials", budget.by_trials.low, budget.by_trials.high, 1.1),
                                   interval("error ± U", low, high, 1.2)});
    return svg.document(size + 2.0 * margin, "Errors of the trials");
}

// A value with the decimals of two digits of the uncertainty.
std::string beside_uncertainty(double value, double uncertainty) {
    return report::reader_number(value, report::form_for(value, uncertainty));
}

} // namespace of_budget_documents
} // namespace

std::vector<std::string> remarks_of(const Budget& budget) {
    constexpr double least_ratio = 0.8, most_ratio = 1.25; // beyond these the model is not linear
    constexpr int digits_to_agree = 1;                     // of the standard uncertainty
    std::vector<std::string> remarks;
    if (budget.failed > 0) {
        remarks.push_back(fmt::format("{} of {} trials have no result; the statistics are of the others.",
                                      budget.failed, budget.errors.size()));
    }
    if (budget.by_trials.trials >= 2) {
        const double doubt = 1 / std::sqrt(2.0 * (budget.by_trials.trials - 1));
        if (budget.ratio() < least_ratio * (1 - 2 * doubt) || budget.ratio() > most_ratio * (1 + 2 * doubt)) {
            remarks.push_back(fmt::format(
                "The trials scatter {:.2f} times as much as the contributions one at a time combine to: the result is "
                "no linear function of its inputs. Take the interval of the trials.",
                budget.ratio()));
        }
        remarks.push_back(fmt::format("The ends of the trials' interval are known to {:.2g} of the standard "
                                      "uncertainty.",
                                      budget.by_trials.end_uncertainty / budget.by_trials.standard_deviation));
        if (budget.by_parts.standard_uncertainty > 0) {
            const double tolerance = numerical_tolerance(budget.by_parts.standard_uncertainty, digits_to_agree);
            remarks.push_back(fmt::format(
                "The intervals by contributions and by trials differ by up to {:.2g}; to one digit of the standard "
                "uncertainty they {} (JCGM 101, clause 8).",
                budget.interval_difference(), budget.interval_difference() <= tolerance ? "agree" : "do not agree"));
        }
    }
    if (std::abs(budget.nominal.error()) > budget.by_parts.expanded_uncertainty()) {
        remarks.emplace_back("The error of the undeviated instrument is larger than U: correct results for it.");
    }
    for (const BudgetRow& row : budget.rows) {
        if (std::abs(row.contribution.value) < 2 * row.sensitivity_noise) {
            remarks.push_back(
                fmt::format("The contribution of {} is no larger than the noise of two measurements could "
                            "make it.",
                            row.input.key));
        }
        if (row.input.source.empty()) {
            remarks.push_back(fmt::format("The uncertainty of {} states no source.", row.input.key));
        }
    }
    return remarks;
}

nlohmann::ordered_json budget_json(const Budget& budget, const BudgetOrigin& origin) {
    using of_budget_documents::Json;
    Json json = {{"statement", not_traceable},
                 {"program", origin.program},
                 {"configuration", origin.title},
                 {"devices", origin.devices},
                 {"first_seed", origin.seed},
                 {"measurand", {{"name", budget.nominal.name}, {"unit", budget.nominal.unit}}},
                 {"measured", budget.nominal.measured},
                 {"truth", budget.nominal.truth},
                 {"error", budget.nominal.error()},
                 {"inputs", Json::array()}};
    for (const BudgetRow& row : budget.rows) {
        json["inputs"].push_back({{"key", row.input.key},
                                  {"value", row.value},
                                  {"distribution", of_budget_documents::name_of(row.input.distribution)},
                                  {"standard_uncertainty", row.input.uncertainty},
                                  {"degrees_of_freedom", row.input.degrees_of_freedom},
                                  {"type", row.input.evaluation},
                                  {"source", row.input.source},
                                  {"sensitivity", row.sensitivity},
                                  {"contribution", row.contribution.value},
                                  {"contribution_noise", row.sensitivity_noise}});
    }
    json["noise"] = {{"contribution", budget.noise.value}, {"degrees_of_freedom", budget.noise.degrees_of_freedom}};
    json["texture"] = nullptr;
    if (const auto& texture = budget.texture) {
        json["texture"] = {{"contribution", texture->value}, {"degrees_of_freedom", texture->degrees_of_freedom}};
    }
    json["by_parts"] = {{"standard_uncertainty", budget.by_parts.standard_uncertainty},
                        {"degrees_of_freedom", budget.by_parts.degrees_of_freedom},
                        {"coverage_factor", budget.by_parts.coverage_factor},
                        {"expanded_uncertainty_95", budget.by_parts.expanded_uncertainty()}};
    json["by_trials"] = nullptr;
    if (const TrialStatistics& trials = budget.by_trials; trials.trials >= 2) {
        json["by_trials"] = {{"trials", trials.trials},
                             {"failed", budget.failed},
                             {"mean_error", trials.mean},
                             {"standard_deviation", trials.standard_deviation},
                             {"low", trials.low},
                             {"high", trials.high},
                             {"end_uncertainty", trials.end_uncertainty},
                             {"ratio_to_by_parts", budget.ratio()},
                             {"interval_difference", budget.interval_difference()},
                             {"errors", budget.errors}};
    }
    json["remarks"] = remarks_of(budget);
    return json;
}

std::string budget_page(const Budget& budget, const BudgetOrigin& origin, const std::string& configuration) {
    using namespace of_budget_documents;
    using report::reader_figure;
    const std::string unit = report::reader_unit(budget.nominal.unit);
    const std::string of_unit = unit.empty() ? "" : " " + unit;
    report::Page page;
    const double u = budget.by_parts.standard_uncertainty;
    const auto shown = [&](double value) { return beside_uncertainty(value, u) + of_unit; };
    page.section("result", "Result");
    page.paragraph(fmt::format("{}: measured {}, true {}, error {} (means of the repetitions). Combined standard "
                               "uncertainty u = {}, expanded uncertainty U = {} (95 %, k = {:.3g}).",
                               budget.nominal.name, shown(budget.nominal.measured), shown(budget.nominal.truth),
                               shown(budget.nominal.error()), shown(u), shown(budget.by_parts.expanded_uncertainty()),
                               budget.by_parts.coverage_factor));
    for (const std::string& remark : remarks_of(budget)) {
        page.paragraph(remark);
    }
    page.section("budget", "Budget");
    page.paragraph("Each input is set above and below its value by its standard uncertainty; half of the difference of "
                   "the errors is its contribution (JCGM 100). Noise is the scatter of repetitions; texture is what "
                   "the scatter grows by where each repetition has a specimen with a texture of its own.");
    std::vector<std::vector<std::string>> table{{"input", "value", "distribution", "u", "degrees of freedom", "type",
                                                 "source", "sensitivity",
                                                 "contribution" + (unit.empty() ? "" : " / " + unit)}};
    for (const BudgetRow& row : budget.rows) {
        table.push_back({row.input.key, reader_figure(row.value), name_of(row.input.distribution),
                         reader_figure(row.input.uncertainty), freedom_text(row.input.degrees_of_freedom),
                         row.input.evaluation, row.input.source.empty() ? "not stated" : row.input.source,
                         reader_figure(row.sensitivity), reader_figure(row.contribution.value)});
    }
    table.push_back({"noise of one measurement", "–", "normal", reader_figure(budget.noise.value),
                     freedom_text(budget.noise.degrees_of_freedom), "A", "repetitions", "1",
                     reader_figure(budget.noise.value)});
    if (const auto& texture = budget.texture) {
        table.push_back({"texture of the specimen", "–", "normal", reader_figure(texture->value),
                         freedom_text(texture->degrees_of_freedom), "A", "repetitions", "1",
                         reader_figure(texture->value)});
    }
    page.table("Contributions to the error of " + budget.nominal.name, table);
    page.picture(contributions_svg(budget, unit), "The contributions, the largest first");
    if (const TrialStatistics& trials = budget.by_trials; trials.trials >= 2) {
        page.section("trials", "Trials");
        page.paragraph(fmt::format(
            "{} trials, in each of which all inputs deviate as their distributions say (JCGM 101). Mean error "
            "{}, standard deviation {}; 95 % of the errors lie within {} to {}. By the contributions they "
            "would lie within {} to {}.",
            trials.trials, shown(trials.mean), shown(trials.standard_deviation), shown(trials.low), shown(trials.high),
            shown(budget.nominal.error() - budget.by_parts.expanded_uncertainty()),
            shown(budget.nominal.error() + budget.by_parts.expanded_uncertainty())));
        page.picture(histogram_svg(budget, unit), "How often an error came");
    }
    page.section("conditions", "Conditions");
    page.table("Conditions", {{"", "value"},
                              {"device", fmt::format("{}", fmt::join(origin.devices, "; "))},
                              {"first seed", fmt::format("{}", origin.seed)},
                              {"program", origin.program}});
    page.folded("Configuration", configuration);
    return page.document("Uncertainty budget: " + budget.nominal.name + ", " + origin.title, not_traceable);
}

} // namespace vkfv::measurement
