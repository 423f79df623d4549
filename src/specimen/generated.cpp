#include "specimen/analytic.hpp"
#include "specimen/files.hpp"
#include "specimen/standards.hpp"

#include "core/units.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace vkfv::specimen {
namespace {

using physics::f64::surface_height;

void require(bool condition, const Description& description, const std::string& key, double found,
             const std::string& expected) {
    if (!condition) {
        throw InputError({description.where, "specimen." + key, fmt::format("{}", found), expected,
                          "Correct the value in the configuration."});
    }
}

bool positive(double value) {
    return std::isfinite(value) && value > 0;
}

// The continuous shape without any lattice.
Analytic shape_of(const Description& d, double pitch) {
    require(positive(d.size), d, "size", d.size, "a positive length");
    Analytic shape;
    shape.x_min = shape.y_min = -0.5 * d.size;
    shape.x_max = shape.y_max = 0.5 * d.size;
    double* p = shape.parameters;
    switch (d.kind) {
    case Kind::step:
        require(std::isfinite(d.height), d, "height", d.height, "a finite length");
        shape.shape = physics::f64::SHAPE_STEP;
        p[0] = d.height;
        p[1] = d.wall == 0 ? pitch : d.wall;
        require(positive(p[1]), d, "wall", p[1], "a positive length, or a pitch that takes its place");
        break;
    case Kind::sphere:
        require(positive(d.radius), d, "radius", d.radius, "a positive length");
        require(std::abs(d.height) < d.radius, d, "height", d.height, "less than the radius in size");
        shape.shape = physics::f64::SHAPE_SPHERE;
        p[0] = d.radius;
        p[1] = d.height;
        break;
    case Kind::sinusoid:
    case Kind::chirp:
        require(std::isfinite(d.amplitude), d, "amplitude", d.amplitude, "a finite length");
        require(positive(d.period), d, "period", d.period, "a positive length");
        shape.shape = physics::f64::SHAPE_SINUSOID;
        p[0] = d.amplitude;
        p[1] = d.period;
        if (d.kind == Kind::chirp) {
            require(positive(d.period_stop), d, "period_stop", d.period_stop, "a positive length");
            shape.shape = physics::f64::SHAPE_CHIRP;
            p[2] = d.period_stop;
        }
        break;
    default: // plane, and rough over a level plane
        if (d.kind == Kind::plane) {
            for (const double tilt : {d.tilt_x, d.tilt_y}) {
                require(std::abs(tilt) < 0.5 * pi, d, "tilt", tilt, "an angle below 90 degrees");
            }
            p[0] = std::tan(d.tilt_x);
            p[1] = std::tan(d.tilt_y);
        }
        break;
    }
    return shape;
}

double root_mean_square(const Grid<double>& grid) {
    const double sum = std::inner_product(grid.values.begin(), grid.values.end(), grid.values.begin(), 0.0);
    return std::sqrt(sum / static_cast<double>(grid.values.size()));
}

void subtract_mean(Grid<double>& grid) {
    const double mean =
        std::reduce(grid.values.begin(), grid.values.end(), 0.0) / static_cast<double>(grid.values.size());
    for (double& value : grid.values) {
        value -= mean;
    }
}

void add_rough(HeightField& field, const Description& d) {
    require(std::isfinite(d.sq) && d.sq >= 0, d, "sq", d.sq, "a length, 0 or more");
    require(positive(d.correlation_length) && d.correlation_length <= d.size, d, "correlation_length",
            d.correlation_length, "a positive length, at most the size");
    Grid<double> noise = filtered_noise(field.heights.columns, field.heights.rows,
                                        0.5 * d.correlation_length / field.pitch_x, d.seed);
    subtract_mean(noise);
    const double scale = d.sq / root_mean_square(noise);
    for (std::size_t i = 0; i < noise.values.size(); ++i) {
        field.heights.values[i] += static_cast<float>(scale * noise.values[i]);
    }
}

// One direction of the separable filter: `rows` lines of `columns` points each, periodic.
void filter_lines(Grid<double>& grid, const std::vector<double>& weights) {
    const int radius = static_cast<int>(weights.size()) - 1; // weights[k] at distance k
    const int columns = grid.columns;
    std::vector<double> padded(static_cast<std::size_t>(columns + 2 * radius));
    for (int row = 0; row < grid.rows; ++row) {
        for (int i = 0; i < columns + 2 * radius; ++i) {
            const int column = ((i - radius) % columns + columns) % columns;
            padded[static_cast<std::size_t>(i)] = grid(column, row);
        }
        for (int column = 0; column < columns; ++column) {
            const double* centre = padded.data() + column + radius;
            double sum = weights[0] * centre[0];
            for (int k = 1; k <= radius; ++k) {
                sum += weights[static_cast<std::size_t>(k)] * (centre[k] + centre[-k]);
            }
            grid(column, row) = sum;
        }
    }
}

Grid<double> transposed(const Grid<double>& grid) {
    Grid<double> result(grid.rows, grid.columns);
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            result(row, column) = grid(column, row);
        }
    }
    return result;
}

} // namespace

