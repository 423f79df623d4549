#include "app/commands.hpp"
#include "app/version.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/fit/fit.hpp"

#include <fmt/format.h>

#include <charconv>
#include <map>

namespace vkfv::app {

namespace {

struct FitOptions {
    std::optional<std::filesystem::path> configuration;
    std::vector<std::string> free;
    std::vector<std::string> starts; // KEY=VALUE
    int replicates = 24;
    bool descending = false;
};

std::map<std::string, double> starts_of(const std::vector<std::string>& texts) {
    std::map<std::string, double> starts;
    for (const std::string& text : texts) {
        const auto equals = text.find('=');
        double value = 0;
        const char* const end = text.data() + text.size();
        if (equals != std::string::npos) {
            const auto [read, error] = std::from_chars(text.data() + equals + 1, end, value);
            if (error == std::errc() && read == end) {
                starts[text.substr(0, equals)] = value;
                continue;
            }
        }
        refuse_argument("--start " + text, "KEY=NUMBER", "Write for example --start specimen.material.g=0.5.");
    }
    return starts;
}

// The folder "stack/" has the name "stack".
std::filesystem::path without_last_slash(const std::filesystem::path& path) {
    return path.has_filename() ? path : path.parent_path();
}

} // namespace

Command fit_command() {
    return {.name = "fit",
            .summary = "The numbers of a configuration with which it makes stacks like a measured one, with their "
                       "covariance and what the stack does not tell; continues an interrupted one",
            .operands = {{"STACK", "Folder of a stack of vkfv; with --config also images in a folder or a TIFF file",
                          into(&CommandOptions::file)}},
            .options = together(
                {{{.name = "--free",
                   .value = "KEYS",
                   .description = "Keys of the configuration that are numbers, parted by commas, as "
                                  "specimen.material.g,specimen.roughness.sq_um",
                   .target = into(&FitOptions::free),
                   .list = true,
                   .needed = "the keys that the fit may change"},
                  {.name = "--config",
                   .value = "C.toml",
                   .description = "Configuration that makes stacks like STACK: as many images, and its pixels or a "
                                  "whole part of them (default: the stack's own)",
                   .target = into(&FitOptions::configuration),
                   .file = true},
                  {.name = "--start",
                   .value = "KEY=VALUE",
                   .description = "Where the search for a key begins; may be repeated (default: the configuration's "
                                  "value)",
                   .target = into(&FitOptions::starts),
                   .setting = true},
                  {.name = "--replicates",
                   .value = "N",
                   .description = "Stacks of the model by which the scatter of stacks is known, at least 6 and two for "
                                  "each key (default: 24)",
                   .target = into(&FitOptions::replicates),
                   .range = {8, 10000}},
                  {.name = "--descending",
                   .value = "",
                   .description = "The first of the images of another instrument is the highest",
                   .target = into(&FitOptions::descending)}},
                 configuration_options(),
                 {out_option("Output folder"), json_option()}}),
            .run = run_fit,
            .example = "vkfv fit demo --free specimen.material.g"};
}

void run_fit(const CommandOptions& given) {
    CommandOptions options = given;
    options.file = without_last_slash(given.file);
    auto progress = Progress::on_standard_error(options.quiet);
    const auto own = options.of<FitOptions>();
    const measurement::FitRequest request{.stack = options.file,
                                          .configuration = own.configuration,
                                          .overrides = overrides_with_folder(options, "-fit"),
                                          .keys = own.free,
                                          .starts = starts_of(own.starts),
                                          .replicates = own.replicates,
                                          .descending = own.descending,
                                          .program = version_text()};
    const auto result = measurement::fit(request, progress);
    if (options.json) {
        print_text(json_text(result.document) + "\n");
    } else {
        print_text(measurement::summary(result) +
                   fmt::format("fit in {}\n", safe_line((result.folder / "fit.html").string())));
    }
    tell_results(result.folder);
}

} // namespace vkfv::app
