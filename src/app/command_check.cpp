#include "app/commands.hpp"
#include "core/units.hpp"
#include "measurement/instrument_figures.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>

namespace vkfv::app {

Command check_command() {
    return {.name = "check",
            .summary = "Validate and print first-order data; needs no device",
            .operands = {{"C.toml", "Configuration", &CommandOptions::file}},
            .options = together({configuration_options(), {json_option()}}),
            .run = run_check,
            .example = "vkfv check assets/stacks/demo.toml --json"};
}

namespace {

using measurement::InstrumentFigures;

// Aligned, at most 110 columns wide.
std::string line_of(const char* name, const std::string& value, const std::string& meaning) {
    return fmt::format("  {:<35} {:>12}  {}\n", name, value, meaning);
}

std::string value_text(double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : "-";
}

std::string json_text(const std::string& file, const InstrumentFigures& figures) {
    nlohmann::ordered_json report; // what is not finite becomes null
    report["configuration"] = file;
    for (const auto& group : figures.groups) {
        for (const auto& figure : group.figures) {
            report[figure.name] = figure.value;
        }
    }
    if (const auto& scan = figures.scan) {
        report["images"] = scan->images;
        report["rays_per_image"] = scan->rays_per_image;
    }
    if (const auto& specimen = figures.specimen) {
        const auto& relief = specimen->relief;
        report["specimen_seen_share"] = relief.seen_share;
        report["specimen_side_um"] = specimen->side * um_per_mm;
        if (relief.seen_share > 0) {
            report["specimen_lowest_um"] = relief.lowest * um_per_mm;
            report["specimen_highest_um"] = relief.highest * um_per_mm;
        }
    }
    report["warnings"] = figures.warnings;
    return report.dump(2) + "\n";
}

std::string text_of(const std::string& file, const InstrumentFigures& figures) {
    std::string text = fmt::format("{}: valid\n", file);
    for (const auto& group : figures.groups) {
        text += fmt::format("{}\n", group.title);
        for (const auto& figure : group.figures) {
            text += line_of(figure.name, value_text(figure.value), figure.meaning);
        }
    }
    if (figures.scan || figures.specimen) {
        text += "Exposures\n";
    }
    if (const auto& scan = figures.scan) {
        text += line_of("images", std::to_string(scan->images),
                        fmt::format("z from {:g} to {:g} um, {:.3g} rays each", scan->first * um_per_mm,
                                    scan->last * um_per_mm, static_cast<double>(scan->rays_per_image)));
    }
    if (const auto& specimen = figures.specimen) {
        const auto& relief = specimen->relief;
        text += line_of("specimen_side_um", value_text(specimen->side * um_per_mm), "the longer side of its footprint");
        if (relief.seen_share > 0) {
            text += line_of("specimen_lowest_um", value_text(relief.lowest * um_per_mm),
                            fmt::format("highest {:.6g} um, on {:.1f} % of the field", relief.highest * um_per_mm,
                                        100 * relief.seen_share));
        }
    }
    for (const auto& warning : figures.warnings) {
        text += "  warning: " + warning + "\n";
    }
    return text;
}

} // namespace

void run_check(const CommandOptions& options) {
    const auto file = options.file.string();
    const auto figures =
        measurement::instrument_figures(load_configuration(options.file, options.overrides, Needs::instrument));
    fmt::print("{}", options.json ? json_text(file, figures) : text_of(file, figures));
}

} // namespace vkfv::app