HeightField level_field(const Description& d, double pitch) {
    require(positive(pitch) && pitch <= d.size, d, "pitch", pitch, "a positive length, at most the size");
    const double cells = std::ceil(d.size / pitch * (1 - 1e-9));
    if ((cells + 1) * (cells + 1) > static_cast<double>(largest_point_count)) {
        throw InputError({d.where, "specimen.pitch", fmt::format("{} over a size of {}", pitch, d.size),
                          fmt::format("at most {} points", largest_point_count), "Choose a coarser pitch."});
    }
    HeightField field;
    field.heights = Grid<float>(static_cast<int>(cells) + 1, static_cast<int>(cells) + 1);
    field.x_min = field.y_min = -0.5 * d.size;
    field.pitch_x = field.pitch_y = d.size / cells;
    return field;
}

Grid<double> filtered_noise(int columns, int rows, double kernel, std::uint32_t seed) {
    Grid<double> noise(columns, rows);
    std::mt19937_64 generator(seed);
    // 53 bits to the middle of a cell of (0, 1); the distributions of the standard library differ between
    // libraries.
    const auto uniform = [&] { return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53; };
    for (std::size_t i = 0; i < noise.values.size(); i += 2) {
        // G. E. P. Box, M. E. Muller, "A note on the generation of random normal deviates" (1958).
        const double r = std::sqrt(-2 * std::log(uniform()));
        const double phi = 2 * pi * uniform();
        noise.values[i] = r * std::cos(phi);
        if (i + 1 < noise.values.size()) {
            noise.values[i + 1] = r * std::sin(phi);
        }
    }
    if (kernel > 0) {
        // Beyond six standard deviations a weight is below 2e-8 of the first.
        std::vector<double> weights(static_cast<std::size_t>(std::ceil(6 * kernel)) + 1);
        double sum = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const double z = static_cast<double>(k) / kernel;
            weights[k] = std::exp(-0.5 * z * z);
            sum += (k == 0 ? 1 : 2) * weights[k];
        }
        for (double& weight : weights) {
            weight /= sum;
        }
        filter_lines(noise, weights);
        noise = transposed(noise);
        filter_lines(noise, weights);
        noise = transposed(noise);
    }
    return noise;
}

