#include "measurement/scene/wave_limits.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>

namespace vkfv::measurement {

namespace {

constexpr double most_error = 0.1;

WaveLimits limits_of(const optics::PupilFilter& filter, const optics::Instrument& instrument) {
    WaveLimits limits{.cells = static_cast<int>(filter.cells().side),
                      .tiles = filter.tiles().across(),
                      .parts = static_cast<int>(filter.cells().parts),
                      .asked_parts = optics::parts_for_waves(instrument),
                      .folded_contrast = filter.folded_contrast(),
                      .points = {}};
    const auto error_at = [&](glm::dvec2 field) { return optics::largest_filter_error(filter, instrument, field); };
    auto corner = std::async(std::launch::async, [&] { return error_at(instrument.first_order.field_corner); });
    limits.points.push_back({.name = "axis", .error = error_at(glm::dvec2(0))});
    limits.points.push_back({.name = "edge", .error = error_at(optics::edge_of(instrument))});
    limits.points.push_back({.name = "corner", .error = corner.get()});
    return limits;
}

bool have_one_spectrum(const optics::Instrument& a, const optics::Instrument& b) {
    const auto same = [](const physics::f64::SpectralBin& one, const physics::f64::SpectralBin& other) {
        return one.start == other.start && one.stop == other.stop && one.tilt == other.tilt &&
               one.cumulative == other.cumulative;
    };
    return std::ranges::equal(a.spectral_bins, b.spectral_bins, same);
}

// filter_of(k): the pupil filter of light k.
template <class FilterOf>
std::vector<WaveLimits> limits_of_each(const optics::Instrument& instrument, const FilterOf& filter_of) {
    std::vector<WaveLimits> all;
    const auto lights = instrument.lights();
    for (std::size_t k = 0; k < lights.size(); ++k) {
        const auto alike = std::find_if(lights.begin(), lights.begin() + static_cast<std::ptrdiff_t>(k),
                                        [&](const auto* earlier) { return have_one_spectrum(*earlier, *lights[k]); });
        const auto place = static_cast<std::size_t>(alike - lights.begin());
        if (place < k) {
            all.push_back(all[place]);
            continue;
        }
        const optics::PupilFilter& filter = filter_of(k);
        all.push_back(limits_of(filter, *lights[k]));
    }
    return all;
}

} // namespace

std::vector<WaveLimits> limits_of_lights(const std::vector<optics::PupilFilter>& filters,
                                         const optics::Instrument& instrument) {
    return limits_of_each(instrument, [&](std::size_t k) -> const optics::PupilFilter& { return filters[k]; });
}

std::vector<WaveLimits> limits_of_lights(const optics::WaveOptions& options, const optics::Instrument& instrument) {
    return limits_of_each(instrument,
                          [&](std::size_t k) { return optics::PupilFilter(*instrument.lights()[k], options); });
}

WaveLimits worst_of(const std::vector<WaveLimits>& limits) {
    WaveLimits worst = *std::ranges::max_element(limits, {}, &WaveLimits::asked_parts);
    for (const WaveLimits& one : limits) {
        worst.folded_contrast = std::max(worst.folded_contrast, one.folded_contrast);
        for (std::size_t point = 0; point < worst.points.size(); ++point) {
            if (one.points[point].error.difference > worst.points[point].error.difference) {
                worst.points[point] = one.points[point];
            }
        }
    }
    return worst;
}

std::vector<Warning> warnings_of(const WaveLimits& limits) {
    std::vector<Warning> warnings;
    const auto worst =
        std::ranges::max_element(limits.points, {}, [](const auto& point) { return point.error.difference; });
    if (worst != limits.points.end() && worst->error.difference > most_error) {
        const auto& error = worst->error;
        const bool of_cells = limits.points.front().error.difference > 0.5 * error.difference;
        const bool of_tiles = !of_cells && limits.tiles == 1;
        warnings.push_back(
            {.code = "coarse-waves",
             .key = of_tiles ? "diffraction.tiles" : "diffraction.cells",
             .value = std::to_string(of_tiles ? limits.tiles : limits.cells),
             .works = of_tiles ? "3" : std::to_string(2 * limits.cells),
             .sentence = fmt::format(
                 "Images as waves make them: {} the contrast of waves of {:.3g} um at z = {:.3g} um is off by {:.2g}, "
                 "phase "
                 "included ({:.2g} instead of {:.2g}). {}",
                 std::string_view(worst->name) == "axis" ? "in the middle of the field"
                                                         : fmt::format("at the {} of the field", worst->name),
                 um_per_mm / glm::length(error.frequency), error.height * um_per_mm, error.difference,
                 std::abs(error.filtered), std::abs(error.waves),
                 of_cells ? "Take more diffraction.cells."
                 : limits.tiles == 1
                     ? "The filter is that of the axis: trust what lies near it, or take diffraction.tiles = 3 or more."
                     : "Take more diffraction.tiles or diffraction.cells.")});
    }
    if (limits.folded_contrast > 0) {
        warnings.push_back(
            {.code = "folded-waves",
             .key = "diffraction.cells",
             .value = std::to_string(limits.cells),
             .works = "fewer, fewer detector.pixels, or a device with more memory",
             .sentence = fmt::format(
                 "Light of waves is sorted in {} parts of a pixel's side, where the numerical aperture asks for {}: "
                 "finer "
                 "waves fold back, and their contrast is off by up to {:.2g}. Take fewer detector.pixels, fewer "
                 "diffraction.cells, or a device with more memory.",
                 limits.parts, limits.asked_parts, limits.folded_contrast)});
    }
    return warnings;
}

nlohmann::ordered_json json_of(const WaveLimits& limits) {
    nlohmann::ordered_json json = {{"cells", limits.cells},
                                   {"tiles", limits.tiles},
                                   {"parts_per_pixel", limits.parts},
                                   {"parts_asked_for", limits.asked_parts},
                                   {"folded_contrast", limits.folded_contrast}};
    for (const auto& [name, error] : limits.points) {
        json[fmt::format("contrast_error_{}", name)] = error.difference;
    }
    return json;
}

std::string summary(const WaveLimits& limits) {
    std::string text = "largest error of contrast as the filters make it, within two depths of field\n";
    for (const auto& [name, error] : limits.points) {
        text += fmt::format("{:8} {:8.4f}  at {:.4g} cycles/mm, z = {:.4g} um: {:.4f} instead of {:.4f}\n", name,
                            error.difference, glm::length(error.frequency), error.height * um_per_mm,
                            std::abs(error.filtered), std::abs(error.waves));
    }
    return text;
}

} // namespace vkfv::measurement
