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

// Of a length in mm under a key in um.
void require_um(bool condition, const Description& description, const std::string& key, double mm,
                const std::string& expected) {
    require(condition, description, key, mm * um_per_mm, expected);
}

bool positive(double mm) {
    return mm >= smallest_length && mm <= largest_length;
}

std::string positive_um() {
    return fmt::format("a length from {:.6g} to {:.6g} um", smallest_length * um_per_mm, largest_length * um_per_mm);
}

// Of the pitch that the grid of a generated specimen has.
std::string pitch_key(const Description& d, double pitch) {
    return d.roughness && pitch == d.roughness->pitch ? "roughness.pitch_um" : "pitch_um";
}

// A grid over a rectangle (mm) whose points a filter of this standard deviation goes over. The filter takes 12 standard
// deviations of points for every point, in both directions, beside the drawing of its random numbers.
void require_work(double width, double height, double pitch, double deviation, const SourceLocation& where,
                  const std::string& key) {
    constexpr double most_steps = 0x1p34;    // half a minute of one processor core
    constexpr double steps_of_drawing = 256; // and of the memory, 1.6 GB for the 2^26 points that this leaves at most
    const double columns = std::ceil(width / pitch) + 1, rows = std::ceil(height / pitch) + 1;
    const double points = columns * rows, taps = 12 * deviation / pitch;
    if (!(points * (steps_of_drawing + taps) > most_steps)) {
        return;
    }
    // Coarse enough for either part to take half of them.
    const double area = width * height;
    const double least = std::max(std::cbrt(2 * 12 * deviation * area / most_steps),
                                  std::sqrt(2 * steps_of_drawing * area / most_steps));
    throw InputError(
        {where, "specimen." + key, fmt::format("{:.6g}", pitch * um_per_mm),
         fmt::format("a pitch that makes fewer points than {:.6g} x {:.6g}, each a mean over {:.3g} others", columns,
                     rows, 2 * taps),
         fmt::format("Choose {} >= {:.3g}, or a smaller specimen.", key, least * um_per_mm)});
}

// The continuous shape without any lattice.
Analytic shape_of(const Description& d, double pitch) {
    Analytic shape;
    shape.x_min = shape.y_min = -0.5 * d.size;
    shape.x_max = shape.y_max = 0.5 * d.size;
    double* p = shape.parameters;
    switch (d.kind) {
    case Kind::step:
        require_um(std::isfinite(d.height), d, "height_um", d.height, "a finite length");
        shape.shape = physics::f64::SHAPE_STEP;
        p[0] = d.height;
        p[1] = d.wall == 0 ? pitch : d.wall;
        require_um(positive(p[1]), d, d.wall == 0 ? "pitch_um" : "wall_um", p[1], positive_um());
        break;
    case Kind::sphere:
        require_um(positive(d.radius), d, "radius_um", d.radius, positive_um());
        require_um(std::abs(d.height) < d.radius, d, "height_um", d.height, "less than the radius in size");
        shape.shape = physics::f64::SHAPE_SPHERE;
        p[0] = d.radius;
        p[1] = d.height;
        break;
    case Kind::sinusoid:
    case Kind::chirp:
        require_um(std::isfinite(d.amplitude), d, "amplitude_um", d.amplitude, "a finite length");
        require_um(positive(d.period), d, "period_um", d.period, positive_um());
        shape.shape = physics::f64::SHAPE_SINUSOID;
        p[0] = d.amplitude;
        p[1] = d.period;
        if (d.kind == Kind::chirp) {
            require_um(positive(d.period_stop), d, "period_stop_um", d.period_stop, positive_um());
            shape.shape = physics::f64::SHAPE_CHIRP;
            p[2] = d.period_stop;
        }
        break;
    default: // plane, and rough over a level plane
        if (d.kind == Kind::plane) {
            for (const auto& [key, tilt] : {std::pair{"tilt_x_deg", d.tilt_x}, std::pair{"tilt_y_deg", d.tilt_y}}) {
                require(std::abs(tilt) < 0.5 * pi, d, key, tilt / radians_per_degree, "an angle below 90 degrees");
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
    require_um(std::isfinite(d.sq) && d.sq >= 0, d, "sq_um", d.sq, "a length, 0 or more");
    require_um(positive(d.correlation_length) && d.correlation_length <= d.size, d, "correlation_length_um",
               d.correlation_length, "a positive length, at most the size");
    Grid<double> noise =
        filtered_noise(field.heights.columns, field.heights.rows, 0.5 * d.correlation_length / field.pitch_x, d.seed);
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

// Facets along a side.
int facets_along(const Description& d, double pitch) {
    const std::string key = pitch_key(d, pitch);
    require_um(positive(pitch) && pitch <= d.size, d, key, pitch,
               fmt::format("a positive length, at most the specimen's {} um", d.size * um_per_mm));
    const double cells = std::ceil(d.size / pitch * (1 - 1e-9));
    if (cells > most_facets) {
        const bool smooth = d.kind == Kind::plane || d.kind == Kind::step || d.kind == Kind::sphere ||
                            d.kind == Kind::sinusoid || d.kind == Kind::chirp;
        throw InputError({d.where, "specimen." + key, fmt::format("{:.6g}", pitch * um_per_mm),
                          fmt::format("at most {} facets along the specimen's {:.6g} mm", most_facets, d.size),
                          fmt::format("Choose {} >= {:.3g}{}, or a smaller specimen{}.", key,
                                      d.size * um_per_mm / most_facets, key == "pitch_um" ? " (0.5 if not given)" : "",
                                      smooth && !d.roughness ? ", or representation = \"analytic\"" : "")});
    }
    return static_cast<int>(cells);
}

} // namespace

HeightField level_field(const Description& d, double pitch) {
    const int cells = facets_along(d, pitch);
    HeightField field;
    field.heights = Grid<float>(cells + 1, cells + 1);
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
    require_work(width, height, roughness.pitch, roughness.kernel, where, "roughness.pitch_um");
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

std::variant<HeightField, Mesh, Analytic> generate(const Description& d) {
    // Fields finer than the facets would alias.
    double pitch = d.pitch;
    if (d.roughness && positive(d.roughness->pitch)) {
        const bool has_own_grid = d.kind == Kind::rough || d.representation == Representation::facets;
        pitch = has_own_grid && positive(d.pitch) ? std::min(d.pitch, d.roughness->pitch) : d.roughness->pitch;
    }
    require(positive(d.size), d, "size_mm", d.size,
            fmt::format("a length from {:g} to {:g} mm", smallest_length, largest_length));
    // Before any point is made.
    if (d.kind == Kind::rough || (d.kind == Kind::plateaus && d.sq > 0)) {
        require_work(d.size, d.size, d.size / facets_along(d, pitch), 0.5 * d.correlation_length, d.where,
                     pitch_key(d, pitch));
    }
    if (d.roughness) {
        check_roughness(d.size, d.size, *d.roughness, d.where);
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
                field->heights(column, row) =
                    static_cast<float>(physics::f64::shape_height(record, field->x_min + column * field->pitch_x,
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
