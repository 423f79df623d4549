#include "app/commands.hpp"
#include "app/version.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/capability/capability.hpp"

#include <fmt/format.h>

namespace vkfv::app {

namespace {

struct CapabilityOptions {
    std::optional<int> wavelengths;
    std::optional<int> amplitudes;
};

} // namespace

Command capability_command() {
    return {.name = "capability",
            .summary = "What the instrument can measure: sinusoids over wavelength and amplitude in place of the "
                       "specimen, as a map with its limits and the place of a rough specimen; continues an "
                       "interrupted one",
            .operands = {{"C.toml", "Configuration of a stack", into(&CommandOptions::file)}},
            .options = together(
                {configuration_options(),
                 {{.name = "--wavelengths",
                   .value = "N",
                   .description = "Wavelengths, from one to 30 focus windows, at most half of the field (default: 7, "
                                  "small: 3)",
                   .target = into(&CapabilityOptions::wavelengths),
                   .range = {2, 100}},
                  {.name = "--amplitudes",
                   .value = "N",
                   .description = "Amplitudes, from the noise to a quarter of the scan (default: 6, "
                                  "small: 3)",
                   .target = into(&CapabilityOptions::amplitudes),
                   .range = {2, 100}},
                  small_option("The middle 160 pixels, at most 31 images, and fewer sinusoids: for a first look"),
                  out_option("Output folder"),
                  json_option()}}),
            .run = run_capability,
            .example = "vkfv capability assets/stacks/paper_air.toml --small"};
}

void run_capability(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto own = options.of<CapabilityOptions>();
    const measurement::CapabilityRequest request{.file = options.file,
                                                 .overrides = overrides_with_folder(options, "-capability"),
                                                 .small = options.small,
                                                 .wavelengths = own.wavelengths,
                                                 .amplitudes = own.amplitudes,
                                                 .program = version_text()};
    const auto result = measurement::capability(request, progress);
    if (options.json) {
        print_text(json_text(result.document) + "\n");
    } else {
        print_text(measurement::summary(result) +
                   fmt::format("map in {}\n", safe_line((result.folder / "capability.html").string())));
    }
    tell_results(result.folder);
}

} // namespace vkfv::app
