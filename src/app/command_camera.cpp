#include "app/commands.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/error.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/image/camera_report.hpp"
#include "scan/store.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace vkfv::app {

namespace {

struct CameraCommandOptions {
    int pixels = camera::PhotonTransferOptions().columns;
    int averaged = camera::PhotonTransferOptions().averaged;
    bool images = false;
};

constexpr int fewest_pixels = 32, most_pixels = 4096; // on a side
constexpr int fewest_averaged = 2, most_averaged = 1000;

} // namespace

Command camera_command() {
    const Option pixels = {.name = "--pixels",
                           .value = "N",
                           .description = "Columns and rows of the images",
                           .target = into(&CameraCommandOptions::pixels),
                           .fallback = fmt::format("{}", CameraCommandOptions().pixels),
                           .range = {fewest_pixels, most_pixels}};
    const Option averaged = {.name = "--averaged",
                             .value = "N",
                             .description = "Images in the dark, and at half saturation, for nonuniformity",
                             .target = into(&CameraCommandOptions::averaged),
                             .fallback = fmt::format("{}", CameraCommandOptions().averaged),
                             .range = {fewest_averaged, most_averaged}};
    const Option images = {.name = "--images",
                           .value = "",
                           .description = "Write the images too, with their list images.csv",
                           .target = into(&CameraCommandOptions::images)};
    return {.name = "camera",
            .summary =
                "Measure the configured camera as EMVA 1288 does, on simulated dark and flat images: gain, quantum "
                "efficiency, noise, saturation, nonuniformity, with charts; needs no device",
            .operands = {{"C.toml", "Configuration with a [camera]", into(&CommandOptions::file)}},
            .options = together(
                {configuration_options(), {out_option("Output folder (default: C-camera)"), pixels, averaged, images}}),
            .run = run_camera,
            .example = "vkfv camera assets/stacks/camera.toml --out camera"};
}

namespace {

// The descriptor file of the EMVA 1288 reference implementation, which lists the images in sets of one exposure time
// (ns) and one number of photons a pixel. That implementation takes a set of two images for a pair, and refuses a
// second pair or a second stack with the same numbers, of which only the first set is listed. It finds saturation where
// the variance no longer rises from the last set to the one before, which between close sets is chance: these are not
// listed.
class DescriptorFile {
  public:
    // bits: depth of a grey value. columns, rows: pixels of an image. averaged: how many images a stack averages.
    DescriptorFile(int bits, int columns, int rows, int averaged)
        : stacks_are_pairs_(averaged == 2),
          text_(fmt::format("# Images of a camera that vkfv simulates\nv 3.0\nn {} {} {}\n", bits, columns, rows)) {}

    // Adds an image. The images of a set must follow each other. file: relative to the descriptor's folder.
    void add(const camera::TakenImage& what, const std::string& file) {
        if (std::ranges::find(close_steps, what.series) != close_steps.end())
            return;
        if (what.file.ends_with("_a") || what.series != series_) {
            series_ = what.series;
            constexpr double ns_per_s = 1e9;
            const double exposure = what.exposure_time * ns_per_s;
            const std::string set = what.photons > 0 ? fmt::format("b {:.1f} {:.6f}\n", exposure, what.photons)
                                                     : fmt::format("d {:.1f}\n", exposure);
            const bool pair = stacks_are_pairs_ || what.file.ends_with("_a");
            listed_ = sets_.emplace(pair, set).second;
            text_ += listed_ ? set : "";
        }
        text_ += listed_ ? fmt::format("i {}\n", file) : "";
    }
    const std::string& text() const { return text_; }

  private:
    static constexpr std::array<std::string_view, 3> close_steps = {"search", "middle", "peak"};

    bool stacks_are_pairs_;
    std::string text_;
    std::string series_;                          // series of the last image
    bool listed_ = false;                         // whether the last image's set is listed
    std::set<std::pair<bool, std::string>> sets_; // whether a set is a pair, and the line that begins it
};

} // namespace

void run_camera(const CommandOptions& options) {
    const auto own = options.of<CameraCommandOptions>();
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    if (!configuration.camera) {
        throw InputError({.where = {.file = configuration.file},
                          .key = "camera",
                          .found = "no table",
                          .expected = "a camera to measure",
                          .remedy = "Add [camera] with preset = \"IMX250\", or with values of your own."});
    }
    const camera::Camera camera(*configuration.camera, configuration.instrument.spectrum);
    ResultFolder results(options.out.value_or(options.file.stem().string() + "-camera"));
    std::string list = "file,series,photons,exposure_s\n";
    DescriptorFile descriptor(camera.options().bit_depth, own.pixels, own.pixels, own.averaged);
    camera::ImageTaker take;
    if (own.images) {
        constexpr int bits_of_bytes = 8;
        const auto type = camera.options().bit_depth > bits_of_bytes ? scan::PixelType::uint16 : scan::PixelType::uint8;
        take = [&results, &list, &descriptor, type](const camera::TakenImage& what, const Grid<float>& image) {
            const std::string file = "images/" + what.file + ".tif";
            results.write(file, scan::frame_bytes(image, type, 0, "grey values in DN"));
            list += fmt::format("{},{},{},{}\n", file, what.series, what.photons, what.exposure_time);
            descriptor.add(what, file);
        };
    }
    const auto measurement = measurement::measure_camera(
        camera, {.columns = own.pixels, .rows = own.pixels, .averaged = own.averaged}, take);
    results.write("camera.json", json_text(measurement::camera_json(measurement)) + "\n");
    results.write("transfer.csv", measurement::transfer_table(measurement));
    results.write("photon_transfer.svg", measurement::transfer_chart(measurement));
    results.write("signal_to_noise.svg", measurement::signal_to_noise_chart(measurement));
    results.write("linearity.svg", measurement::linearity_chart(measurement));
    if (own.images) {
        results.write("images.csv", list);
        results.write("emva1288.txt", descriptor.text());
    }
    results.write_checksums();
    for (const auto& warnings : {measurement::warnings_of(camera), measurement::warnings_of(measurement)}) {
        log_warnings(warnings);
    }
    print_text(measurement::summary(measurement));
}

} // namespace vkfv::app
