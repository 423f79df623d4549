// The object under test: its surface in the specimen frame (mm, +z towards the objective) and how it scatters.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/messages/error.hpp"
#include "physics/physics.hpp"
#include "specimen/reflectance.hpp"
#include "specimen/tabulated_bsdf.hpp"
#include "surface/height_map.hpp"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vkfv::specimen {

// Heights at the points of a grid, mm; each cell is two triangles, split from (i, j) to (i+1, j+1). Kept in float so
// that host and device trace the same facets.
struct HeightField {
    Grid<float> heights; // row 0 at the lowest y
    double x_min = 0;    // of column 0, mm
    double y_min = 0;
    double pitch_x = 0; // mm
    double pitch_y = 0;
    // Points whose heights were interpolated, since nobody measured them: traced like others, but of unknown truth.
    // Empty: none.
    std::vector<bool> interpolated{};

    double x_max() const { return x_min + (heights.columns - 1) * pitch_x; }
    double y_max() const { return y_min + (heights.rows - 1) * pitch_y; }
};

// Any triangles, mm. Counter-clockwise seen from outside, though the trace orients normals by the ray.
struct Mesh {
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> triangles;
};

// The continuous function of shaders/physics/surface_function.glsl, with a lattice added to it where the specimen is
// irregular (same points as a HeightField's, interpolated without facets).
struct Analytic {
    std::uint32_t shape = physics::f64::SHAPE_PLANE;
    double parameters[4] = {0, 0, 0, 0};
    double x_min = 0, y_min = 0, x_max = 0, y_max = 0; // footprint, mm
    std::optional<HeightField> lattice;
};

// A function of the wavelength in vacuum: linear between its points, held beyond the ends.
struct SpectralFunction {
    std::vector<double> wavelengths_um; // ascending; empty: there is none
    std::vector<double> values;

    bool operator==(const SpectralFunction&) const = default;
    double at(double wavelength_um) const;
};

// One way in which a material scatters: a model of shaders/physics/scatter/ by its name, and its parameters in that
// file's order.
struct Lobe {
    std::string model = "henyey-greenstein";
    double weight = 1; // share of the incident light, in (0, 1]
    std::vector<double> parameters = {0};
    SpectralFunction reflectance{};            // factors of the weight, in [0, 1]
    SpectralFunction refractive_index{};       // in place of the first two parameters, of models that have an index
    SpectralFunction extinction_coefficient{}; // of the same wavelengths
    std::optional<TabulatedBsdf> bsdf{};       // of a model that is read from a file

    bool operator==(const Lobe&) const = default;
};

inline constexpr std::size_t most_lobes = 4;    // as many as physics' Material holds
inline constexpr double weight_rounding = 1e-9; // of weights that are meant to add up to 1

// A sum of at most four lobes, whose weights add up to the reflectance, at most 1; the rest is absorbed.
struct Material {
    std::vector<Lobe> lobes = {Lobe{}}; // none: everything is absorbed

    bool operator==(const Material&) const = default;
    static Material henyey_greenstein(double g) { return {{{"henyey-greenstein", 1, {g}}}}; }
};

// The record the trace takes. Throws InputError (placed at `where`) for an unknown model, parameters out of
// their ranges, and weights that add up to more than 1.
physics::f64::Material material_record(const Material& material, const SourceLocation& where = {});

// The numbers that the record refers to.
struct MaterialNumbers {
    int spectral_points = 0;      // SpecimenRecord::material_spectral_points; 0: no wavelength changes the material
    std::vector<float> numbers{}; // material_number(): its spectrum, then the tables of bsdfs
};
MaterialNumbers material_numbers(const Material& material);

// The same errors, without the tables of the record, which take milliseconds.
void check_material(const Material& material, const SourceLocation& where);

struct Specimen {
    std::variant<HeightField, Mesh, Analytic> geometry;
    Material material;
    std::optional<ReflectanceMap> reflectance{}; // what scales the material's, if it varies
};

} // namespace vkfv::specimen
