#include "core/parsing/length_unit.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace vkfv {
namespace {

using NamedLength = std::pair<std::string_view, double>; // mm

// The micro sign stands as UTF-8 in both of Unicode's forms, as Java programs escape it, as Latin-1, and as code page
// 437 of DOS; the angstrom in both of Unicode's forms.
constexpr std::array symbols = {
    NamedLength("m", 1e3),         NamedLength("cm", 1e1),       NamedLength("mm", 1.0),
    NamedLength("um", 1e-3),       NamedLength("\u00b5m", 1e-3), NamedLength("\u03bcm", 1e-3),
    NamedLength("\\u00B5m", 1e-3), NamedLength("\xB5m", 1e-3),   NamedLength("\xE6m", 1e-3),
    NamedLength("nm", 1e-6),       NamedLength("pm", 1e-9),      NamedLength("km", 1e6),
    NamedLength("\u00c5", 1e-7),   NamedLength("\u212b", 1e-7),  NamedLength("in", 25.4),
    NamedLength("ft", 304.8),      NamedLength("mil", 0.0254)};
constexpr std::array words = {NamedLength("inch", 25.4),     NamedLength("inches", 25.4),
                              NamedLength("micron", 1e-3),   NamedLength("microns", 1e-3),
                              NamedLength("angstrom", 1e-7), NamedLength("angstroms", 1e-7),
                              NamedLength("mils", 0.0254)};
constexpr std::array prefixes = {NamedLength("", 1e3),      NamedLength("kilo", 1e6),   NamedLength("centi", 1e1),
                                 NamedLength("milli", 1.0), NamedLength("micro", 1e-3), NamedLength("nano", 1e-6),
                                 NamedLength("pico", 1e-9)};

std::optional<double> found_in(const auto& table, std::string_view name) {
    const auto entry = std::ranges::find(table, name, &NamedLength::first);
    return entry == table.end() ? std::nullopt : std::optional(entry->second);
}

bool is_capital(char c) {
    return c >= 'A' && c <= 'Z';
}

} // namespace

std::optional<double> mm_per_length_unit(std::string_view name) {
    if (const auto size = found_in(symbols, name)) {
        return size;
    }
    std::string word(name);
    std::ranges::transform(word, word.begin(),
                           [](char c) { return is_capital(c) ? static_cast<char>(c - 'A' + 'a') : c; });
    // A lone M is no metre.
    if (name.size() > 1 && std::ranges::all_of(name, is_capital)) {
        if (const auto size = found_in(symbols, word)) {
            return size;
        }
    }
    if (const auto size = found_in(words, word)) {
        return size;
    }
    if (word.ends_with('s')) {
        word.pop_back();
    }
    for (const std::string_view metre : {"metre", "meter"}) {
        if (word.ends_with(metre)) {
            return found_in(prefixes, std::string_view(word).substr(0, word.size() - metre.size()));
        }
    }
    return std::nullopt;
}

} // namespace vkfv
