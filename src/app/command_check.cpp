#include "app/commands.hpp"
#include "core/messages/error.hpp"
#include "measurement/instrument/instrument_report.hpp"
#include "measurement/scene/wave_devices.hpp"
#include "measurement/stack/forecast.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

namespace vkfv::app {

namespace {

struct CheckOptions {
    bool forecast = false;
};

} // namespace

Command check_command() {
    const Option forecast = {.name = "--forecast",
                             .value = "",
                             .description = "Light, noise, time, memory and disk that it will take, by a probe on the "
                                            "device",
                             .target = into(&CheckOptions::forecast)};
    return {.name = "check",
            .summary = "Validate and print first-order data; needs no device but for --forecast",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together({configuration_options(), {json_option(), out_option("Output folder"), forecast}}),
            .run = run_check,
            .example = "vkfv check assets/stacks/demo.toml --forecast"};
}

void run_check(const CommandOptions& options) {
    const bool with_forecast = options.of<CheckOptions>().forecast;
    if (options.out && !with_forecast) { // it writes nothing
        refuse_argument("--out with --check", "--forecast beside it, which looks at the disk of that folder",
                        "Leave it out, add --forecast, or give it to --stack.");
    }
    const auto configuration =
        load_configuration(options.file, options.overrides, with_forecast ? Needs::exposure : Needs::instrument);
    auto report = measurement::instrument_report(configuration, options.file);
    if (const auto cells = report.json.find("wave_cells"); cells != report.json.end()) {
        // The report is kept from run to run; devices come and go.
        for (const auto& warning : measurement::wave_warnings_of_device(configuration, cells->get<int>(),
                                                                        report.json["wave_tiles"].get<int>())) {
            report.json["warnings"].push_back(warning);
            report.text += fmt::format("  warning: {}\n", warning);
        }
    }
    std::optional<measurement::Forecast> forecast;
    if (with_forecast) {
        forecast = measurement::forecast(configuration);
    }
    if (options.json) {
        if (forecast) {
            report.json["forecast"] = measurement::json_of(*forecast);
        }
        fmt::print("{}\n", report.json.dump(2));
    } else {
        fmt::print("{}{}", report.text, forecast ? measurement::summary(*forecast) : "");
    }
    if (forecast && !forecast->fits()) {
        throw RunError("This stack does not fit on the host's memory or the disk. Take fewer images or pixels, another "
                       "machine, or another --out");
    }
}

} // namespace vkfv::app
