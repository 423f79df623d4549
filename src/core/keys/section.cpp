#include "core/keys/section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv {

namespace {

// The value, or a harmless one in place of a length outside the physical range, which is noted. Files of other
// programs, such as lens designs with roundings of 0, are not read by keys and keep their numbers.
double with_physical_length(const TomlTable& table, const Key& key, double value) {
    const auto expected = expected_length(key.name, value);
    if (!expected) {
        return value;
    }
    table.note(key.name, *expected,
               fmt::format("Correct {}{}{}.", table.path(), table.path().empty() ? "" : ".", key.name));
    return 1;
}

} // namespace

Section::Section(const TomlTable& table, const KeyTable& keys, ReadKeys& read)
    : table_(table), keys_(&keys), read_(&read) {
    const auto& path = table.path();
    // The path "a[1].b[2]" is a table of the array a.b in the last table of the array a.
    std::string header = "\n[";
    bool in_index = false;
    for (const char character : path) {
        in_index = in_index ? character != ']' : character == '[';
        header += in_index || character == ']' ? "" : std::string(1, character);
    }
    header = path.ends_with(']') ? "\n[" + header.substr(1) + "]]\n" : header + "]\n";
    read_->canonical += header;
    read_->identity += header;
    read_->places[path] = table.where();
}

double Section::number(const NumberKey& key) const {
    return number_in(key, key.range);
}

double Section::number(const NumberKey& key, double fallback) const {
    const double value =
        with_physical_length(table_, key, table_.optional_number(key.name, key.range).value_or(fallback));
    return record(key, shortest_toml(value)), value;
}

double Section::number_in(const NumberKey& key, const NumberRange& range) const {
    const double value = with_physical_length(table_, key,
                                              key.value ? table_.optional_number(key.name, range).value_or(*key.value)
                                                        : table_.number(key.name, range));
    return record(key, shortest_toml(value)), value;
}

std::optional<double> Section::number_if_given(const NumberKey& key) const {
    auto value = table_.optional_number(key.name, key.range);
    if (value) {
        value = with_physical_length(table_, key, *value);
        record(key, shortest_toml(*value));
    }
    return value;
}

std::vector<double> Section::numbers(const NumbersKey& key) const {
    auto values = table_.numbers(key.name, key.range);
    for (double& value : values) {
        value = with_physical_length(table_, key, value);
    }
    std::vector<std::string> texts;
    std::ranges::transform(values, std::back_inserter(texts), shortest_toml);
    return record(key, fmt::format("[{}]", fmt::join(texts, ", "))), values;
}

std::int64_t Section::integer(const IntegerKey& key) const {
    const std::int64_t value = key.value
                                   ? table_.optional_integer(key.name, key.minimum, key.maximum).value_or(*key.value)
                                   : table_.integer(key.name, key.minimum, key.maximum);
    return record(key, fmt::format("{}", value)), value;
}

std::int64_t Section::integer(const IntegerKey& key, std::int64_t fallback) const {
    const std::int64_t value = table_.optional_integer(key.name, key.minimum, key.maximum).value_or(fallback);
    return record(key, fmt::format("{}", value)), value;
}

std::optional<std::int64_t> Section::integer_if_given(const IntegerKey& key) const {
    const auto value = table_.optional_integer(key.name, key.minimum, key.maximum);
    if (value) {
        record(key, fmt::format("{}", *value));
    }
    return value;
}

std::array<std::int64_t, 2> Section::integer_pair(const IntegerPairKey& key) const {
    const auto values = table_.integer_pair(key.name, key.minimum, key.maximum);
    record(key, values[0] == values[1] ? fmt::format("{}", values[0]) : fmt::format("[{}, {}]", values[0], values[1]));
    return values;
}

bool Section::boolean(const BooleanKey& key) const {
    const bool value = table_.optional_boolean(key.name).value_or(key.value);
    return record(key, value ? "true" : "false"), value;
}

std::vector<bool> Section::booleans(const BooleansKey& key, const std::vector<bool>& fallback) const {
    const auto values = table_.optional_booleans(key.name).value_or(fallback);
    std::string text;
    for (const bool value : values) {
        text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
    }
    return record(key, "[" + text + "]"), values;
}

