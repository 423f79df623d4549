#include "app/commands.hpp"

#include "core/units.hpp"
#include "measurement/image.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

std::filesystem::path image_path(const CommandOptions& options, const Configuration& configuration) {
    if (options.out && (options.out->extension() == ".tif" || options.out->extension() == ".tiff")) {
        return *options.out;
    }
    return configuration.output_directory / fmt::format("image_{:+.3f}um.tif", options.focal_height * um_per_mm);
}

} // namespace

void run_image(const CommandOptions& options) {
    const auto configuration = load_configuration(options.file, options.overrides, Needs::exposure);
    const auto file = image_path(options, configuration);
    fmt::print("{}", measurement::summary(measurement::measure_image(configuration, options.focal_height, file)));
}

} // namespace vkfv::app
