#include "measurement/beginning/data_sheet.hpp"

#include "camera/sensors.hpp"
#include "core/files/assets.hpp"
#include "core/messages/error.hpp"
#include "core/toml/toml_reader.hpp"
#include "optics/media/light_emitting_diodes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <vector>

namespace vkfv::measurement {

namespace {

[[noreturn]] void refuse_word(const char* option, std::string_view found, std::string expected, std::string remedy) {
    throw InputError({.where = {.file = "command line"},
                      .key = option,
                      .found = std::string(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

// The class reads a text from its front and leaves the text as it is where it does not fit.
class Words {
  public:
    explicit Words(std::string_view text) : left_(text) {}

    bool take(std::string_view word) {
        if (!left_.starts_with(word)) {
            return false;
        }
        left_.remove_prefix(word.size());
        return true;
    }
    // A positive, finite number.
    std::optional<double> number() {
        double value = 0;
        const auto [end, error] = std::from_chars(left_.data(), left_.data() + left_.size(), value);
        if (error != std::errc() || !(value > 0 && std::isfinite(value))) {
            return std::nullopt;
        }
        left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
        return value;
    }
    std::optional<int> whole() {
        int value = 0;
        const auto [end, error] = std::from_chars(left_.data(), left_.data() + left_.size(), value);
        if (error != std::errc() || value <= 0) {
            return std::nullopt;
        }
        left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
        return value;
    }
    // A length with its unit, converted to mm.
    std::optional<double> length() {
        const auto value = number();
        constexpr std::pair<std::string_view, double> units[] = {{"nm", 1e6}, {"um", 1e3}, {"mm", 1}};
        for (const auto& [unit, per_mm] : units) {
            if (value && take(unit)) {
                return *value / per_mm;
            }
        }
        return std::nullopt;
    }
    bool ended() const { return left_.empty(); }
    std::string_view left() const { return left_; }

  private:
    std::string_view left_;
};

// Reads "20x/0.45" or "20x_0.45"; `between` is the text between the magnification and the aperture.
bool read_power(Words words, std::string_view between, SheetObjective& objective) {
    const auto magnification = words.number();
    if (!magnification || !words.take("x") || !words.take(between)) {
        return false;
    }
    const auto aperture = words.number();
    if (!aperture || !words.ended()) {
        return false;
    }
    objective.magnification = *magnification;
    objective.numerical_aperture = *aperture;
    return true;
}

template <class Named>
std::vector<std::string> names_of(const Named& all) {
    std::vector<std::string> names;
    std::ranges::transform(all, std::back_inserter(names), [](const auto& one) { return std::string(one.name); });
    return names;
}

std::string meant(std::string_view word, const std::vector<std::string>& names) {
    const auto nearest = nearest_word(word, names);
    return nearest ? fmt::format("Did you mean {}? ", *nearest) : std::string();
}

// The length (mm) that a text consists of, as "10um" behind "step:". There is no value if the text is anything else.
std::optional<double> only_length(std::string_view text) {
    Words words(text);
    const auto length = words.length();
    return words.ended() ? length : std::nullopt;
}

} // namespace

double SheetObjective::focal_length() const {
    return kind == Kind::telecentric ? working_distance.value_or(0) : tube_length / magnification;
}

SheetObjective parse_objective(std::string_view text) {
    constexpr const char* option = "--objective";
    SheetObjective objective;
    objective.text = text;
    Words words(text);
    if (words.take("telecentric:")) {
        objective.kind = SheetObjective::Kind::telecentric;
    }
    if (!read_power(words, "/", objective)) {
        const auto names = asset_names("objectives", std::filesystem::current_path());
        objective.kind = SheetObjective::Kind::prescription;
        if (std::ranges::find(names, text) == names.end() || !read_power(words, "_", objective)) {
            refuse_word(option, text,
                        "magnification and numerical aperture as \"20x/0.45\", \"telecentric:2x/0.1\", or one of "
                        "vkfv list objectives",
                        meant(text, names) + "Write them as the data sheet has them.");
        }
    }
    if (!(objective.numerical_aperture < 1)) {
        refuse_word(option, text, "a numerical aperture below 1, as of an objective in air",
                    "Choose a smaller one; objective.immersion of the configuration is for others.");
    }
    return objective;
}

SheetCamera parse_camera(std::string_view text) {
    constexpr const char* option = "--camera";
    SheetCamera camera;
    camera.text = text;
    for (const auto& sensor : camera::sensors()) {
        if (sensor.name == text) {
            camera.sensor = sensor.name;
            camera.columns = sensor.columns;
            camera.rows = sensor.rows;
            camera.pixel_um = sensor.pixel_um;
            return camera;
        }
    }
    const auto read_pixels = [&](Words& words) {
        const auto columns = words.whole();
        const auto rows = columns && words.take("x") ? words.whole() : std::nullopt;
        camera.columns = columns.value_or(0);
        camera.rows = rows.value_or(0);
        return rows.has_value();
    };
    Words by_pitch(text);
    if (read_pixels(by_pitch) && by_pitch.take("@")) {
        if (const auto pitch = only_length(by_pitch.left())) {
            camera.pixel_um = 1e3 * *pitch;
            return camera;
        }
    }
    for (const auto& format : camera::sensor_formats()) {
        Words words(text);
        if (words.take(format.name) && words.take(":") && read_pixels(words) && words.ended()) {
            camera.pixel_um = 1e3 * format.width / camera.columns;
            return camera;
        }
    }
    const auto names = names_of(camera::sensors());
    refuse_word(option, text,
                fmt::format("one of {}, pixels and their size as \"2448x2048@3.45um\", or optical format and pixels as "
                            "\"2/3:2448x2048\"",
                            fmt::join(names, ", ")),
                meant(text, names) + "vkfv list cameras tells of each.");
}

SheetLight parse_light(std::string_view text) {
    SheetLight light;
    light.text = text;
    if (text == "coaxial") {
        return light;
    }
    light.ring = true;
    if (text == "ring") {
        return light;
    }
    Words words(text);
    if (words.take("ring:")) {
        const auto inner = words.number();
        const auto outer = inner && words.take("-") ? words.length() : std::nullopt;
        if (outer && *outer > *inner && words.take("@")) {
            light.inner_diameter = *inner;
            light.outer_diameter = *outer;
            light.working_distance = only_length(words.left());
            if (light.working_distance) {
                return light;
            }
            light.elevation = words.number();
            if (light.elevation && *light.elevation < 90 && words.take("deg") && words.ended()) {
                return light;
            }
        }
    }
    refuse_word("--light", text,
                "coaxial, ring, or a ring by inner and outer diameter and its height over the focus or the elevation "
                "of its light: \"ring:40-60mm@15mm\", \"ring:40-60mm@30deg\"",
                "Correct it.");
}

SheetLed parse_led(std::string_view text) {
    SheetLed led;
    led.text = text;
    for (const auto& colour : optics::led_colours()) {
        if (colour.name == text) {
            led.colour = colour.name;
            led.peak_um = colour.peak_um;
            led.full_width_um = colour.full_width_um;
            return led;
        }
    }
    constexpr double usual_width_um = 0.02;
    constexpr double shortest_um = 0.2, longest_um = 2;
    Words words(text);
    if (const auto peak = words.length()) {
        led.peak_um = 1e3 * *peak;
        led.full_width_um = usual_width_um;
        bool read = words.ended();
        if (words.take("/")) {
            const auto width = only_length(words.left());
            led.full_width_um = 1e3 * width.value_or(0);
            read = width && led.full_width_um < led.peak_um;
        }
        if (read && led.peak_um >= shortest_um && led.peak_um <= longest_um) {
            return led;
        }
    }
    const auto names = names_of(optics::led_colours());
    refuse_word("--led", text,
                fmt::format("one of {}, a peak from 200 nm to 2000 nm as \"460nm\", or peak and width at half maximum "
                            "as \"460nm/25nm\"",
                            fmt::join(names, ", ")),
                meant(text, names) + "vkfv list leds tells of each.");
}

SheetSpecimen parse_specimen(std::string_view text) {
    SheetSpecimen specimen;
    specimen.text = text;
    Words words(text);
    if (text == "plane") {
        return specimen;
    }
    if (words.take("step:")) {
        specimen.kind = SheetSpecimen::Kind::step;
        if (const auto height = only_length(words.left())) {
            specimen.height = *height;
            return specimen;
        }
    } else if (words.take("sphere:")) {
        specimen.kind = SheetSpecimen::Kind::sphere;
        if (const auto radius = only_length(words.left())) {
            specimen.length = *radius;
            return specimen;
        }
    } else if (words.take("sinusoid:")) {
        specimen.kind = SheetSpecimen::Kind::sinusoid;
        const auto height = words.length();
        const auto period = height && words.take("/") ? only_length(words.left()) : std::nullopt;
        if (period) {
            specimen.height = *height;
            specimen.length = *period;
            return specimen;
        }
    } else if (std::error_code code; std::filesystem::is_regular_file(text, code)) {
        specimen.kind = SheetSpecimen::Kind::surface;
        specimen.file = text;
        return specimen;
    }
    refuse_word("--specimen", text,
                "plane, step:10um, sphere:1mm (its radius), sinusoid:2um/50um (height and period), or the file of a "
                "measured surface",
                "Correct it; vkfv explain specimen tells of all kinds that a configuration can name.");
}

} // namespace vkfv::measurement
