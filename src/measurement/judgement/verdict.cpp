#include "measurement/judgement/verdict.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::measurement {

namespace {

// Codes of warnings after which no heights are measured, and of those after which some are missing or doubtful.
constexpr std::array leave_none = {"specimen-not-seen", "scan-in-depth-of-field", "few-rays", "no-texture",
                                   "wide-window",       "objective-turned-round", "no-light", "memory"};
constexpr std::array leave_some = {"scan-misses-specimen", "scan-misses-curved-field", "sparse-field",
                                   "ring-in-objective",    "waves-do-not-hold",        "relief-of-phase",
                                   "coarse-steps"};
// The least ratio of texture to noise. Below it, most points are left out because they are no better than chance.
constexpr double least_over_noise = 1;

template <std::size_t Count>
const Warning* first_of(const std::vector<Warning>& warnings, const std::array<const char*, Count>& codes) {
    const auto found = std::ranges::find_if(warnings, [&](const Warning& warning) {
        return std::ranges::any_of(codes, [&](const char* code) { return warning.code == code; });
    });
    return found == warnings.end() ? nullptr : &*found;
}

std::string text_in_um(double mm) {
    return fmt::format("{:.2g} um", mm * um_per_mm);
}

// The shares by slope that are at least half a percent.
std::string slopes_text(const Expectation& expected) {
    std::string text;
    double from = 0;
    for (std::size_t k = 0; k < Expectation::slope_bounds.size(); ++k) {
        const double share = expected.slope_shares[k], to = Expectation::slope_bounds[k];
        if (share >= 0.005) {
            text += fmt::format("{}{:.0f} % of the points slope by {:g} to {:g} deg", text.empty() ? "" : ", ",
                                100 * share, from, to);
        }
        from = to;
    }
    return text;
}

// A sentence that names the largest part of the uncertainty, or of the noise.
std::string limit_text(const Configuration& configuration, const Expectation& expected) {
    const double noise = expected.height_noise, whole = expected.height_uncertainty;
    if (noise > std::sqrt(0.5) * whole) {
        const bool by_camera = expected.camera_noise > expected.ray_noise;
        return by_camera ? "The camera's noise limits it: more light or frames help."
                         : fmt::format("The noise of the rays limits it{}: four times as many rays halve it.",
                                       configuration.camera ? "" : ", which no instrument has");
    }
    return "The texture within a window limits it, by relief that a window of topography.window_px sees at once, or "
           "the curved field: a smaller window or finer pixels help more than rays.";
}

} // namespace

