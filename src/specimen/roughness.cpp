#include "specimen/roughness.hpp"

#include "specimen/analytic.hpp"
#include "specimen/description.hpp"
#include "specimen/random_heights.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {

using physics::f64::surface_height;

void check_roughness(double width, double height, const Roughness& roughness, const SourceLocation& where) {
    const auto fail = [&](const std::string& key, double found, const std::string& expected) {
        throw InputError({where, "specimen.roughness." + key, fmt::format("{:.6g}", found * um_per_mm), expected,
                          "Correct the value in the configuration."});
    };
    if (!(std::isfinite(roughness.noise) && roughness.noise >= 0)) {
        fail("noise_um", roughness.noise, "a length, 0 or more");
    }
    const double extent = std::max(width, height);
    if (!(roughness.kernel >= 0 && roughness.kernel <= extent)) {
        fail("kernel_um", roughness.kernel, fmt::format("a length from 0 to the specimen's {} um", extent * um_per_mm));
    }
    if (!positive(roughness.pitch)) {
        fail("pitch_um", roughness.pitch, positive_um());
    }
    check_work_of_noise(width, height, roughness.pitch, roughness.kernel, where, "roughness.pitch_um");
}

void add_roughness(HeightField& field, const Roughness& roughness, const SourceLocation& where) {
    check_roughness(field.x_max() - field.x_min, field.y_max() - field.y_min, roughness, where);
    // Rounding of a quotient of lengths: pitches that agree to 1e-9 are the same.
    const double coarsest = std::max(field.pitch_x, field.pitch_y);
    if (roughness.pitch < coarsest * (1 - 1e-9)) {
        throw InputError({where, "specimen.roughness.pitch_um", fmt::format("{:.6g}", roughness.pitch * um_per_mm),
                          fmt::format("a length no less than the specimen's pitch, {} um", coarsest * um_per_mm),
                          "Give the roughness a coarser pitch or the specimen a finer one."});
    }
    HeightField own;
    own.x_min = field.x_min;
    own.y_min = field.y_min;
    own.pitch_x = own.pitch_y = roughness.pitch;
    const auto points = [&](int count, double pitch) {
        return static_cast<int>(std::ceil((count - 1) * pitch / roughness.pitch * (1 - 1e-9))) + 1;
    };
    own.heights = Grid<float>(points(field.heights.columns, field.pitch_x), points(field.heights.rows, field.pitch_y));
    const Grid<double> noise =
        filtered_noise(own.heights.columns, own.heights.rows, roughness.kernel / roughness.pitch, roughness.seed);
    std::transform(noise.values.begin(), noise.values.end(), own.heights.values.begin(),
                   [&](double value) { return static_cast<float>(roughness.noise * value); });
    spdlog::info("roughness: Sq {:.4g} um of noise {:.4g} um, kernel {:.4g} um, pitch {:.4g} um",
                 roughness.noise * root_mean_square(noise) * um_per_mm, roughness.noise * um_per_mm,
                 roughness.kernel * um_per_mm, roughness.pitch * um_per_mm);

    const bool same_grid = std::abs(roughness.pitch - field.pitch_x) <= 1e-9 * roughness.pitch &&
                           std::abs(roughness.pitch - field.pitch_y) <= 1e-9 * roughness.pitch;
    Analytic carrier;
    carrier.x_min = own.x_min;
    carrier.y_min = own.y_min;
    carrier.x_max = own.x_max();
    carrier.y_max = own.y_max();
    carrier.lattice = std::move(own);
    const physics::f64::SpecimenRecord record = specimen::record({carrier, {}}, 1);
    const LatticeScene scene{&*carrier.lattice};
    for (int row = 0; row < field.heights.rows; ++row) {
        for (int column = 0; column < field.heights.columns; ++column) {
            const double added = same_grid ? scene.lattice_at(column, row)
                                           : surface_height(scene, record, field.x_min + column * field.pitch_x,
                                                            field.y_min + row * field.pitch_y)
                                                 .height;
            field.heights(column, row) = static_cast<float>(field.heights(column, row) + added);
        }
    }
}

} // namespace vkfv::specimen
