// The table [stage]: its keys and its reader.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv {

namespace {

enum class Direction { up, down };
enum class Positions { nominal, read };

const NumberKey scale_error("scale_error", NumberRange::between(-0.5, 0.5), 0.0,
                            "Relative error of the scale: heights come out 1 + this times as large.");
const NumbersKey linearity_at("linearity_at_um", NumberRange::finite(), Default::in_words("none"),
                              "Positions, ascending, at which the scale's error is known.");
const NumbersKey linearity("linearity_um", NumberRange::finite(), Default::in_words("none"),
                           "The scale's error there: what it reads, less where it is; linear between.");
const NumberKey periodic_amplitude("periodic_um", NumberRange::at_least(0), 0.0,
                                   "Amplitude of the scale's periodic error.");
const NumberKey periodic_period("period_um", NumberRange::positive(), 20.0, "Its period.");
const NumberKey periodic_phase("phase_deg", tilt_range_deg, 0.0, "Its phase at z = 0.");
const NumberKey jitter("jitter_um", NumberRange::at_least(0), 0.0,
                       "Standard deviation of each position, independent of all others.");
const NumberKey backlash("backlash_um", NumberRange::at_least(0), 0.0, "Of a scan downwards: what the stage lags.");
const NumberKey drift("drift_um_per_s", NumberRange::finite(), 0.0,
                      "Of the focal plane upwards, between objective and specimen: no scale sees it.");
const NumbersKey vibration("vibration_um", NumberRange::at_least(0), Default::in_words("none"),
                           "Amplitudes of sines along the axis, of random phases; no scale sees them.");
const NumbersKey frequency("vibration_hz", NumberRange::positive(), Default::in_words("none"), "Their frequencies.");
const NumbersKey spectrum_at("vibration_spectrum_hz", NumberRange::at_least(0), Default::in_words("none"),
                             "Frequencies, ascending, at which the spectrum of further vibration is known.");
const NumbersKey spectrum("vibration_spectrum_um2_per_hz", NumberRange::at_least(0), Default::in_words("none"),
                          "One-sided power spectral density there; linear between, nothing beyond. The root of its "
                          "integral is the vibration's root mean square.");
const NumbersKey lateral_drift("lateral_drift_um_per_s", NumberRange::finite(), Default::in_words("none"),
                               "[x, y], of the specimen.");
const NumbersKey tilt("tilt_deg", NumberRange::between(-45, 45), Default::in_words("none"),
                      "[x, y], of the stage's way against the optical axis: the specimen moves aside with z.");
const NumberKey runout("runout_um", NumberRange::at_least(0), 0.0,
                       "Radius of the circle that the specimen goes round as the spindle turns.");
const NumberKey runout_period("runout_period_um", NumberRange::positive(), 500.0, "Way of a turn.");
const NumberKey light_noise("light_noise", NumberRange::within(0, 0.5), 0.0,
                            "Relative standard deviation of the lamp's power from image to image.");
const ChoiceKey<Direction> direction("direction",
                                     {{Direction::up, "up", "from the lowest position"},
                                      {Direction::down, "down", "from the highest, after coming to it from below"}},
                                     Direction::up, "In which the images are taken.");
const NumberKey interval("interval_s", NumberRange::positive(), 0.1, "From image to image.");
const NumberKey exposure("exposure_s", NumberRange::at_least(0), Default::in_words("camera.exposure_ms, or 0"),
                         "Within which vibrations blur; 0: they shift images whole.");
const IntegerKey moments("moments", 2, 1000, 8, "Of an exposure at which a vibrating stage is looked at.");
const NumberKey reading_noise =
    without_influence(NumberKey("reading_noise_um", NumberRange::at_least(0), 0.0,
                                "Standard deviation of what the scale says, beyond its errors."));
const ChoiceKey<Positions> positions = without_influence(
    ChoiceKey<Positions>("evaluate",
                         {{Positions::nominal, "nominal", "heights by the positions asked for"},
                          {Positions::read, "read", "by what the scale read: without jitter and backlash"}},
                         Positions::nominal, "Which positions the heights are told by."));
const IntegerKey stage_seed("seed", 0, largest_seed, 1, "Of jitter, readings, vibrations and the lamp.");

glm::dvec2 pair(const Section& section, const NumbersKey& key) {
    if (!section.has(key)) {
        return glm::dvec2(0);
    }
    const auto values = section.numbers(key);
    if (values.size() != 2) {
        section.fail(key, "two numbers, [x, y]", "Give one for each axis.");
    }
    return {values[0], values[1]};
}

// Reads two lists that must be given together.
std::pair<std::vector<double>, std::vector<double>> lists(const Section& section, const NumbersKey& first,
                                                          const NumbersKey& second) {
    if (section.has(first) != section.has(second)) {
        const NumbersKey& given = section.has(first) ? first : second;
        const NumbersKey& lacking = section.has(first) ? second : first;
        section.fail(given, fmt::format("{} beside it", lacking.name), fmt::format("Add {}.", lacking.name));
    }
    if (!section.has(first)) {
        return {};
    }
    auto a = section.numbers(first);
    auto b = section.numbers(second);
    if (a.size() != b.size()) {
        section.fail(second, fmt::format("as many numbers as {} has, {}", first.name, a.size()), "Give one for each.");
    }
    return {std::move(a), std::move(b)};
}

} // namespace

