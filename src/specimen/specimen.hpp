// The specimen: its surface in the specimen frame (mm, +z towards the objective) and its scattering.
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

// Heights at the points of a grid, mm; each cell is two triangles, split from (i, j) to (i+1, j+1). Heights are floats
// so that host and device trace the same facets.
struct HeightField {
    Grid<float> heights; // row 0 at the lowest y
    double x_min = 0;    // mm, of column 0
    double y_min = 0;
    double pitch_x = 0; // mm
    double pitch_y = 0;
    // Points whose heights were interpolated, as they were not measured: they are traced like others, but have no true
    // height. Empty: none.
    std::vector<bool> interpolated{};

    double x_max() const { return x_min + (heights.columns - 1) * pitch_x; }
    double y_max() const { return y_min + (heights.rows - 1) * pitch_y; }
};

// Triangles of any arrangement, mm. They are counter-clockwise seen from outside, though the trace orients normals by
// the ray.
struct Mesh {
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> triangles;
};

// A continuous function of shaders/physics/surface_function.glsl. Irregular specimens add a lattice to it, with the
// points of a HeightField, interpolated without facets.
struct Analytic {
    std::uint32_t shape = physics::f64::SHAPE_PLANE;
    double parameters[4] = {0, 0, 0, 0};
    double x_min = 0, y_min = 0, x_max = 0, y_max = 0; // mm, footprint
    std::optional<HeightField> lattice;
};

// A function of the wavelength in vacuum: linear between its points, constant beyond the ends.
struct SpectralFunction {
    std::vector<double> wavelengths_um; // ascending; empty: no function
    std::vector<double> values;

    bool operator==(const SpectralFunction&) const = default;
    double at(double wavelength_um) const;
};

// A part of a material's scattering: the name of a model of shaders/physics/scatter/, and its parameters in that file's
// order.
struct Lobe {
    std::string model = "henyey-greenstein";
    double weight = 1; // share of the incident light, in (0, 1]
    std::vector<double> parameters = {0};
    SpectralFunction reflectance{};            // factors of the weight, in [0, 1]
    SpectralFunction refractive_index{};       // replaces the first two parameters of models with an index
    SpectralFunction extinction_coefficient{}; // at the same wavelengths
    std::optional<TabulatedBsdf> bsdf{};       // for models that are read from a file

    bool operator==(const Lobe&) const = default;
};

inline constexpr std::size_t most_lobes = 4;    // capacity of physics' Material
inline constexpr double weight_rounding = 1e-9; // tolerance of sums of weights that should be 1

// A sum of at most four lobes, whose weights sum to the reflectance, at most 1; the remaining light is absorbed.
struct Material {
    std::vector<Lobe> lobes = {Lobe{}}; // empty: all light is absorbed

    bool operator==(const Material&) const = default;
    static Material henyey_greenstein(double g) { return {{{"henyey-greenstein", 1, {g}}}}; }
};

// The record that the trace takes. Throws InputError (placed at `where`) for an unknown model, parameters outside their
// ranges, and weights whose sum exceeds 1.
physics::f64::Material material_record(const Material& material, const SourceLocation& where = {});

// The numbers to which a material's record refers.
struct MaterialNumbers {
    int spectral_points = 0;      // SpecimenRecord::material_spectral_points; 0: independent of the wavelength
    std::vector<float> numbers{}; // material_number(): its spectrum, then the tables of bsdfs
};
MaterialNumbers material_numbers(const Material& material);

// Throws as material_record() does, without computing the record's tables, which take milliseconds.
void check_material(const Material& material, const SourceLocation& where);

struct Specimen {
    std::variant<HeightField, Mesh, Analytic> geometry;
    Material material;
    std::optional<ReflectanceMap> reflectance{}; // factor on the material's reflectance, if it varies
};

} // namespace vkfv::specimen
