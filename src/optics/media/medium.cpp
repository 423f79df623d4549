#include "optics/media/medium.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkfv::optics {

const std::array<std::string_view, 13> dispersion_formula_names = {
    "schott",     "sellmeier 1", "herzberger", "sellmeier 2", "conrady",    "sellmeier 3", "handbook 1",
    "handbook 2", "sellmeier 4", "extended",   "sellmeier 5", "extended 2", "extended 3"};

namespace {

constexpr std::array<std::size_t, 13> coefficient_counts = {6, 6, 6, 5, 3, 8, 4, 4, 5, 8, 10, 8, 9};
constexpr double table_tolerance_um = 0.01; // extension of the tabulated range at either end
constexpr Medium::Range model_range = {.minimum_um = 0.36, .maximum_um = 1.1};
constexpr Medium::Range three_lines_range = {.minimum_um = 0.37, .maximum_um = 0.72};

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>; // clang deduces no aggregates before version 17

// Wavelengths of the Fraunhofer lines F, d and C (um), by which a table of these lines alone is recognized.
constexpr std::array three_lines_um = {0.4861327, 0.5875618, 0.6562725};
constexpr double line_rounding_um = 5e-4; // tolerance for tables that round to 0.486, 0.588 and 0.656

bool is_of_three_lines(const IndexTable& table) {
    return std::ranges::equal(table.wavelengths_um, three_lines_um,
                              [](double a, double b) { return std::abs(a - b) < line_rounding_um; });
}

// The term of third order that Cauchy's formula through F, d and C leaves out, for a glass of which no more is known:
// per unit of nF - nC, with x = 1 / lambda^2 in um^-2, it is (x - xF) (x - xd) (x - xC) times
//     beyond F:  p0 + p1 / vd + (p2 + p3 / vd) (x - xF)
//     beyond C:  q0 + q1 / vd
// and nothing between F and C. tools/studies/glass_dispersion fitted the constants by least squares to the indices of
// 735 glasses of SCHOTT, Ohara and CDGM at 0.39 to 0.48 um and at 0.665 to 0.72 um.
struct UnknownDispersion {
    double index = 0;       // correction added to the index
    double uncertainty = 0; // half width that holds for 95 of 100 of these glasses
};

UnknownDispersion beyond_three_lines(const IndexTable& table, double wavelength_um) {
    const auto x_of = [](double um) { return 1 / (um * um); };
    const double x = x_of(wavelength_um);
    const double x_f = x_of(table.wavelengths_um[0]);
    const double x_d = x_of(table.wavelengths_um[1]);
    const double x_c = x_of(table.wavelengths_um[2]);
    const double dispersion = table.indices[0] - table.indices[2];
    if ((x >= x_c && x <= x_f) || dispersion == 0) {
        return {};
    }
    const double scale = dispersion * (x - x_f) * (x - x_d) * (x - x_c);
    const double inverse_abbe = dispersion / (table.indices[1] - 1);
    const double shape = x > x_f ? 0.00263 - 0.0144 * inverse_abbe + (-0.000604 + 0.0183 * inverse_abbe) * (x - x_f)
                                 : 0.00755 - 0.126 * inverse_abbe;
    return {.index = scale * shape, .uncertainty = std::abs(scale) * (x > x_f ? 0.0009 : 0.0019)};
}

double index_of(const IndexTable& table, double wavelength_um) {
    const auto& [wavelengths_um, indices] = table;
    // The three tabulated wavelengths nearest to a given one are neighbours, as the table ascends.
    const std::size_t count = std::min<std::size_t>(3, wavelengths_um.size());
    std::size_t first = 0;
    while (first + count < wavelengths_um.size() &&
           wavelength_um - wavelengths_um[first] > wavelengths_um[first + count] - wavelength_um) {
        ++first;
    }
    // Cauchy's formula is the polynomial in 1 / lambda^2 through the points; Lagrange's form reproduces them exactly.
    const auto abscissa = [&](std::size_t i) { return 1 / (table.wavelengths_um[i] * table.wavelengths_um[i]); };
    const double x = 1 / (wavelength_um * wavelength_um);
    double sum = 0;
    for (std::size_t i = first; i < first + count; ++i) {
        double weight = 1;
        for (std::size_t j = first; j < first + count; ++j) {
            if (j != i) {
                weight *= (x - abscissa(j)) / (abscissa(i) - abscissa(j));
            }
        }
        sum += weight * indices[i];
    }
    return is_of_three_lines(table) ? sum + beyond_three_lines(table, wavelength_um).index : sum;
}

double index_of(const ModelGlass& model, double wavelength_um) {
    // Conrady's formula per unit of (nd - 1) / vd: `shape` is its part common to all glasses plus the part linear in
    // vd.
    const auto conrady = [&](double c0, double c1, double c2) {
        return c0 + c1 / wavelength_um + c2 / std::pow(wavelength_um, 3.5);
    };
    const double shape = conrady(-1.431304305765, 0.499823539516, 0.090308372903) +
                         model.vd * conrady(-0.014884538299, 0.011634006268, -0.000764325974);
    return model.nd + (model.nd - 1) / model.vd * shape;
}

double index_of(const GlassFormula& glass, double wavelength_um) {
    const auto& c = glass.coefficients;
    const double x2 = wavelength_um * wavelength_um;
    const auto sellmeier = [&](std::size_t terms) {
        double sum = 1;
        for (std::size_t i = 0; i < terms; ++i) {
            sum += c[2 * i] * x2 / (x2 - c[2 * i + 1]);
        }
        return std::sqrt(sum);
    };
    // The sum c(first) x^-2 + c(first + 1) x^-4 + ... of the formulas in even inverse powers.
    const auto inverse_powers = [&](std::size_t first, std::size_t last) {
        double sum = 0;
        for (std::size_t i = last + 1; i-- > first;) {
            sum = (sum + c[i]) / x2;
        }
        return sum;
    };
    switch (glass.formula) {
    case DispersionFormula::schott:
        return std::sqrt(c[0] + c[1] * x2 + inverse_powers(2, 5));
    case DispersionFormula::sellmeier_1:
        return sellmeier(3);
    case DispersionFormula::herzberger: {
        const double l = 1 / (x2 - 0.028);
        return c[0] + l * (c[1] + l * c[2]) + x2 * (c[3] + x2 * (c[4] + x2 * c[5]));
    }
    case DispersionFormula::sellmeier_2:
        return std::sqrt(1 + c[0] + c[1] * x2 / (x2 - c[2] * c[2]) + c[3] / (x2 - c[4] * c[4]));
    case DispersionFormula::conrady:
        return c[0] + c[1] / wavelength_um + c[2] / std::pow(wavelength_um, 3.5);
    case DispersionFormula::sellmeier_3:
        return sellmeier(4);
    case DispersionFormula::handbook_1:
        return std::sqrt(c[0] + c[1] / (x2 - c[2]) - c[3] * x2);
    case DispersionFormula::handbook_2:
        return std::sqrt(c[0] + c[1] * x2 / (x2 - c[2]) - c[3] * x2);
    case DispersionFormula::sellmeier_4:
        return std::sqrt(c[0] + c[1] * x2 / (x2 - c[2]) + c[3] * x2 / (x2 - c[4]));
    case DispersionFormula::extended:
        return std::sqrt(c[0] + c[1] * x2 + inverse_powers(2, 7));
    case DispersionFormula::sellmeier_5:
        return sellmeier(5);
    case DispersionFormula::extended_2:
        return std::sqrt(c[0] + x2 * (c[1] + x2 * (c[6] + x2 * c[7])) + inverse_powers(2, 5));
    case DispersionFormula::extended_3:
        return std::sqrt(c[0] + x2 * (c[1] + x2 * c[2]) + inverse_powers(3, 8));
    }
    return std::nan(""); // unreachable: the switch handles all formulas
}

} // namespace

