#include "core/keys/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

namespace vkfv {

Default Default::of(double value) {
    return {.toml = shortest_toml(value), .text = {}, .needed = false};
}
Default Default::of(std::int64_t value) {
    return {.toml = fmt::format("{}", value), .text = {}, .needed = false};
}
Default Default::of(bool value) {
    return {.toml = value ? "true" : "false", .text = {}, .needed = false};
}
Default Default::of(const std::string& value) {
    return {.toml = toml_quoted(value), .text = {}, .needed = false};
}

std::string Key::unit() const {
    if (type != Type::number && type != Type::numbers) {
        return {};
    }
    // Endings of names and their units; an ending that contains another one comes first.
    constexpr std::array<std::pair<const char*, const char*>, 15> units = {{{"_um2_per_hz", "um2/Hz"},
                                                                            {"_e_per_s", "e-/s"},
                                                                            {"_um_per_s", "um/s"},
                                                                            {"_hz", "Hz"},
                                                                            {"_dn_per_e", "DN/e-"},
                                                                            {"_percent", "%"},
                                                                            {"_mm", "mm"},
                                                                            {"_per_um", "1/um"},
                                                                            {"_um", "um"},
                                                                            {"_deg", "deg"},
                                                                            {"_ms", "ms"},
                                                                            {"_dn", "DN"},
                                                                            {"_e", "e-"},
                                                                            {"_W", "W"},
                                                                            {"_s", "s"}}};
    for (const auto& [ending, unit] : units) {
        if (name.ends_with(ending)) {
            return unit;
        }
    }
    return {};
}

std::vector<std::string> Key::choice_names() const {
    std::vector<std::string> names;
    for (const auto& choice : choices) {
        names.push_back(choice.name);
    }
    return names;
}

std::string Key::fallback_text() const {
    const auto& toml = fallback.toml; // a quoted word without escapes
    return toml.size() < 2 ? std::string() : toml.substr(1, toml.size() - 2);
}

std::string Key::allowed() const {
    if (!choices.empty()) {
        std::string text;
        for (std::size_t k = 0; k < choices.size(); ++k) {
            text += (k == 0 ? "" : k + 1 == choices.size() ? " or " : ", ") + toml_quoted(choices[k].name);
        }
        return text;
    }
    if (type == Type::integer || type == Type::integer_pair) {
        return fmt::format("{} to {}", static_cast<std::int64_t>(range.minimum),
                           static_cast<std::int64_t>(range.maximum));
    }
    return range.to_string();
}

namespace {

Default default_of(const std::optional<double>& value) {
    return value ? Default::of(*value) : Default::none();
}

} // namespace

NumberKey::NumberKey(std::string key_name, NumberRange key_range, std::optional<double> key_fallback,
                     std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::number,
          .meaning = std::move(key_meaning),
          .fallback = default_of(key_fallback),
          .range = key_range},
      value(key_fallback) {}

NumberKey::NumberKey(std::string key_name, NumberRange key_range, Default key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::number,
          .meaning = std::move(key_meaning),
          .fallback = std::move(key_fallback),
          .range = key_range} {}

IntegerKey::IntegerKey(std::string key_name, std::int64_t least, std::int64_t most,
                       std::optional<std::int64_t> key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::integer,
          .meaning = std::move(key_meaning),
          .fallback = key_fallback ? Default::of(*key_fallback) : Default::none(),
          .range = NumberRange::within(static_cast<double>(least), static_cast<double>(most))},
      minimum(least), maximum(most), value(key_fallback) {}

IntegerKey::IntegerKey(std::string key_name, std::int64_t least, std::int64_t most, Default key_fallback,
                       std::string key_meaning)
    : IntegerKey(std::move(key_name), least, most, std::optional<std::int64_t>(), std::move(key_meaning)) {
    fallback = std::move(key_fallback);
}

IntegerPairKey::IntegerPairKey(std::string key_name, std::int64_t least, std::int64_t most, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::integer_pair,
          .meaning = std::move(key_meaning),
          .fallback = Default::none(),
          .range = NumberRange::within(static_cast<double>(least), static_cast<double>(most))},
      minimum(least), maximum(most) {}

BooleanKey::BooleanKey(std::string key_name, bool key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::boolean,
          .meaning = std::move(key_meaning),
          .fallback = Default::of(key_fallback)},
      value(key_fallback) {}

TextKey::TextKey(std::string key_name, Default key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::text,
          .meaning = std::move(key_meaning),
          .fallback = std::move(key_fallback)} {}

FileKey::FileKey(std::string key_name, Default key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::file,
          .meaning = std::move(key_meaning),
          .fallback = std::move(key_fallback)} {}

NumbersKey::NumbersKey(std::string key_name, NumberRange key_range, Default key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::numbers,
          .meaning = std::move(key_meaning),
          .fallback = std::move(key_fallback),
          .range = key_range} {}

BooleansKey::BooleansKey(std::string key_name, Default key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::booleans,
          .meaning = std::move(key_meaning),
          .fallback = std::move(key_fallback)} {}

TextsKey::TextsKey(std::string key_name, std::vector<Choice> key_choices, Default key_fallback, std::string key_meaning)
    : Key{.name = std::move(key_name),
          .type = Type::texts,
          .meaning = std::move(key_meaning),
          .fallback = std::move(key_fallback),
          .choices = std::move(key_choices)} {}

std::vector<std::string> KeyTable::kinds() const {
    for (const Key* key : keys) {
        if (key->name == kind) {
            return key->choice_names();
        }
    }
    return {};
}

} // namespace vkfv
