#include "measurement/sweep/sweep_rows.hpp"

#include "core/files/digest.hpp"
#include "core/files/file.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/json_text.hpp"
#include "images/image_file.hpp"
#include "measurement/image/exposure.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/specimen_view.hpp"
#include "scan/store.hpp"

#include "trace/interface/ledger.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace vkfv::measurement {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double wanted_ratio = 100; // signal to noise for which the table tells the rays

Json read_json(const fs::path& path) {
    auto parsed = Json::parse(read_file(path), nullptr, false);
    return parsed.is_object() ? parsed : Json();
}

Json figures_of(const trace::Image& image, bool ledger_tells) {
    double flux = 0, square = 0;
    for (const double value : image.flux.values) {
        flux += value;
        square += value * value;
    }
    const auto pixels = static_cast<double>(image.flux.values.size());
    const double mean = flux / pixels, ratio = signal_to_noise(image);
    Json figures;
    figures["signal to noise"] = sweep_figure(ratio);
    // The variance of the pixels without that of their noise, over the squared mean.
    const double variance = square / pixels / (mean * mean) - 1 - 1 / (ratio * ratio);
    figures["contrast"] = sweep_figure(std::isnan(variance) ? variance : std::sqrt(std::max(0.0, variance)));
    const auto share = ledger_tells ? trace::share_collected(image.ledger) : std::nullopt;
    figures["share collected"] = share ? Json(*share) : Json();
    figures["detected / emitted"] = flux / image.ledger.emitted;
    figures["detected rays a pixel"] = static_cast<double>(image.detected) / pixels;
    figures[fmt::format("rays for a ratio of {:g}", wanted_ratio)] =
        sweep_figure(static_cast<double>(image.rays) * std::pow(wanted_ratio / ratio, 2));
    return figures;
}

// The digest that tells whether an earlier image is the same: it covers everything that decides the image's bits and
// the files beside it.
std::string image_digest(const Configuration& configuration, const std::string& identity, double focal_height) {
    const auto& blur = configuration.diffraction;
    return Digest()
        .add(fmt::format("{}z = {}\nblur = {} {}\n", identity, focal_height, blur.airy, blur.pitch))
        .add(blur.file.empty() ? std::string() : read_file(blur.file, {.key = "diffraction.file"}))
        .text();
}

} // namespace

SweepRow image_row(const Configuration& configuration, ResultFolder& results, const fs::path& name, Surfaces& surfaces,
                   StackRuns& runs) {
    const double focal_height = configuration.sweep->focal_height;
    const fs::path image_name = name / "image.tif", figures_name = name / "image.json";
    const auto& surface = surfaces.of(configuration);
    const auto instrument = instrument_for(configuration, surface.specimen, focal_height);
    const auto tracer = trace::expected_identity(instrument, surface.specimen, configuration.trace);
    const std::string digest =
        image_digest(configuration, image_identity(configuration, surface.digest, tracer), focal_height);
    SweepRow row;
    const bool whole =
        results.holds(image_name) && results.holds(figures_name) &&
        (!configuration.diffraction.any() || configuration.camera || results.holds(name / "image_diffracted.tif"));
    const Json earlier = whole ? read_json(results.path() / figures_name) : Json::object();
    if (earlier.value("digest", "") == digest) {
        row.figures = earlier.at("figures");
        row.device = earlier.value("device", "");
        leave_out_work(1);
    } else {
        const Exposure exposure =
            expose(configuration, runs.devices_of(configuration), instrument, surface.specimen, focal_height);
        log_warnings(warning_of_lost_light(configuration, instrument, exposure.image));
        const bool tells =
            configuration.trace.estimator == trace::Estimator::forward && !configuration.trace.directed_scatter;
        row.figures = figures_of(exposure.image, tells);
        row.device = exposure.tracer.text();
        for (const auto& [file, bytes] : image_files(image_name, exposure, focal_height)) {
            results.write(file, bytes);
        }
        results.write(figures_name,
                      json_text(Json{{"digest", digest}, {"device", row.device}, {"figures", row.figures}}) + "\n");
        results.write_checksums();
        scan::append_timing(results.path(), name.string(), exposure.image.seconds,
                            static_cast<double>(exposure.image.rays));
        spdlog::info("traced in {:.3g} s", exposure.image.seconds);
    }
    row.picture = images::read_image(results.path() / image_name);
    return row;
}

} // namespace vkfv::measurement