std::size_t coefficient_count(DispersionFormula formula) {
    return coefficient_counts[static_cast<std::size_t>(formula) - 1];
}

Medium Medium::air() {
    return {.name = "air", .source = "the reference of all indices", .dispersion = ConstantIndex{}};
}

Medium Medium::constant(std::string name, double index, std::string source) {
    return {.name = std::move(name), .source = std::move(source), .dispersion = ConstantIndex{index}};
}

Medium Medium::tabulated(std::string name, std::vector<double> wavelengths_um, std::vector<double> indices,
                         std::string source) {
    return {.name = std::move(name),
            .source = std::move(source),
            .dispersion = IndexTable{std::move(wavelengths_um), std::move(indices)}};
}

Medium Medium::model(std::string name, double nd, double vd, std::string source) {
    return {.name = std::move(name), .source = std::move(source), .dispersion = ModelGlass{nd, vd}};
}

Medium Medium::formula(std::string name, DispersionFormula formula, std::vector<double> coefficients, double minimum_um,
                       double maximum_um, std::string source) {
    coefficients.resize(coefficient_count(formula));
    return {.name = std::move(name),
            .source = std::move(source),
            .dispersion = GlassFormula{formula, std::move(coefficients), minimum_um, maximum_um}};
}

std::optional<Medium::Range> Medium::valid_range() const {
    return std::visit(Overloaded{[](const ConstantIndex&) { return std::optional<Range>(); },
                                 [](const IndexTable& table) {
                                     if (is_of_three_lines(table)) {
                                         return std::optional(three_lines_range);
                                     }
                                     return std::optional(Range{table.wavelengths_um.front() - table_tolerance_um,
                                                                table.wavelengths_um.back() + table_tolerance_um});
                                 },
                                 [](const ModelGlass&) { return std::optional(model_range); },
                                 [](const GlassFormula& glass) {
                                     return std::optional(Range{glass.minimum_um, glass.maximum_um});
                                 }},
                      dispersion);
}