const KeyTable& stage_keys() {
    static const KeyTable table{
        .path = "stage",
        .presence = KeyTable::Presence::optional,
        .meaning = "What a real stage does to the positions of a scan, and the lamp meanwhile. Without it they are "
                   "true.",
        .subject = "a stage",
        .kind = "",
        .keys = {&scale_error,     &linearity_at,   &linearity,     &periodic_amplitude,
                 &periodic_period, &periodic_phase, &jitter,        &backlash,
                 &drift,           &vibration,      &frequency,     &spectrum_at,
                 &spectrum,        &lateral_drift,  &tilt,          &runout,
                 &runout_period,   &light_noise,    &direction,     &interval,
                 &exposure,        &moments,        &reading_noise, &positions,
                 &stage_seed}};
    return table;
}

void read_stage(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("stage");
    if (!table) {
        return;
    }
    const Section section(*table, stage_keys(), configuration);
    const auto in_mm = [](std::vector<double> values) {
        std::ranges::transform(values, values.begin(), [](double value) { return from_um(value); });
        return values;
    };
    scan::Stage stage;
    stage.scale_error = section.number(scale_error);
    auto [places, errors] = lists(section, linearity_at, linearity);
    if (!std::ranges::is_sorted(places, std::less_equal<>())) {
        section.fail(linearity_at, "ascending numbers", "Order the table by position.");
    }
    stage.linearity_positions = in_mm(std::move(places));
    stage.linearity_errors = in_mm(std::move(errors));
    stage.periodic_amplitude = from_um(section.number(periodic_amplitude));
    stage.periodic_period = from_um(section.number(periodic_period));
    stage.periodic_phase = section.number(periodic_phase) * radians_per_degree;
    stage.jitter = from_um(section.number(jitter));
    stage.backlash = from_um(section.number(backlash));
    stage.drift = from_um(section.number(drift));
    auto [amplitudes, frequencies] = lists(section, vibration, frequency);
    for (std::size_t k = 0; k < amplitudes.size(); ++k) {
        stage.vibrations.push_back({.amplitude = from_um(amplitudes[k]), .frequency = frequencies[k]});
    }
    auto [at, densities] = lists(section, spectrum_at, spectrum);
    if (!std::ranges::is_sorted(at, std::less_equal<>()) || at.size() == 1) {
        section.fail(spectrum_at, "two or more ascending numbers", "Order the table by frequency.");
    }
    stage.vibration_frequencies = std::move(at);
    for (const double density : densities) {
        stage.vibration_densities.push_back(density * mm_per_um * mm_per_um);
    }
    stage.lateral_drift = pair(section, lateral_drift) * mm_per_um;
    const glm::dvec2 degrees = pair(section, tilt);
    stage.tilt = {std::tan(degrees.x * radians_per_degree), std::tan(degrees.y * radians_per_degree)};
    stage.runout = from_um(section.number(runout));
    stage.runout_period = from_um(section.number(runout_period));
    stage.light_noise = section.number(light_noise);
    stage.downwards = section.choice(direction) == Direction::down;
    stage.interval = section.number(interval);
    const bool camera_tells = configuration.camera && configuration.camera->control == camera::ExposureControl::time;
    stage.exposure_time = section.number(exposure, camera_tells ? configuration.camera->exposure_time : 0);
    stage.moments = static_cast<int>(section.integer(moments));
    stage.reading_noise = from_um(section.number(reading_noise));
    stage.evaluate_read = section.choice(positions) == Positions::read;
    stage.seed = static_cast<std::uint32_t>(section.integer(stage_seed));
    configuration.stage = stage;
}

} // namespace vkfv
