#include "measurement/scene/specimen_view.hpp"

#include "core/mathematics/pixel_grid.hpp"
#include "core/mathematics/units.hpp"
#include "specimen/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkfv::measurement {

namespace {

using Status = trace::Ledger::Status;

constexpr int most_relief_points = 128; // on a side, so that it takes a moment for any detector
constexpr double least_seen_share = 0.5;
// The share of light beside the specimen above which vkfv warns. Illumination is wider than most specimens, but beside
// a specimen in its place this much of it never falls.
constexpr double most_light_beside = 0.98;

constexpr const char* likely_causes =
    "A length may be in another unit than its key says (source.radius_mm, specimen.size_mm, specimen.unit), or the "
    "specimen "
    "off the axis; vkfv layout draws the instrument, vkfv check tells what the detector sees";

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

std::vector<Warning> warning_of_sparse_field(const specimen::Specimen& specimen, const Relief& relief) {
    if (relief.seen_share >= least_seen_share) {
        return {};
    }
    const auto record = specimen::footprint(specimen);
    const bool of_mesh = std::holds_alternative<specimen::Mesh>(specimen.geometry);
    const char* remedy = of_mesh ? "Correct specimen.unit, set centre = true, or look for a vertex far off in the file"
                                 : "Correct the lengths of [specimen] or [detector]";
    return {{.code = relief.seen_share > 0 ? "sparse-field" : "specimen-not-seen",
             .key = of_mesh ? "specimen.unit" : "specimen.size_mm",
             .value = {},
             .works = remedy,
             .sentence =
                 fmt::format("{}: it is {:.4g} x {:.4g} um across, from x = {:.4g} and y = {:.4g} um on. {}.",
                             relief.seen_share > 0
                                 ? fmt::format("The specimen fills {} of the field of view", percent(relief.seen_share))
                                 : std::string("The detector does not see the specimen"),
                             (record.x_max - record.x_min) * um_per_mm, (record.y_max - record.y_min) * um_per_mm,
                             record.x_min * um_per_mm, record.y_min * um_per_mm, remedy)}};
}

std::vector<Warning> warning_of_no_light(const Configuration& configuration, const optics::Instrument& instrument,
                                         std::uint64_t rays, const std::string& where) {
    const auto& splitter = configuration.instrument.splitter;
    const bool all_by_splitter = std::ranges::none_of(configuration.instrument.sources(),
                                                      [](const auto* source) { return source->ring.has_value(); });
    const auto impossible = [&](const char* key, const char* works, const std::string& why) {
        return std::vector<Warning>{{.code = "no-light",
                                     .key = key,
                                     .value = "0",
                                     .works = works,
                                     .sentence = fmt::format("No light can reach the detector: {}.", why)}};
    };
    if (all_by_splitter && splitter.reflectance == 0) {
        return impossible("beam_splitter.reflectance", "0.5", "the beam splitter reflects none of it to the specimen");
    }
    if (splitter.transmittance == 0) {
        return impossible("beam_splitter.transmittance", "0.5", "the beam splitter lets none of it pass");
    }
    if (configuration.specimen && configuration.specimen->material.lobes.empty()) {
        return impossible("specimen.material", "a scatter model", "the specimen absorbs all of it");
    }
    const auto of_rays = [&](const std::string& bound) {
        return std::vector<Warning>{
            {.code = "no-ray-arrived",
             .key = "trace.rays",
             .value = std::to_string(configuration.trace.rays),
             .works = "more rays, or what brings light there",
             .sentence = fmt::format("No ray of {} arrived at the detector{}.{} {}; or launch more rays.", rays, bound,
                                     where, likely_causes)}};
    };
    if (configuration.trace.estimator == trace::Estimator::backward) { // backward paths carry no shares of the flux
        return of_rays("");
    }
    double launched = 0; // W, carried by all rays in equal parts
    for (const auto* light : instrument.lights()) {
        launched +=
            light->flux * light->aimed_share() *
            (configuration.trace.nonsequential ? 1 : light->splitter_reflectance * light->splitter_transmittance);
    }
    constexpr double error = 0.05;
    const double share = 1 - std::pow(error, 1 / static_cast<double>(rays));
    return of_rays(fmt::format(": at most {:.2g} W of the {:.3g} W that were sent out come there, with 95 % confidence",
                               share * launched, launched));
}

std::vector<Warning> warning_of_lost_light(const Configuration& configuration, const optics::Instrument& instrument,
                                           const trace::Image& image) {
    const auto& ledger = image.ledger;
    const double detected = std::accumulate(image.flux.values.begin(), image.flux.values.end(), 0.0);
    if (!(detected > 0)) {
        const auto most = std::ranges::max_element(ledger.entries, {}, [](const auto& entry) {
            return entry.status == Status::not_aimed_at ? 0.0 : entry.power; // it could not pass
        });
        const std::string where = most == ledger.entries.end() || !(most->power > 0)
                                      ? ""
                                      : fmt::format(" Most of it ends as \"{}\" ({} of what is emitted).", most->name,
                                                    percent(most->power / ledger.emitted));
        return warning_of_no_light(configuration, instrument, image.rays, where);
    }
    const double brightest = *std::ranges::max_element(image.flux.values);
    if (brightest < std::numeric_limits<float>::min()) {
        return {{.code = "faint-light",
                 .key = "source.flux_W",
                 .value = {},
                 .works = "more flux",
                 .sentence = fmt::format(
                     "The brightest pixel has {:.3g} W, and an image holds no less than {:.3g} W: its pixels are 0 "
                     "or lose their digits. A transmittance or reflectance may be too small; source.flux_W "
                     "scales all light.",
                     brightest, std::numeric_limits<float>::min())}};
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
        return {{.code = "light-beside-specimen",
                 .key = "specimen.size_mm",
                 .value = {},
                 .works = "a length in the key's unit, or a specimen on the axis",
                 .sentence = fmt::format("{} of the light that comes as far falls beside the specimen. {}.",
                                         percent(beside / (beside + met)), likely_causes)}};
    }
    return {};
}

} // namespace vkfv::measurement
