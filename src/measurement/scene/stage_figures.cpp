#include "measurement/scene/stage_figures.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/scene/assembly.hpp"
#include "report/declared_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::measurement {

std::optional<double> reading_of(const Configuration& configuration, double position, int image) {
    const auto motion = stage_motion(configuration);
    return motion && configuration.stage->evaluate_read
               ? std::optional(motion->reading(position, static_cast<std::uint32_t>(image)))
               : std::nullopt;
}

StageErrors stage_errors(const Configuration& configuration) {
    const auto motion = stage_motion(configuration).value();
    const auto positions = configuration.scan->positions();
    StageErrors errors;
    double squares = 0;
    for (std::size_t image = 0; image < positions.size(); ++image) {
        const auto taken = motion.mean(positions[image], static_cast<std::uint32_t>(image));
        const double error = taken.height - positions[image];
        squares += error * error / static_cast<double>(positions.size());
        errors.largest = std::max(errors.largest, std::abs(error));
        errors.largest_aside = std::max(errors.largest_aside, glm::length(taken.beside));
    }
    errors.rms = std::sqrt(squares);
    return errors;
}

nlohmann::ordered_json stage_figures(const Configuration& configuration) {
    const auto motion = stage_motion(configuration).value();
    const auto errors = stage_errors(configuration);
    return report::as_declared("results.stage",
                               {{"evaluated_positions", configuration.stage->evaluate_read ? "read" : "nominal"},
                                {"position_error_rms", errors.rms},
                                {"position_error_largest", errors.largest},
                                {"displacement_largest", errors.largest_aside},
                                {"moments_per_exposure", motion.moments()},
                                {"positions_file", stage_file}});
}

std::string stage_table(const Configuration& configuration) {
    const auto motion = stage_motion(configuration).value();
    std::string text = "image,nominal_um,read_um,focal_plane_um,beside_x_um,beside_y_um,light\n";
    const auto positions = configuration.scan->positions();
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const auto image = static_cast<std::uint32_t>(k);
        const auto taken = motion.mean(positions[k], image);
        text += fmt::format("{},{},{},{},{},{},{}\n", k, positions[k] * um_per_mm,
                            motion.reading(positions[k], image) * um_per_mm, taken.height * um_per_mm,
                            taken.beside.x * um_per_mm, taken.beside.y * um_per_mm, motion.light(image));
    }
    return text;
}

} // namespace vkfv::measurement
