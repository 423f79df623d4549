#include "optics/media/medium_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace vkfv::optics {

namespace {

Medium read_table_medium(const TomlTable& table, const std::string& name, const std::string& source) {
    auto wavelengths_um = table.numbers("wavelengths_um", NumberRange::positive());
    auto indices = table.numbers("indices", index_range);
    if (wavelengths_um.empty() ||
        std::adjacent_find(wavelengths_um.begin(), wavelengths_um.end(), [](double a, double b) { return a >= b; }) !=
            wavelengths_um.end()) {
        table.fail("wavelengths_um", "at least one wavelength in um, ascending", "Sort the wavelengths.");
    }
    if (indices.size() != wavelengths_um.size()) {
        table.fail("indices", fmt::format("{} indices, one a wavelength", wavelengths_um.size()),
                   "Give as many indices as wavelengths.");
    }
    return Medium::tabulated(name, std::move(wavelengths_um), std::move(indices), source);
}

Medium read_formula_medium(const TomlTable& table, const std::string& name, const std::string& source) {
    const std::vector<std::string> names(dispersion_formula_names.begin(), dispersion_formula_names.end());
    const std::string chosen = table.choice("formula", names);
    table.require("formula"); // the formula decides which coefficients follow
    const auto formula =
        static_cast<DispersionFormula>(1 + std::distance(names.begin(), std::find(names.begin(), names.end(), chosen)));
    auto coefficients = table.numbers("coefficients");
    if (coefficients.empty() || coefficients.size() > coefficient_count(formula)) {
        table.fail("coefficients", fmt::format("1 to {} coefficients", coefficient_count(formula)),
                   "Check the formula and its coefficients.");
    }
    const auto range_um = table.numbers("range_um", NumberRange::positive());
    if (range_um.size() != 2 || range_um[0] >= range_um[1]) {
        table.fail("range_um", "two wavelengths in um, ascending", "Give the ends of the range where it holds.");
    }
    return Medium::formula(name, formula, std::move(coefficients), range_um[0], range_um[1], source);
}

} // namespace

Medium read_medium(const TomlTable& table, const std::string& name, const std::string& default_source) {
    const auto source = table.optional_string("source").value_or(default_source);
    std::string form; // the key that selects this form
    for (const std::string key : {"wavelengths_um", "nd", "index", "formula"}) {
        if (table.has(key) && !std::exchange(form, key).empty()) {
            table.fail(key, "one description of the medium", "Keep one of wavelengths_um, nd, index and formula.");
        }
    }
    if (form == "nd") {
        const double nd = table.number("nd", index_range);
        return Medium::model(name, nd, table.number("vd", abbe_range), source);
    }
    if (form == "index") {
        return Medium::constant(name, table.number("index", index_range), source);
    }
    if (form == "formula") {
        return read_formula_medium(table, name, source);
    }
    return read_table_medium(table, name, source);
}

} // namespace vkfv::optics
