#include "app/commands.hpp"
#include "core/messages/error.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/instrument/instrument_report.hpp"
#include "measurement/judgement/verdict.hpp"
#include "measurement/scene/warning_json.hpp"
#include "measurement/scene/wave_devices.hpp"
#include "measurement/stack/forecast.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

namespace vkfv::app {

namespace {

struct CheckOptions {
    bool forecast = false;
    bool all = false;
};

} // namespace

Command check_command() {
    const Option forecast = {.name = "--forecast",
                             .value = "",
                             .description = "Light, noise, time, memory and disk that it will take, by a probe on the "
                                            "device",
                             .target = into(&CheckOptions::forecast)};
    const Option all = {.name = "--all",
                        .value = "",
                        .description = "All figures of the instrument, below those that matter at first",
                        .target = into(&CheckOptions::all)};
    return {.name = "check",
            .summary = "Judge what can be measured, how well and what limits it; needs no device but for --forecast",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together({configuration_options(), {json_option(), out_option("Output folder"), forecast, all}}),
            .run = run_check,
            .example = "vkfv check assets/stacks/demo.toml --forecast"};
}

void run_check(const CommandOptions& options) {
    const bool with_forecast = options.of<CheckOptions>().forecast;
    if (options.out && !with_forecast) { // only a forecast depends on the folder
        refuse_argument("--out without --forecast", "--forecast beside it, which looks at the disk of that folder",
                        "Leave it out, add --forecast, or give it to vkfv stack.");
    }
    const auto configuration =
        load_configuration(options.file, options.overrides, with_forecast ? Needs::exposure : Needs::instrument);
    auto report = measurement::instrument_report(configuration, options.file);
    if (const auto cells = report.json.find("wave_cells"); cells != report.json.end()) {
        // These warnings are not in the report, since the report is kept from run to run while devices may change.
        append(report.warnings, measurement::wave_warnings_of_device(configuration, cells->get<int>(),
                                                                     report.json["wave_tiles"].get<int>()));
    }
    std::optional<measurement::Forecast> forecast;
    if (with_forecast) {
        forecast = measurement::forecast(configuration);
        report.verdict.sentences.push_back(measurement::time_sentence(*forecast));
        append(report.warnings, forecast->warnings);
    }
    if (options.json) {
        report.json["verdict"] = measurement::json_of(report.verdict);
        report.json["warnings"] = measurement::json_of(report.warnings);
        if (forecast) {
            report.json["forecast"] = measurement::json_of(*forecast);
        }
        print_text(json_text(report.json) + "\n");
    } else {
        print_text(fmt::format("{}{}{}{}", measurement::verdict_text(safe_line(options.file.string()), report.verdict),
                               measurement::warnings_text(report.warnings),
                               options.of<CheckOptions>().all ? report.all_figures : report.figures_that_matter,
                               forecast ? measurement::summary(*forecast) : ""));
    }
    if (forecast && !forecast->fits()) {
        throw RunError(
            "This stack does not fit into the memory of the device or the host, or on the disk. Take fewer images "
            "or pixels, another machine, or another --out");
    }
}

} // namespace vkfv::app