double Medium::index(double wavelength_um) const {
    const auto refuse = [&](std::string found, std::string expected, std::string remedy) {
        throw InputError({.where = {},
                          .key = fmt::format("index of {}", name),
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    };
    const auto range = valid_range();
    if (range && !(wavelength_um >= range->minimum_um && wavelength_um <= range->maximum_um)) {
        constexpr double longest_likely_um = 100;
        const bool in_nm = range->minimum_um > longest_likely_um;
        refuse(fmt::format("{} um", wavelength_um),
               fmt::format("a wavelength in [{:.9g}, {:.9g}] um, where the numbers hold ({})", range->minimum_um,
                           range->maximum_um, source.empty() ? "no source given" : source),
               in_nm ? "The medium's own wavelengths look like nanometres: divide them by 1000."
                     : "Choose such a wavelength, or describe the medium over a wider range in [media] of the "
                       "prescription.");
    }
    const double index =
        std::visit(Overloaded{[](const ConstantIndex& constant) { return constant.index; },
                              [&](const auto& dispersive) { return index_of(dispersive, wavelength_um); }},
                   dispersion);
    if (!(index > 0 && std::isfinite(index))) {
        refuse(fmt::format("{} at {} um", index, wavelength_um), "a dispersion whose index is finite and positive",
               "Correct the numbers of this medium.");
    }
    return index;
}

double Medium::dispersion_uncertainty(double wavelength_um) const {
    const auto* table = std::get_if<IndexTable>(&dispersion);
    return table != nullptr && is_of_three_lines(*table) ? beyond_three_lines(*table, wavelength_um).uncertainty : 0;
}

std::string Medium::dispersion_text() const {
    return std::visit(
        Overloaded{[](const ConstantIndex& constant) { return fmt::format(" {}", constant.index); },
                   [](const IndexTable& table) {
                       return fmt::format("{} {}", fmt::join(table.wavelengths_um, " "), fmt::join(table.indices, " "));
                   },
                   [](const ModelGlass& model) { return fmt::format("model {} {}", model.nd, model.vd); },
                   [](const GlassFormula& glass) {
                       return fmt::format("{} {} in {} {}",
                                          dispersion_formula_names[static_cast<std::size_t>(glass.formula) - 1],
                                          fmt::join(glass.coefficients, " "), glass.minimum_um, glass.maximum_um);
                   }},
        dispersion);
}

} // namespace vkfv::optics