Verdict verdict_on(const Configuration& configuration, const optics::Instrument& instrument,
                   const std::optional<Expectation>& expected, const std::vector<Warning>& warnings) {
    Verdict verdict;
    auto& sentences = verdict.sentences;
    const auto& first_order = instrument.first_order;
    const Warning* none = first_of(warnings, leave_none);
    const Warning* some = first_of(warnings, leave_some);
    // The sample shows the middle alone. Edges elsewhere are in focus somewhere, even on a specimen without texture.
    constexpr double all_alike = 0.99; // share of the points in one range of slopes
    if (none != nullptr && none->code == "no-texture" && expected &&
        *std::ranges::max_element(expected->slope_shares) < all_alike) {
        some = none;
        none = nullptr;
    }
    // The instrument sees a specimen without texture by its edges alone, and the sample need not have an edge.
    const bool edges_alone = some != nullptr && some->code == "no-texture";
    const bool in_noise =
        expected && none == nullptr && !edges_alone && expected->texture_over_noise < least_over_noise;
    verdict.measurable = none != nullptr || in_noise                    ? Verdict::Measurable::no
                         : !expected                                    ? Verdict::Measurable::unknown
                         : some != nullptr                              ? Verdict::Measurable::partly
                         : expected && expected->measurable_share < 0.9 ? Verdict::Measurable::partly
                                                                        : Verdict::Measurable::yes;
    if (none != nullptr) {
        sentences.push_back(none->sentence);
    } else if (in_noise) {
        sentences.push_back(fmt::format("The texture is hidden by noise, {:.2g} times as strong as what focus is seen "
                                        "by: most points will be left out.",
                                        1 / expected->texture_over_noise));
    }
    if (!expected) {
        sentences.push_back(
            fmt::format("An instrument of {:.3g}x/{:.3g} whose pixels see {}. What can be measured with it takes {}.",
                        std::abs(first_order.magnification), first_order.numerical_aperture,
                        text_in_um(first_order.pixel_pitch), !configuration.specimen ? "a [specimen]" : "a [scan]"));
        return verdict;
    }
    const std::string steepest = std::isnan(expected->steepest)
                                     ? std::string("though no light of a facet comes back")
                                     : fmt::format("and no steeper than {:.0f} deg, up to which its light comes back",
                                                   expected->steepest / radians_per_degree);
    const std::string slopes = slopes_text(*expected);
    sentences.push_back(fmt::format("{:.0f} % of the field can be in focus: the specimen is there, within the scan, {}."
                                    "{}",
                                    100 * expected->measurable_share, steepest,
                                    slopes.empty() ? "" : " " + slopes + "."));
    if (std::isfinite(expected->height_noise) && verdict.measurable != Verdict::Measurable::no) {
        sentences.push_back(fmt::format(
            "Expected of a height: noise {}, standard uncertainty {}. Waves of {} keep half of their height.",
            text_in_um(expected->height_noise), text_in_um(expected->height_uncertainty),
            text_in_um(expected->lateral_resolution)));
    }
    if (std::isfinite(expected->ray_noise)) {
        sentences.push_back(fmt::format(
            "Expected of an image: noise {:.2g} % of its brightness ({}), {}.", 100 * expected->image_noise(),
            configuration.camera
                ? fmt::format("camera {:.2g} %, rays {:.2g} %", 100 * expected->camera_noise, 100 * expected->ray_noise)
                : "of the rays",
            std::isfinite(expected->texture)
                ? fmt::format("texture {:.2g} %", 100 * expected->texture)
                : std::string("texture not known, since its light cannot be turned round")));
    }
    if (std::isfinite(expected->height_uncertainty) && verdict.measurable != Verdict::Measurable::no) {
        sentences.push_back(some != nullptr ? fmt::format("What limits it most: {}", some->sentence)
                                            : limit_text(configuration, *expected));
    }
    return verdict;
}

std::string wrapped(std::string_view text, std::size_t indentation) {
    constexpr std::size_t width = 110;
    std::string result, line(indentation, ' ');
    bool empty = true;
    std::size_t from = 0;
    while (from < text.size()) {
        const std::size_t to = std::min(text.find(' ', from), text.size());
        const std::string_view word = text.substr(from, to - from);
        if (!empty && line.size() + 1 + word.size() > width) {
            result += line + "\n";
            line.assign(indentation, ' ');
            empty = true;
        }
        line += empty ? "" : " ";
        line += word;
        empty = false;
        from = to + 1;
    }
    return result + line + "\n";
}

std::string verdict_text(const std::string& file, const Verdict& verdict) {
    const char* const answer = verdict.measurable == Verdict::Measurable::yes      ? ", can be measured"
                               : verdict.measurable == Verdict::Measurable::partly ? ", can be measured in part"
                               : verdict.measurable == Verdict::Measurable::no     ? ", cannot be measured"
                                                                                   : "";
    std::string text = fmt::format("{}: valid{}\n", file, answer);
    for (const std::string& sentence : verdict.sentences) {
        text += wrapped(sentence, 2);
    }
    return text;
}

std::string warnings_text(const std::vector<Warning>& warnings) {
    std::string text;
    for (const Warning& warning : warnings) {
        text += "  warning: " + warning.sentence + "\n"; // in one line, so that a search finds all of it
        if (const std::string remedy = remedy_text(warning); !remedy.empty()) {
            text += wrapped(remedy, 4);
        }
    }
    return text;
}

} // namespace vkfv::measurement
