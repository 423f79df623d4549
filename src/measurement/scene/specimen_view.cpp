#include "measurement/scene/specimen_view.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "core/mathematics/units.hpp"
#include "specimen/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace vkfv::measurement {

namespace {

using Status = trace::Ledger::Status;

constexpr int most_relief_points = 128; // a side; a look at the specimen, in a moment for any detector
constexpr double least_seen_share = 0.5;
// Illumination is wider than most specimens; beside a specimen that is where it should be, this much never falls.
constexpr double most_light_beside = 0.98;

constexpr const char* likely_causes =
    "A length may be in another unit than its key says (source.radius_mm, specimen.size_mm, specimen.unit), or the "
    "specimen "
    "off the axis; --layout draws the instrument, --check tells what the detector sees";

std::string percent(double share) {
    return fmt::format("{:.3g} %", 100 * share);
}

} // namespace

Relief relief_of(const specimen::Specimen& specimen, ImageSize pixels, double pitch) {
    const int columns = std::min(pixels.columns, most_relief_points);
    const int rows = std::min(pixels.rows, most_relief_points);
    const auto grid = PixelGrid::centred(columns, rows, pitch * pixels.columns / columns, pitch * pixels.rows / rows);
    const auto truth = specimen::truth(specimen, columns, rows, grid.x0, grid.y0, grid.pitch_x, grid.pitch_y);
    Relief relief;
    std::size_t seen = 0;
    for (const double height : truth.height.values) {
        if (std::isfinite(height)) {
            relief.lowest = std::min(relief.lowest, height);
            relief.highest = std::max(relief.highest, height);
            ++seen;
        }
    }
    relief.seen_share = static_cast<double>(seen) / static_cast<double>(truth.height.values.size());
    return relief;
}

std::vector<std::string> warning_of_sparse_field(const specimen::Specimen& specimen, const Relief& relief) {
    if (relief.seen_share >= least_seen_share) {
        return {};
    }
    const auto record = specimen::footprint(specimen);
    const bool of_mesh = std::holds_alternative<specimen::Mesh>(specimen.geometry);
    const char* remedy = of_mesh ? "Correct specimen.unit, set centre = true, or look for a vertex far off in the file"
                                 : "Correct the lengths of [specimen] or [detector]";
    return {fmt::format("{}: it is {:.4g} x {:.4g} um across, from x = {:.4g} and y = {:.4g} um on. {}.",
                        relief.seen_share > 0
                            ? fmt::format("The specimen fills {} of the field of view", percent(relief.seen_share))
                            : std::string("The detector does not see the specimen"),
                        (record.x_max - record.x_min) * um_per_mm, (record.y_max - record.y_min) * um_per_mm,
                        record.x_min * um_per_mm, record.y_min * um_per_mm, remedy)};
}

std::vector<std::string> warning_of_lost_light(const trace::Image& image) {
    const auto& ledger = image.ledger;
    const double detected = std::accumulate(image.flux.values.begin(), image.flux.values.end(), 0.0);
    if (!(detected > 0)) {
        const auto most = std::ranges::max_element(ledger.entries, {}, [](const auto& entry) {
            return entry.status == Status::not_aimed_at ? 0.0 : entry.power; // what cannot pass at all
        });
        const std::string where = most == ledger.entries.end() || !(most->power > 0)
                                      ? ""
                                      : fmt::format(" Most of it ends as \"{}\" ({} of what is emitted).", most->name,
                                                    percent(most->power / ledger.emitted));
        return {fmt::format("No light reaches the detector.{} {}; or launch more rays.", where, likely_causes)};
    }
    const double brightest = *std::ranges::max_element(image.flux.values);
    if (brightest < std::numeric_limits<float>::min()) {
        return {
            fmt::format("The brightest pixel has {:.3g} W, and an image holds no less than {:.3g} W: its pixels are 0 "
                        "or lose their digits. A transmittance or reflectance may be too small; source.flux_W "
                        "scales all light.",
                        brightest, std::numeric_limits<float>::min())};
    }
    double beside = 0, met = 0;
    for (const auto& entry : ledger.entries) {
        beside += entry.status == Status::beside_specimen ? entry.power : 0;
        met += entry.status == Status::detected || entry.status == Status::outside_pupil ||
                       entry.status == Status::bounce_limit || entry.status == Status::beside_detector ||
                       entry.status == Status::absorbed
                   ? entry.power
                   : 0;
    }
    if (beside > most_light_beside * (beside + met)) {
        return {fmt::format("{} of the light that comes as far falls beside the specimen. {}.",
                            percent(beside / (beside + met)), likely_causes)};
    }
    return {};
}

} // namespace vkfv::measurement