void add_roughness(HeightField& field, const Roughness& roughness, const SourceLocation& where) {
    const auto fail = [&](const std::string& key, double found, const std::string& expected,
                          const std::string& remedy) {
        throw InputError({where, "specimen.roughness." + key, fmt::format("{}", found), expected, remedy});
    };
    if (!(std::isfinite(roughness.noise) && roughness.noise >= 0)) {
        fail("noise", roughness.noise, "a length, 0 or more", "Correct the value in the configuration.");
    }
    const double extent = std::max(field.x_max() - field.x_min, field.y_max() - field.y_min);
    if (!(roughness.kernel >= 0 && roughness.kernel <= extent)) {
        fail("kernel", roughness.kernel, fmt::format("a length from 0 to the specimen's {} mm", extent),
             "Correct the value in the configuration.");
    }
    // Rounding of a quotient of lengths: pitches that agree to 1e-9 are the same.
    const double coarsest = std::max(field.pitch_x, field.pitch_y);
    if (!positive(roughness.pitch) || roughness.pitch < coarsest * (1 - 1e-9)) {
        fail("pitch", roughness.pitch,
             fmt::format("a length no less than the specimen's pitch, {} mm", coarsest),
             "Give the roughness a coarser pitch or the specimen a finer one.");
    }
    HeightField own;
    own.x_min = field.x_min;
    own.y_min = field.y_min;
    own.pitch_x = own.pitch_y = roughness.pitch;
    const auto points = [&](int count, double pitch) {
        return static_cast<int>(std::ceil((count - 1) * pitch / roughness.pitch * (1 - 1e-9))) + 1;
    };
    own.heights =
        Grid<float>(points(field.heights.columns, field.pitch_x), points(field.heights.rows, field.pitch_y));
    const Grid<double> noise = filtered_noise(own.heights.columns, own.heights.rows,
                                              roughness.kernel / roughness.pitch, roughness.seed);
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
            const double added = same_grid
                                     ? scene.lattice_at(column, row)
                                     : surface_height(scene, record, field.x_min + column * field.pitch_x,
                                                      field.y_min + row * field.pitch_y)
                                           .height;
            field.heights(column, row) = static_cast<float>(field.heights(column, row) + added);
        }
    }
}

std::variant<HeightField, Mesh, Analytic> generate(const Description& d) {
    // Fields finer than the facets would alias.
    double pitch = d.pitch;
    if (d.roughness && positive(d.roughness->pitch)) {
        const bool has_own_grid = d.kind == Kind::rough || d.representation == Representation::facets;
        pitch =
            has_own_grid && positive(d.pitch) ? std::min(d.pitch, d.roughness->pitch) : d.roughness->pitch;
    }
    Analytic analytic = shape_of(d, d.pitch);
    std::optional<HeightField> field;
    if (d.representation == Representation::facets || d.kind == Kind::rough || d.roughness) {
        field = level_field(d, pitch);
    }
    if (d.kind == Kind::plateaus || d.kind == Kind::air || d.kind == Kind::star || d.kind == Kind::groove) {
        if (d.representation != Representation::facets)
            throw InputError({d.where, "specimen.representation", "analytic", "facets, for a specimen of this kind",
                              "Leave the key out."});
        field = d.kind == Kind::plateaus ? plateaus(d, pitch)
                : d.kind == Kind::air    ? sub_surfaces(d, pitch)
                : d.kind == Kind::star   ? star(d, pitch)
                                         : groove(d, pitch);
    } else if (d.representation == Representation::facets) {
        const physics::f64::SpecimenRecord record = specimen::record({analytic, {}}, 1);
        for (int row = 0; row < field->heights.rows; ++row) {
            for (int column = 0; column < field->heights.columns; ++column) {
                field->heights(column, row) = static_cast<float>(
                    physics::f64::shape_height(record, field->x_min + column * field->pitch_x,
                                               field->y_min + row * field->pitch_y)
                        .height);
            }
        }
    }
    if (d.kind == Kind::rough || (d.kind == Kind::plateaus && d.sq > 0)) {
        add_rough(*field, d);
    }
    if (d.roughness) {
        add_roughness(*field, *d.roughness, d.where);
    }
    if (d.representation == Representation::facets) {
        return std::move(*field);
    }
    analytic.lattice = std::move(field);
    return analytic;
}

} // namespace vkfv::specimen
