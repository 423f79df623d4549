#include "app/commands.hpp"
#include "app/version.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/calibration/calibrate.hpp"

#include <fmt/format.h>

namespace vkfv::app {

namespace {

struct CalibrateOptions {
    std::vector<std::string> only;
};

std::vector<std::string> names_of_characteristics() {
    std::vector<std::string> names;
    for (const auto& one : measurement::characteristics()) {
        names.push_back(one.name);
    }
    return names;
}

} // namespace

Command calibrate_command() {
    return {.name = "calibrate",
            .summary = "The metrological characteristics of the instrument by ISO 25178-600, each measured on virtual "
                       "standards in place of the specimen, as a certificate; continues an interrupted one",
            .operands = {{"C.toml", "Configuration of a stack", into(&CommandOptions::file)}},
            .options = together(
                {configuration_options(),
                 {{.name = "--only",
                   .value = "NAMES",
                   .description = "Characteristics, parted by commas; all if not given",
                   .target = into(&CalibrateOptions::only),
                   .choices = names_of_characteristics(),
                   .list = true},
                  small_option("The middle 160 pixels (320 for lateral characteristics), at most 31 images, and "
                               "fewer measurements: for a first look"),
                  out_option("Output folder"),
                  json_option()}}),
            .run = run_calibrate,
            .example = "vkfv calibrate assets/stacks/own_microscope.toml --small --only N_M,alpha_z"};
}

void run_calibrate(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto own = options.of<CalibrateOptions>();
    const measurement::CalibrationRequest request{.file = options.file,
                                                  .overrides = overrides_with_folder(options, "-calibration"),
                                                  .only = own.only,
                                                  .small = options.small,
                                                  .program = version_text()};
    const auto result = measurement::calibrate(request, progress);
    if (options.json) {
        print_text(json_text(result.certificate) + "\n");
    } else {
        print_text(measurement::summary(result) +
                   fmt::format("certificate in {}\n", safe_line((result.folder / "certificate.html").string())));
    }
    tell_results(result.folder);
}

} // namespace vkfv::app
