#include "measurement/evaluation/noise_warnings.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/image/exposure.hpp"

#include <fmt/format.h>

#include <string>

namespace vkfv::measurement {

std::vector<Warning> warnings_of_noise(const Configuration& configuration, const Evaluation& evaluation) {
    const auto of_rays = [&](const char* code, double share, double wanted, const std::string& what) {
        return std::vector<Warning>{
            {.code = code,
             .key = "trace.rays",
             .value = std::to_string(configuration.trace.rays),
             .works = rays_for_noise(configuration, share, wanted),
             .sentence = fmt::format("{} {}", what, remedy_of_noise(configuration, share, wanted))}};
    };
    const auto& whole = evaluation.topography.stack;
    const double width = whole.curve_width_steps * configuration.scan->z_step;
    const double height_noise = width > 0 ? evaluation.height_noise / width : 0;
    if (whole.image_noise > noise_limits::most_of_image) {
        return of_rays("few-rays", whole.image_noise, noise_limits::good_of_image,
                       fmt::format("The images' noise is {:.0f} % of their brightness: what is measured is little or "
                                   "rough.",
                                   100 * whole.image_noise));
    }
    if (!configuration.camera &&
        height_noise > noise_limits::most_of_curve_width) { // more rays do not help against a camera's noise
        return of_rays("ray-noise-without-camera", height_noise, noise_limits::good_of_curve_width,
                       fmt::format("The images' noise is {:.2g} % of their brightness, and scatters the heights by "
                                   "{:.2g} um, {:.0f} % of their focus curves' width.",
                                   100 * whole.image_noise, evaluation.height_noise * um_per_mm, 100 * height_noise));
    }
    return {};
}

} // namespace vkfv::measurement
