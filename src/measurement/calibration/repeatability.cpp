// Repeatability and reproducibility of a groove's depth, by an analysis of variance (ISO 5725-2).
#include "core/mathematics/units.hpp"
#include "measurement/calibration/standards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vkfv::measurement {

namespace {
namespace of_repetitions { // files of a unity build share the unnamed namespace

struct Design {
    int places, repeats;
};

Design design_of(const Conditions& conditions) {
    return conditions.small ? Design{4, 3} : Design{10, 10};
}

std::vector<Trial> trials(const Conditions& conditions, std::vector<std::string>& remarks) {
    constexpr double widths_a_field = 3, share_of_range = 0.5, most_turn = 1, most_tilt = 0.5; // degrees
    const double wished = share_of_range * conditions.usable_range();
    const Groove groove = groove_of(conditions, wished, 1 / widths_a_field);
    if (groove.depth < 2 * conditions.step || groove.width < 3 * conditions.window) {
        remarks.push_back("The scan or the field is too small for a groove.");
        return {};
    }
    remark_shallower(conditions, groove, wished, remarks);
    std::mt19937 random(conditions.seed);
    const auto within = [&](double most) {
        return most * (2 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1);
    };
    const double aside = std::min(2 * conditions.window, 0.04 * conditions.field());
    const auto [places, repeats] = design_of(conditions);
    std::vector<Trial> list;
    for (int place = 0; place < places; ++place) {
        const double x = within(aside), y = within(aside), turn = within(most_turn * radians_per_degree);
        const double tilt_x = within(most_tilt * radians_per_degree), tilt_y = within(most_tilt * radians_per_degree);
        const std::string specimen = groove_standard(conditions, groove, 1) +
                                     placed_at(x, y, conditions.middle() + 0.5 * groove.depth, turn, tilt_x, tilt_y);
        for (int repeat = 0; repeat < repeats; ++repeat) {
            list.push_back({.name = fmt::format("place_{:02}/repeat_{:02}", place, repeat),
                            .specimen = specimen,
                            .overrides = repetition(conditions, place * repeats + repeat)});
        }
    }
    return list;
}

Findings evaluate(const Conditions& conditions, std::span<const TrialResult> results) {
    const auto [places, repeats] = design_of(conditions);
    CertificateTable table{.caption = "Errors of the depth",
                           .columns = {"place", "mean error / nm", "standard deviation of the repeats / nm"},
                           .rows = {}};
    constexpr double nm = 1e6;
    double within = 0, mean = 0;
    std::vector<double> means;
    int missed = 0;
    for (int place = 0; place < places; ++place) {
        std::vector<double> errors;
        for (int repeat = 0; repeat < repeats; ++repeat) {
            const auto& result = results[static_cast<std::size_t>(place * repeats + repeat)];
            if (const auto* depth = dimension(result, "groove depth")) {
                errors.push_back((depth->measured.value - depth->truth) * nm);
            } else {
                ++missed;
            }
        }
        if (errors.size() < static_cast<std::size_t>(repeats)) {
            continue;
        }
        double own = 0, squares = 0;
        for (const double error : errors) {
            own += error / repeats;
        }
        for (const double error : errors) {
            squares += (error - own) * (error - own);
        }
        within += squares;
        means.push_back(own);
        table.rows.push_back({static_cast<double>(place), own, std::sqrt(squares / (repeats - 1))});
    }
    Findings findings;
    const auto groups = static_cast<double>(means.size());
    if (groups < 2) {
        findings.remarks.push_back("Fewer than two places were measured in every repetition.");
        return findings;
    }
    for (const double own : means) {
        mean += own / groups;
    }
    double between = 0;
    for (const double own : means) {
        between += repeats * (own - mean) * (own - mean);
    }
    const double within_freedom = groups * (repeats - 1), between_freedom = groups - 1;
    const double repeat_variance = within / within_freedom;
    const double place_variance = std::max(0.0, (between / between_freedom - repeat_variance) / repeats);
    const double repeat = std::sqrt(repeat_variance), reproduced = std::sqrt(repeat_variance + place_variance);
    // The standard deviation of a variance of f degrees of freedom is the share sqrt(2 / f) of it.
    const double of_between = between / between_freedom * std::sqrt(2 / between_freedom) / repeats;
    const double of_within = repeat_variance * std::sqrt(2 / within_freedom) * (1 - 1.0 / repeats);
    findings.figures = {{.key = "repeatability_nm",
                         .title = "repeatability standard deviation of a depth",
                         .unit = "nm",
                         .value = repeat,
                         .standard_uncertainty = repeat / std::sqrt(2 * within_freedom)},
                        {.key = "reproducibility_nm",
                         .title = "reproducibility standard deviation of a depth",
                         .unit = "nm",
                         .value = reproduced,
                         .standard_uncertainty = std::hypot(of_between, of_within) / (2 * reproduced)},
                        {.key = "mean_error_of_depth_nm",
                         .title = "mean error of the depth",
                         .unit = "nm",
                         .value = mean,
                         .standard_uncertainty = std::sqrt(between / between_freedom / (repeats * groups)),
                         .degrees_of_freedom = between_freedom}};
    findings.tables.push_back(std::move(table));
    if (missed > 0) {
        findings.remarks.push_back(
            fmt::format("{} of {} depths were not measured; their places do not count.", missed, results.size()));
    }
    return findings;
}

} // namespace of_repetitions
} // namespace

Characteristic repeatability() {
    return {.name = "repeatability",
            .title = "Repeatability and reproducibility",
            .standard = "A groove (type PGR) as deep as half of the usable scan, or shallower where its walls would "
                        "cut the light cone of its bottom, laid anew at random: within two windows "
                        "in x and y, 1 degree of rotation and 0.5 degrees of tilt; measured several times at each "
                        "place.",
            .procedure = "One-way analysis of variance of the errors of the depth: the repeatability is the standard "
                         "deviation within places, and the reproducibility adds the variance between them.",
            .equation = R"(s_r^2 = \frac{1}{g (n - 1)} \sum_{i = 1}^{g} \sum_{j = 1}^{n} (e_{ij} - )"
                        R"(\bar{e}_i)^2, \quad s_R^2 = s_r^2 + \max\left(0, \frac{1}{g - 1} \sum_{i = )"
                        R"(1}^{g} (\bar{e}_i - \bar{e})^2 - \frac{s_r^2}{n}\right))",
            .trials = of_repetitions::trials,
            .evaluate = of_repetitions::evaluate};
}

} // namespace vkfv::measurement
