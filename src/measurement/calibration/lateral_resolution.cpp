// Lateral period limit D_LIM, instrument transfer function and topographic spatial resolution W_R: ISO 25178-600.
#include "core/mathematics/units.hpp"
#include "dimensions/transfer.hpp"
#include "measurement/calibration/standards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace vkfv::measurement {

namespace {
namespace of_transfer { // files of a unity build share the unnamed namespace

// The unit of periods (mm): the pixel, or an eighth of the resolution of the optics where pixels are finer, since the
// transfer then falls to one half at longer periods than those of the window.
double unit_of(const Conditions& conditions) {
    constexpr double share = 1.0 / 8;
    return std::max(conditions.pitch, share * conditions.resolution);
}

std::vector<double> periods_of(const Conditions& conditions) {
    const std::vector<double> units =
        conditions.small ? std::vector<double>{40, 20, 12, 8} : std::vector<double>{40, 28, 20, 14, 10, 8, 6};
    std::vector<double> periods;
    periods.reserve(units.size());
    for (const double one : units) {
        periods.push_back(one * unit_of(conditions));
    }
    return periods;
}

int azimuths_of(const Conditions& conditions) {
    return conditions.small ? 2 : 8;
}

double amplitude_of(const Conditions& conditions) {
    constexpr double share = 0.1; // larger ones make the response non-linear
    return share * conditions.curve_deviation;
}

double star_radius(const Conditions& conditions) {
    constexpr double share = 0.45;
    return share * conditions.field();
}

int petals_of(const Conditions& conditions) {
    constexpr double outer_period = 40; // units
    return std::max(4, static_cast<int>(2 * pi * star_radius(conditions) / (outer_period * unit_of(conditions))));
}

std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& remarks) {
    std::vector<Trial> list;
    for (const double period : periods_of(conditions)) {
        if (conditions.field() < 4 * period) {
            remarks.push_back(fmt::format("The field holds fewer than four periods of {} µm.", um(period)));
            continue;
        }
        for (int azimuth = 0; azimuth < azimuths_of(conditions); ++azimuth) {
            const double angle = pi * azimuth / azimuths_of(conditions);
            const auto print = static_cast<std::uint32_t>(list.size() + 1);
            list.push_back({.name = fmt::format("period_{:.0f}_px/azimuth_{:.1f}", period / conditions.pitch,
                                                angle / radians_per_degree),
                            .specimen = sinusoid_standard(conditions, amplitude_of(conditions), period, print, angle),
                            .overrides = repetition(conditions, static_cast<int>(list.size()))});
        }
    }
    list.push_back({.name = "star",
                    .specimen = standard_of(conditions, "star",
                                            fmt::format("radius_um = {}\nheight_um = {}\npetals = {}\n",
                                                        um(star_radius(conditions)), um(2 * amplitude_of(conditions)),
                                                        petals_of(conditions)),
                                            0.5 * conditions.pitch) +
                                printed(conditions, usual_contrast, 1) + placed_at(0, 0, conditions.middle()),
                    .overrides = {}});
    return list;
}

struct Ratio {
    double mean = surface::undefined, standard_error = surface::undefined;
};

Ratio mean_of(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    Ratio ratio{.mean = 0, .standard_error = surface::undefined};
    for (const double value : values) {
        ratio.mean += value / count;
    }
    double squares = 0;
    for (const double value : values) {
        squares += (value - ratio.mean) * (value - ratio.mean);
    }
    if (values.size() > 1) {
        ratio.standard_error = std::sqrt(squares / (count - 1) / count);
    }
    return values.empty() ? Ratio{} : ratio;
}

// The period at which the transfer falls below one half, from long periods downwards; linear in the frequency between
// neighbours, in which a transfer function is less curved than in the period. None if it stays above, or starts below.
std::optional<double> period_of_half(const std::vector<dimensions::Transfer>& transfers) {
    constexpr double half = 0.5;
    for (std::size_t k = 0; k + 1 < transfers.size(); ++k) {
        const auto &longer = transfers[k], &shorter = transfers[k + 1];
        if (longer.ratio >= half && shorter.ratio < half) {
            const double share = (longer.ratio - half) / (longer.ratio - shorter.ratio);
            return 1 / (1 / longer.period * (1 - share) + 1 / shorter.period * share);
        }
    }
    return std::nullopt;
}

// The uncertainty of the period at half, by the uncertainty of the ratios on either side and the slope there.
double uncertainty_of_period(const std::vector<dimensions::Transfer>& transfers, double period) {
    for (std::size_t k = 0; k + 1 < transfers.size(); ++k) {
        const auto &longer = transfers[k], &shorter = transfers[k + 1];
        if (longer.period >= period && shorter.period <= period && longer.ratio != shorter.ratio) {
            const double slope = (longer.ratio - shorter.ratio) / (longer.period - shorter.period);
            return std::max(longer.standard_error, shorter.standard_error) / std::abs(slope);
        }
    }
    return surface::undefined;
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    Findings findings;
    std::vector<dimensions::Transfer> sinusoids;
    CertificateTable table{.caption = "Instrument transfer function by sinusoids",
                           .columns = {"period / µm", "period / pixels", "transfer", "u", "azimuths"},
                           .rows = {}};
    std::size_t first = 0;
    for (const double period : periods_of(conditions)) {
        if (conditions.field() < 4 * period) {
            continue;
        }
        std::vector<double> ratios;
        for (int azimuth = 0; azimuth < azimuths_of(conditions); ++azimuth) {
            const auto& result = results[first++];
            if (const auto* amplitude = dimension(result, "amplitude")) {
                ratios.push_back(amplitude->measured.value / amplitude->truth);
            }
        }
        const Ratio ratio = mean_of(ratios);
        sinusoids.push_back({.period = period, .ratio = ratio.mean, .standard_error = ratio.standard_error});
        table.rows.push_back({period * um_per_mm, period / conditions.pitch, ratio.mean, ratio.standard_error,
                              static_cast<double>(ratios.size())});
    }
    const dimensions::Star star{.frame = {},
                                .petals = petals_of(conditions),
                                .radius = star_radius(conditions),
                                .height = 2 * amplitude_of(conditions)};
    auto rings = dimensions::star_transfer(results.back().heights, star);
    const auto truth = dimensions::star_transfer(results.back().truth, star);
    for (std::size_t k = 0; k < rings.size(); ++k) {
        rings[k].ratio /= truth[k].ratio; // the pixels' own mean is not the instrument's
        rings[k].standard_error /= truth[k].ratio;
    }
    const auto add = [&](const char* key, const char* title, const std::vector<dimensions::Transfer>& transfers) {
        const auto period = period_of_half(transfers);
        findings.figures.push_back({.key = key,
                                    .title = title,
                                    .unit = "um",
                                    .value = period ? *period * um_per_mm : surface::undefined,
                                    .standard_uncertainty = period
                                                                ? uncertainty_of_period(transfers, *period) * um_per_mm
                                                                : surface::undefined});
        if (!period) {
            findings.remarks.push_back(fmt::format("The transfer of no period falls to one half: no {}.", title));
        }
    };
    add("D_LIM_um", "D_LIM, period of transfer 0.5 by sinusoids", sinusoids);
    add("D_LIM_by_star_um", "period of transfer 0.5 by the star", rings);
    const auto curve = [](const char* name, const std::vector<dimensions::Transfer>& transfers) {
        report::Curve curve{.name = name, .points = {}, .spreads = {}, .markers = true};
        for (const auto& one : transfers) {
            curve.points.emplace_back(one.period * um_per_mm, one.ratio);
        }
        return curve;
    };
    findings.charts.push_back({.title = "Instrument transfer function",
                               .x_label = "period / um",
                               .y_label = "measured over true amplitude",
                               .curves = {curve("sinusoids", sinusoids), curve("star", rings)},
                               .x_decades = true});
    findings.tables.push_back(std::move(table));
    findings.remarks.push_back(fmt::format("The amplitude of the sinusoids is {} µm, a tenth of the standard deviation "
                                           "of a focus curve: the transfer of larger ones differs.",
                                           um(amplitude_of(conditions))));
    return findings;
}

} // namespace of_transfer
} // namespace

Characteristic lateral_resolution() {
    return {
        .name = "D_LIM",
        .title = "Lateral resolution",
        .standard =
            "Sinusoids (type PPS) of 6 to 40 pixels a period, or eighths of the optical resolution where pixels are "
            "finer, in several directions, and a star (type ASG).",
        .procedure =
            "The transfer is the measured over the true amplitude, each by a least-squares fit, averaged "
            "over the directions; its uncertainty is their scatter. D_LIM is the period at which it falls "
            "to one half, linear in the frequency between the periods. On the star the transfer is found in rings.",
        .equation = R"(\frac{A_{\mathrm{measured}}(D_{LIM})}{A_{\mathrm{true}}(D_{LIM})} = )"
                    R"(\frac{1}{2})",
        .lateral = true,
        .trials = of_transfer::trials,
        .evaluate = of_transfer::evaluate};
}

} // namespace vkfv::measurement
