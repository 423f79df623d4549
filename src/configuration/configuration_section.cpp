#include "configuration/configuration_section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv {

std::string shortest_text(double value) {
    std::string text = fmt::format("{}", value);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

void at_its_place(const Configuration& configuration, const SourceLocation& otherwise,
                  const std::function<void()>& work) {
    try {
        work();
    } catch (const InputError& error) {
        throw error.with_each([&](InputProblem& problem) {
            const auto& places = configuration.places;
            if (const auto place = places.find(problem.key); place != places.end()) {
                problem.where = place->second;
            } else if (problem.where.file.empty()) {
                const auto table = places.find(problem.key.substr(0, problem.key.rfind('.')));
                problem.where = table != places.end() ? table->second : otherwise;
            }
        });
    }
}

void reject_keys_of_other_kinds(const TomlTable& table, const KeysOfKinds& keys_of_kinds, const std::string& kind,
                                const std::string& subject) {
    std::map<std::string, std::vector<std::string>> kinds_with;
    for (const auto& [other, keys] : keys_of_kinds) {
        for (const auto& key : keys) {
            kinds_with[key].push_back(other);
        }
    }
    for (const auto& [key, kinds] : kinds_with) {
        if (std::ranges::find(kinds, kind) == kinds.end() && table.has(key)) {
            table.note(key, fmt::format("no such key for {} of kind \"{}\"", subject, kind),
                       fmt::format("Remove it; it belongs to kind \"{}\".", fmt::join(kinds, "\" or \"")));
        }
    }
}

OldSection::OldSection(const TomlTable& table, Configuration& configuration)
    : table_(table), configuration_(configuration) {
    const auto& path = table.path();
    // "a.b[2]" is a table of the array a.b.
    const std::string header = path.ends_with(']') ? fmt::format("\n[[{}]]\n", path.substr(0, path.rfind('[')))
                                                   : fmt::format("\n[{}]\n", path);
    configuration_.canonical += header;
    configuration_.identity += header;
    configuration_.places[path] = table.where();
}

double OldSection::number(const std::string& key, const NumberRange& range, std::optional<double> fallback,
                          Influence influence) const {
    const double value = fallback ? table_.optional_number(key, range).value_or(*fallback) : table_.number(key, range);
    return record(key, shortest_text(value), influence), value;
}

std::optional<double> OldSection::number_if_given(const std::string& key, const NumberRange& range) const {
    const auto value = table_.optional_number(key, range);
    if (value) {
        record(key, shortest_text(*value), Influence::images);
    }
    return value;
}

std::vector<double> OldSection::numbers(const std::string& key, const NumberRange& range) const {
    const auto values = table_.numbers(key, range);
    std::vector<std::string> texts;
    std::ranges::transform(values, std::back_inserter(texts), shortest_text);
    return record(key, fmt::format("[{}]", fmt::join(texts, ", ")), Influence::images), values;
}

std::int64_t OldSection::integer(const std::string& key, std::int64_t minimum, std::int64_t maximum,
                                 std::optional<std::int64_t> fallback, Influence influence) const {
    const std::int64_t value = fallback ? table_.optional_integer(key, minimum, maximum).value_or(*fallback)
                                        : table_.integer(key, minimum, maximum);
    return record(key, fmt::format("{}", value), influence), value;
}

bool OldSection::boolean(const std::string& key, bool fallback, Influence influence) const {
    const bool value = table_.optional_boolean(key).value_or(fallback);
    return record(key, value ? "true" : "false", influence), value;
}

std::vector<bool> OldSection::booleans(const std::string& key, const std::vector<bool>& fallback) const {
    const auto values = table_.optional_booleans(key).value_or(fallback);
    std::string text;
    for (const bool value : values) {
        text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
    }
    return record(key, "[" + text + "]", Influence::images), values;
}

std::string OldSection::string(const std::string& key, std::optional<std::string> fallback) const {
    const std::string value = fallback ? table_.optional_string(key).value_or(*fallback) : table_.string(key);
    return record(key, toml_quoted(value), Influence::images), value;
}

std::string OldSection::choice(const std::string& key, const std::vector<std::string>& choices,
                               std::optional<std::string> fallback, Influence influence) const {
    const std::string value =
        fallback ? table_.optional_choice(key, choices).value_or(*fallback) : table_.choice(key, choices);
    return record(key, toml_quoted(value), influence), value;
}

std::string OldSection::kind(const std::string& key, const std::vector<std::string>& kinds,
                             std::optional<std::string> fallback, Influence influence) const {
    const std::string value = choice(key, kinds, std::move(fallback), influence);
    table_.require(key);
    return value;
}

void OldSection::record(const std::string& key, const std::string& value, Influence influence) const {
    const std::string line = fmt::format("{} = {}\n", key, value);
    note_place(key);
    configuration_.canonical += line;
    if (influence == Influence::images) {
        configuration_.identity += line;
    }
}

void OldSection::record_reference(const std::string& key, const std::string& value, const std::string& digest) const {
    note_place(key);
    configuration_.canonical += fmt::format("{} = {}\n", key, toml_quoted(value));
    if (!digest.empty()) {
        configuration_.identity += fmt::format("{}_digest = \"{}\"\n", key, digest);
    }
}

void OldSection::note_place(const std::string& key) const {
    configuration_.places[table_.path() + "." + key] = table_.where(key);
}

} // namespace vkfv
