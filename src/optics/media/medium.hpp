// Optical media and their dispersion.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace vkfv::optics {

// The dispersion formulas of AGF glass catalogues, by their numbers there (Zemax OpticStudio's manual, "Index
// of refraction computation"). x is the wavelength in um, c0, c1, ... the coefficients:
enum class DispersionFormula {
    schott = 1,  // n^2 = c0 + c1 x^2 + c2 x^-2 + c3 x^-4 + c4 x^-6 + c5 x^-8
    sellmeier_1, // n^2 - 1 = sum of c(2i) x^2 / (x^2 - c(2i+1)), three terms
    herzberger,  // n = c0 + c1 L + c2 L^2 + c3 x^2 + c4 x^4 + c5 x^6 with L = 1 / (x^2 - 0.028)
    sellmeier_2, // n^2 - 1 = c0 + c1 x^2 / (x^2 - c2^2) + c3 / (x^2 - c4^2)
    conrady,     // n = c0 + c1 / x + c2 / x^3.5
    sellmeier_3, // Sellmeier 1 with four terms
    handbook_1,  // n^2 = c0 + c1 / (x^2 - c2) - c3 x^2
    handbook_2,  // n^2 = c0 + c1 x^2 / (x^2 - c2) - c3 x^2
    sellmeier_4, // n^2 = c0 + c1 x^2 / (x^2 - c2) + c3 x^2 / (x^2 - c4)
    extended,    // Schott's formula + c6 x^-10 + c7 x^-12
    sellmeier_5, // Sellmeier 1 with five terms
    extended_2,  // Schott's formula + c6 x^4 + c7 x^6
    extended_3,  // n^2 = c0 + c1 x^2 + c2 x^4 + c3 x^-2 + c4 x^-4 + c5 x^-6 + c6 x^-8 + c7 x^-10 + c8 x^-12
};

// Names of the formulas 1, 2, ... in prescriptions: "schott", "sellmeier 1", ...
extern const std::array<std::string_view, 13> dispersion_formula_names;

// The number of coefficients of a formula.
std::size_t coefficient_count(DispersionFormula formula);

// The dispersion models of a medium. A ConstantIndex is free of dispersion.
struct ConstantIndex { // same index at every wavelength
    double index = 1;
    bool operator==(const ConstantIndex&) const = default;
};

// Indices at ascending wavelengths, interpolated by Cauchy's formula n = A + B / lambda^2 + C / lambda^4 through the
// three nearest points (one point: A alone; two: A and B). The table is valid up to 10 nm beyond its ends. A table of
// the F, d and C lines alone, as patents and old catalogues print it, is a glass: it holds from 0.37 um to 0.72 um, and
// beyond F and C it has the partial dispersion that is usual for its Abbe number (Medium::dispersion_uncertainty).
struct IndexTable {
    std::vector<double> wavelengths_um;
    std::vector<double> indices;
    bool operator==(const IndexTable&) const = default;
};

// Zemax's model glass of index nd and Abbe number vd (Medium::model), valid from 0.36 um to 1.1 um.
struct ModelGlass {
    double nd = 0;
    double vd = 0;
    bool operator==(const ModelGlass&) const = default;
};

struct GlassFormula { // valid from minimum_um to maximum_um, ends included
    DispersionFormula formula = DispersionFormula::sellmeier_1;
    std::vector<double> coefficients; // size: coefficient_count(formula)
    double minimum_um = 0;
    double maximum_um = 0;
    bool operator==(const GlassFormula&) const = default;
};

// A medium between surfaces. Its indices are relative to air, as glass catalogues publish them, at the
// source's reference temperature and pressure (20 to 25 degrees C, 1 atm); nothing is corrected for another
// temperature or pressure.
struct Medium {
    std::string name;   // name as the source writes it: "air", "N-BK7", ...
    std::string source; // origin of the numbers
    std::variant<ConstantIndex, IndexTable, ModelGlass, GlassFormula> dispersion;

    static Medium air(); // index 1: indices are relative to air
    static Medium constant(std::string name, double index, std::string source = {});
    static Medium tabulated(std::string name, std::vector<double> wavelengths_um, std::vector<double> indices,
                            std::string source = {});
    // Zemax's model glass (with a partial dispersion deviation of zero): Conrady's formula through nd at
    // 0.5876 um, through (nd - 1) / vd between 0.4861 and 0.6563 um, and through a partial dispersion linear
    // in vd, that of Schott's normal glasses (K7 and F2). The six constants were fitted to the indices that
    // Zemax prints for 21 model glasses (nd 1.44 to 1.80, vd 29.5 to 94.6), and give each of them to 8e-11,
    // within its last digit. As the d line is at 0.5875618 um, the index there is above nd by 1.9e-4 (nd - 1)
    // / vd: 1.6200033 for 620363. Of 739 glasses of three vendors, 95 in 100 agree with the model of their nd
    // and vd to 5e-4 at 0.4358 um, 2e-5 at 0.55 um, 1e-4 at 0.7065 um, 9e-4 at 1.064 um and 5e-3 at 0.365 um.
    static Medium model(std::string name, double nd, double vd, std::string source = {});
    // A medium with one of the AGF formulas, valid from minimum_um to maximum_um. Missing coefficients are zero;
    // surplus ones are ignored.
    static Medium formula(std::string name, DispersionFormula formula, std::vector<double> coefficients,
                          double minimum_um, double maximum_um, std::string source = {});

    struct Range {
        double minimum_um = 0;
        double maximum_um = 0;
    };
    std::optional<Range> valid_range() const; // tolerance included; none: valid everywhere

    // The index at a wavelength. Throws InputError, naming medium, wavelength and range, outside the valid range, and
    // for a formula that has no index there.
    double index(double wavelength_um) const;

    // The uncertainty of the index at a wavelength on which the source says nothing: a glass known by its indices at F,
    // d and C alone, beyond these lines. For 95 of 100 of 735 glasses of three vendors the index lies within this of
    // the value expected from the three lines. 0 where the source's own numbers hold.
    double dispersion_uncertainty(double wavelength_um) const;

    // The dispersion's form and numbers as text, for digests: two texts are equal only if the dispersions are.
    std::string dispersion_text() const;
};

} // namespace vkfv::optics
