#include "app/commands.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/image/image.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

struct ImageOptions {
    double focal_height = 0; // over best focus, mm
};

} // namespace

Command image_command() {
    const Option z = {.name = "--z",
                      .value = "UM",
                      .description = "Height of the focal plane over best focus, um",
                      .target = in_mm(&ImageOptions::focal_height),
                      .needed = "the height of the focal plane over best focus"};
    return {.name = "image",
            .summary = "Trace one exposure, at --z",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options =
                together({configuration_options(), {out_option("Output folder, or a .tif file"), json_option(), z}}),
            .run = run_image,
            .example = "vkfv image assets/stacks/demo.toml --z -3.2 --rays 1e8"};
}

namespace {

std::filesystem::path image_path(const CommandOptions& options, const Configuration& configuration,
                                 double focal_height) {
    if (options.out && (options.out->extension() == ".tif" || options.out->extension() == ".tiff")) {
        return *options.out;
    }
    return configuration.output_directory / fmt::format("image_{:+.3f}um.tif", focal_height * um_per_mm);
}

} // namespace

void run_image(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::exposure);
    const double focal_height = options.of<ImageOptions>().focal_height;
    const auto file = image_path(options, configuration, focal_height);
    const auto image = measurement::measure_image(configuration, focal_height, file);
    print_text(options.json ? json_text(measurement::image_json(image)) + "\n" : measurement::summary(image));
}

} // namespace vkfv::app
