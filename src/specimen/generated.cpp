#include "specimen/generated.hpp"

#include "core/threads/parallel_rows.hpp"
#include "specimen/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {
namespace {

// The grid of a generated specimen: points over the footprint, at most `pitch` apart (except for the rounding of a
// quotient).
class Lattice {
  public:
    Lattice(const Recipe& recipe, const std::optional<Roughness>& roughness, const SourceLocation& where)
        : size_(recipe.square.size), pitch_(recipe.square.pitch), where_(where),
          is_smooth_(recipe.function && !recipe.random && !roughness) {
        // The grid must be as fine as the roughness, which would alias otherwise.
        if (roughness && positive(roughness->pitch)) {
            const bool has_own_grid = recipe.random || recipe.representation == Representation::facets;
            pitch_ = has_own_grid && positive(pitch_) ? std::min(pitch_, roughness->pitch) : roughness->pitch;
        }
        key_ = roughness && pitch_ == roughness->pitch ? "roughness.pitch_um" : "pitch_um";
    }

    double pitch() const { return pitch_; }
    const std::string& key() const { return key_; } // key of the pitch in use

    // The number of facets along a side.
    int facets() const {
        require_um(positive(pitch_) && pitch_ <= size_, where_, key_, pitch_,
                   fmt::format("a positive length, at most the specimen's {} um", size_ * um_per_mm));
        const double cells = std::ceil(size_ / pitch_ * (1 - 1e-9));
        if (cells > most_facets) {
            throw InputError(
                {where_, "specimen." + key_, fmt::format("{:.6g}", pitch_ * um_per_mm),
                 fmt::format("at most {} facets along the specimen's {:.6g} mm", most_facets, size_),
                 fmt::format("Choose {} >= {:.3g}{}, or a smaller specimen{}.", key_, size_ * um_per_mm / most_facets,
                             key_ == "pitch_um" ? " (0.5 if not given)" : "",
                             is_smooth_ ? ", or representation = \"analytic\"" : "")});
        }
        return static_cast<int>(cells);
    }

    HeightField level_field() const {
        const int cells = facets();
        HeightField field;
        field.heights = Grid<float>(cells + 1, cells + 1);
        field.x_min = field.y_min = -0.5 * size_;
        field.pitch_x = field.pitch_y = size_ / cells;
        return field;
    }

  private:
    double size_;
    double pitch_;
    SourceLocation where_;
    bool is_smooth_;
    std::string key_;
};

void set_heights(HeightField& field, const Analytic& function) {
    const physics::f64::SpecimenRecord record = specimen::record({function, {}}, 1);
    parallel_rows(field.heights.columns, field.heights.rows, [&](int first, int end) {
        for (int row = first; row < end; ++row) {
            for (int column = 0; column < field.heights.columns; ++column) {
                field.heights(column, row) =
                    static_cast<float>(physics::f64::shape_height(record, field.x_min + column * field.pitch_x,
                                                                  field.y_min + row * field.pitch_y)
                                           .height);
            }
        }
    });
}

} // namespace

std::variant<HeightField, Mesh, Analytic> generate(const Recipe& recipe, const std::optional<Roughness>& roughness,
                                                   const SourceLocation& where) {
    const double size = recipe.square.size;
    const bool of_facets = recipe.representation == Representation::facets;
    const Lattice lattice(recipe, roughness, where);
    require(positive(size), where, "size_mm", size,
            fmt::format("a length from {:g} to {:g} mm", smallest_length, largest_length));
    // This check precedes the making of any point.
    if (recipe.random) {
        check_work_of_noise(size, size, size / lattice.facets(), 0.5 * recipe.random->correlation_length, where,
                            lattice.key());
    }
    if (roughness) {
        check_roughness(size, size, *roughness, where);
    }
    Analytic function;
    if (recipe.function) {
        function = recipe.function();
    }
    if (!of_facets && !recipe.random && !roughness) {
        return function;
    }
    HeightField field = lattice.level_field();
    if (recipe.raise) {
        recipe.raise(field, lattice.pitch());
    } else if (of_facets) {
        set_heights(field, function);
    }
    if (recipe.random) {
        add_random_heights(field, *recipe.random, size, where);
    }
    if (roughness) {
        add_roughness(field, *roughness, where);
    }
    if (of_facets) {
        return field;
    }
    function.lattice = std::move(field);
    return function;
}

} // namespace vkfv::specimen