std::string Section::text(const TextKey& key) const {
    const std::string value =
        key.fallback.needed ? table_.string(key.name) : table_.optional_string(key.name).value_or(key.fallback_text());
    return record(key, toml_quoted(value)), value;
}

std::optional<std::string> Section::text_if_given(const TextKey& key) const {
    const auto value = table_.optional_string(key.name);
    if (value) {
        record(key, toml_quoted(*value));
    }
    return value;
}

std::filesystem::path Section::file(const FileKey& key) const {
    auto path = looked_for(table_.file_path(key.name));
    record_reference(key, absolute_path(path).string());
    return path;
}

std::optional<std::filesystem::path> Section::file_if_given(const FileKey& key) const {
    return has(key) ? std::optional(file(key)) : std::nullopt;
}

std::string Section::choice_name(const Key& key, bool has_default) const {
    const auto names = key.choice_names();
    const std::string value = has_default ? table_.optional_choice(key.name, names).value_or(key.fallback_text())
                                          : table_.choice(key.name, names);
    return record(key, toml_quoted(value)), value;
}

std::string Section::kind_name(const Key& key, bool has_default) const {
    std::string value = choice_name(key, has_default);
    table_.require(key.name);
    reject_keys_of_other_kinds(value);
    return value;
}

void Section::record(const Key& key, const std::string& value) const {
    const std::string line = fmt::format("{} = {}\n", key.name, value);
    note_place(key.name);
    read_->canonical += line;
    if (key.influence == Influence::images) {
        read_->identity += line;
    }
}

void Section::record_reference(const Key& key, const std::string& value, const std::string& digest) const {
    note_place(key.name);
    read_->canonical += fmt::format("{} = {}\n", key.name, toml_quoted(value));
    if (!digest.empty()) {
        read_->identity += fmt::format("{}_digest = \"{}\"\n", key.name, digest);
    }
}

void Section::reject_keys_of_other_kinds(const std::string& kind) const {
    // The kinds of each key, sorted by its name, the order in which problems are reported.
    std::map<std::string, std::vector<std::string>> kinds_with;
    for (const Key* key : keys_->keys) {
        if (!key->kinds.empty()) {
            auto& kinds = kinds_with[key->name];
            kinds.insert(kinds.end(), key->kinds.begin(), key->kinds.end());
        }
    }
    for (auto& [name, kinds] : kinds_with) {
        if (std::ranges::find(kinds, kind) == kinds.end() && table_.has(name)) {
            std::ranges::sort(kinds);
            const auto& deciding = keys_->kind;
            const std::string owner = keys_->subject.empty() ? fmt::format("{} = ", deciding) : "kind ";
            table_.note(name,
                        keys_->subject.empty() ? fmt::format("no such key with {}\"{}\"", owner, kind)
                                               : fmt::format("no such key for {} of kind \"{}\"", keys_->subject, kind),
                        fmt::format("Remove it; it belongs to {}\"{}\".", owner, fmt::join(kinds, "\" or \"")));
        }
    }
}

void Section::note_place(const std::string& name) const {
    read_->places[table_.path() + "." + name] = table_.where(name);
}

std::filesystem::path absolute_path(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
}

std::filesystem::path looked_for(const std::filesystem::path& path) {
    std::error_code code;
    return std::filesystem::exists(path, code) ? path : absolute_path(path);
}

void as_named(const TomlTable& table, const std::string& key, const std::filesystem::path& file,
              const std::function<void()>& work) {
    try {
        work();
    } catch (const InputError& error) {
        std::error_code code;
        if (std::filesystem::exists(file, code)) {
            throw;
        }
        throw error.with_each([&](InputProblem& problem) {
            problem.remedy += fmt::format(" It is named at {}.", table.where(key).to_string());
        });
    }
}

void at_its_place(const ReadKeys& read, const SourceLocation& otherwise, const std::function<void()>& work) {
    try {
        work();
    } catch (const InputError& error) {
        throw error.with_each([&](InputProblem& problem) {
            const auto& places = read.places;
            if (const auto place = places.find(problem.key); place != places.end()) {
                problem.where = place->second;
            } else if (problem.where.file.empty()) {
                const auto table = places.find(problem.key.substr(0, problem.key.rfind('.')));
                problem.where = table != places.end() ? table->second : otherwise;
            }
        });
    }
}

} // namespace vkfv
