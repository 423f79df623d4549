#include "core/toml/toml_reader.hpp"

#include "core/files/file.hpp"
#include "core/toml/toml_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace vkfv {

namespace {

std::optional<double> as_number(const toml::node& node) {
    if (const auto* integer = node.as_integer()) {
        return static_cast<double>(integer->get());
    }
    if (const auto* real = node.as_floating_point()) {
        return real->get();
    }
    return std::nullopt;
}

std::string described(const char* what, const NumberRange& range) {
    const std::string limits = range.to_string();
    return limits.empty() ? std::string(what) : std::string(what) + " " + limits;
}

// A harmless number in the range, in place of one that could not be read.
double stand_in(const NumberRange& range) {
    const double middle = 0.5 * (range.minimum + range.maximum);
    const double any = std::isfinite(middle)          ? middle
                       : std::isfinite(range.minimum) ? range.minimum + 1
                                                      : range.maximum - 1;
    return range.contains(1) ? 1 : range.contains(any) ? any : 0;
}

std::string remedy_for_number(const std::string& path, std::string_view key, double value, const NumberRange& range) {
    const auto remedy = is_length_in_um(key) ? remedy_for_length_um(value, range) : std::nullopt;
    return remedy.value_or(fmt::format("Correct {}.", path));
}

} // namespace

// The node converted by `convert`; none if the key is missing, or if its value is wrong and noted.
template <class Convert>
auto TomlTable::get(std::string_view key, const std::string& expected, Convert convert) const {
    using Value = decltype(convert(std::declval<const toml::node&>()));
    const toml::node* node = state_->find(key);
    if (!node) {
        return Value();
    }
    Value value = convert(*node);
    if (!value) {
        state_->note(key, node, expected, fmt::format("Correct {}.", dotted(state_->path, key)));
    }
    return value;
}

TomlTable::TomlTable(std::shared_ptr<State> state) : state_(std::move(state)) {}

TomlTable TomlTable::parse(std::string_view text, const std::filesystem::path& name,
                           const std::vector<TomlOverride>& overrides) {
    auto document = std::make_shared<TomlDocument>(text, name, overrides);
    auto state = std::make_shared<State>();
    state->table = &document->root;
    state->where = {.file = name, .line = 1, .column = 1};
    state->document = std::move(document);
    return TomlTable(std::move(state));
}

TomlTable TomlTable::open(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides) {
    return parse(read_file(file, {.expected = "a readable TOML file",
                                  .remedy = "Check the path and its permissions; relative paths start at the working "
                                            "directory, or at the file that names them."}),
                 file, overrides);
}

const std::string& TomlTable::path() const {
    return state_->path;
}
SourceLocation TomlTable::where() const {
    return state_->where;
}

SourceLocation TomlTable::where(std::string_view key) const {
    const toml::node* node = state_->table->get(key);
    return node && node->source().begin ? state_->document->place(node->source()) : state_->where;
}

bool TomlTable::has(std::string_view key) const {
    return state_->find(key) != nullptr;
}

std::vector<std::string> TomlTable::keys() const {
    std::vector<std::string> names;
    for (auto&& [key, node] : *state_->table) {
        names.emplace_back(key.str());
        state_->asked.emplace(key.str());
    }
    std::sort(names.begin(), names.end());
    return names;
}

void TomlTable::complete_from(const std::filesystem::path& file) const {
    state_->document->complete(state_->path, file);
}

std::optional<double> TomlTable::optional_number(std::string_view key, const NumberRange& range) const {
    const toml::node* node = state_->find(key);
    if (!node) {
        return std::nullopt;
    }
    const auto value = as_number(*node);
    const std::string path = dotted(state_->path, key);
    if (!value || !range.contains(*value)) {
        state_->note(key, node, described("a finite number", range),
                     value ? remedy_for_number(path, key, *value, range) : fmt::format("Correct {}.", path));
        return std::nullopt;
    }
    return value;
}

double TomlTable::number(std::string_view key, const NumberRange& range) const {
    auto value = optional_number(key, range);
    if (!value) {
        state_->note_missing(key, described("a finite number", range));
    }
    return value.value_or(stand_in(range));
}

namespace {
std::string integer_expected(std::int64_t minimum, std::int64_t maximum) {
    return maximum == std::numeric_limits<std::int64_t>::max()
               ? fmt::format("an integer >= {}", minimum)
               : fmt::format("an integer in [{}, {}]", minimum, maximum);
}

std::optional<std::int64_t> as_integer(const toml::node& node, std::int64_t minimum, std::int64_t maximum) {
    std::optional<std::int64_t> value;
    if (const auto* integer = node.as_integer()) {
        value = integer->get();
    } else if (const auto* real = node.as_floating_point()) {
        constexpr double exact = 9007199254740992.0; // 2^53: larger doubles skip integers
        const double number = real->get();
        if (std::abs(number) <= exact && number == std::trunc(number)) {
            value = static_cast<std::int64_t>(number);
        }
    }
    return value && *value >= minimum && *value <= maximum ? value : std::nullopt;
}
} // namespace

std::optional<std::int64_t> TomlTable::optional_integer(std::string_view key, std::int64_t minimum,
                                                        std::int64_t maximum) const {
    return get(key, integer_expected(minimum, maximum),
               [&](const toml::node& node) { return as_integer(node, minimum, maximum); });
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) const {
    auto value = optional_integer(key, minimum, maximum);
    if (!value) {
        state_->note_missing(key, integer_expected(minimum, maximum));
    }
    return value.value_or(std::clamp<std::int64_t>(1, minimum, maximum));
}

std::array<std::int64_t, 2> TomlTable::integer_pair(std::string_view key, std::int64_t minimum,
                                                    std::int64_t maximum) const {
    using Pair = std::array<std::int64_t, 2>;
    const std::string expected = integer_expected(minimum, maximum) + ", or two of them in brackets";
    const auto value = get(key, expected, [&](const toml::node& node) -> std::optional<Pair> {
        const auto* array = node.as_array();
        if (array != nullptr && array->size() != 2) {
            return std::nullopt;
        }
        const auto first = as_integer(array != nullptr ? *array->get(0) : node, minimum, maximum);
        const auto second = as_integer(array != nullptr ? *array->get(1) : node, minimum, maximum);
        return first && second ? std::optional(Pair{*first, *second}) : std::nullopt;
    });
    if (!value) {
        state_->note_missing(key, expected);
    }
    const auto harmless = std::clamp<std::int64_t>(1, minimum, maximum);
    return value.value_or(Pair{harmless, harmless});
}

std::optional<bool> TomlTable::optional_boolean(std::string_view key) const {
    return get(key, "true or false", [](const toml::node& node) { return node.value_exact<bool>(); });
}

std::optional<std::vector<bool>> TomlTable::optional_booleans(std::string_view key) const {
    return get(key, "an array of true and false", [](const toml::node& node) {
        std::optional<std::vector<bool>> values;
        if (const auto* array = node.as_array()) {
            values.emplace();
            for (const auto& element : *array) {
                const auto value = element.value_exact<bool>();
                if (!value) {
                    return std::optional<std::vector<bool>>();
                }
                values->push_back(*value);
            }
        }
        return values;
    });
}

bool TomlTable::boolean(std::string_view key) const {
    auto value = optional_boolean(key);
    if (!value) {
        state_->note_missing(key, "true or false");
    }
    return value.value_or(false);
}

std::optional<std::string> TomlTable::optional_string(std::string_view key) const {
    return get(key, "a string that is not empty", [](const toml::node& node) {
        auto value = node.value_exact<std::string>();
        return value && !value->empty() ? value : std::nullopt;
    });
}

std::string TomlTable::string(std::string_view key) const {
    auto value = optional_string(key);
    if (!value) {
        state_->note_missing(key, "a string that is not empty");
    }
    return value.value_or("?");
}

namespace {
std::string choice_expected(const std::vector<std::string>& choices) {
    return fmt::format("\"{}\"", fmt::join(choices, "\" or \""));
}
} // namespace

std::optional<std::string> TomlTable::optional_choice(std::string_view key,
                                                      const std::vector<std::string>& choices) const {
    const toml::node* node = state_->find(key);
    if (!node) {
        return std::nullopt;
    }
    const auto value = node->value_exact<std::string>();
    if (value && std::find(choices.begin(), choices.end(), *value) != choices.end()) {
        return value;
    }
    const auto meant = value ? nearest_word(*value, choices) : std::nullopt;
    state_->note(key, node, choice_expected(choices),
                 meant ? fmt::format("Did you mean \"{}\"?", *meant) : "Choose one of these.");
    return std::nullopt;
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& choices) const {
    auto value = optional_choice(key, choices);
    if (!value) {
        state_->note_missing(key, choice_expected(choices));
    }
    return value.value_or(choices.front());
}

std::optional<std::filesystem::path> TomlTable::optional_file_path(std::string_view key) const {
    const auto value = optional_string(key);
    if (!value) {
        return std::nullopt;
    }
    const auto& document = *state_->document;
    const auto file = where(key).file;
    const bool in_file = file == document.file || document.completed_from.contains(file);
    return in_file ? file.parent_path() / *value : std::filesystem::path(*value);
}

std::vector<std::filesystem::path> TomlTable::optional_file_paths(std::string_view key) const {
    std::vector<std::filesystem::path> paths;
    const toml::node* node = state_->find(key);
    if (!node) {
        return paths;
    }
    const std::string expected = "an array of paths of files";
    const auto* array = node->as_array();
    if (!array) {
        state_->note(key, node, expected, "Put the paths in brackets: [\"a\", \"b\"].");
        return paths;
    }
    const bool overridden = where(key).file != state_->document->file;
    for (const auto& element : *array) {
        const auto value = element.value_exact<std::string>();
        if (!value || value->empty()) {
            state_->note(fmt::format("{}[{}]", key, paths.size()), &element, "a string that is not empty",
                         "Correct this element.");
            break;
        }
        paths.push_back(overridden ? std::filesystem::path(*value) : state_->document->file.parent_path() / *value);
    }
    return paths;
}

std::filesystem::path TomlTable::file_path(std::string_view key) const {
    auto value = optional_file_path(key);
    if (!value) {
        state_->note_missing(key, "the path of a file");
    }
    return value.value_or("?");
}

std::optional<std::vector<double>> TomlTable::optional_numbers(std::string_view key, const NumberRange& range) const {
    const std::string expected = described("an array of finite numbers", range);
    const toml::node* node = state_->find(key);
    if (!node) {
        return std::nullopt;
    }
    const auto* array = node->as_array();
    if (!array) {
        state_->note(key, node, expected, "Put the numbers in brackets: [1, 2, 3].");
        return std::nullopt;
    }
    std::vector<double> values;
    for (const auto& element : *array) {
        const auto value = as_number(element);
        if (!value || !range.contains(*value)) {
            const std::string name = fmt::format("{}[{}]", key, values.size());
            state_->note(name, &element, described("a finite number", range),
                         value ? remedy_for_number("this element", name, *value, range) : "Correct this element.");
            return std::nullopt;
        }
        values.push_back(*value);
    }
    return values;
}

std::vector<double> TomlTable::numbers(std::string_view key, const NumberRange& range) const {
    auto value = optional_numbers(key, range);
    if (!value) {
        state_->note_missing(key, described("an array of finite numbers", range));
    }
    return value ? std::move(*value) : std::vector<double>();
}

std::vector<std::string> TomlTable::value_texts(std::string_view key) const {
    constexpr const char* expected = "an array of numbers, strings or booleans";
    const toml::node* node = state_->find(key);
    std::vector<std::string> texts;
    if (!node) {
        state_->note_missing(key, expected);
        return texts;
    }
    const auto* array = node->as_array();
    if (!array || array->empty()) {
        state_->note(key, node, expected, "Put the values in brackets: [1e7, 1e8].");
        return texts;
    }
    for (const auto& element : *array) {
        if (const auto text = element.value_exact<std::string>()) {
            texts.push_back(toml_quoted(*text));
        } else if (const auto truth = element.value_exact<bool>()) {
            texts.emplace_back(*truth ? "true" : "false");
        } else if (const auto value = as_number(element)) {
            texts.push_back(fmt::format("{}", *value));
        } else {
            state_->note(fmt::format("{}[{}]", key, texts.size()), &element, "a number, a string or a boolean",
                         "Correct this element.");
            break;
        }
    }
    return texts;
}

std::optional<TomlTable> TomlTable::optional_table(std::string_view key) const {
    const toml::node* node = state_->find(key);
    if (!node) {
        return std::nullopt;
    }
    const auto* table = node->as_table();
    if (!table) {
        state_->note(key, node, "a table", fmt::format("Write [{}].", dotted(state_->path, key)));
        return std::nullopt;
    }
    return TomlTable(state_->child(std::string(key), *table));
}

TomlTable TomlTable::table(std::string_view key) const {
    auto found = optional_table(key);
    if (!found) {
        if (!has(key)) {
            state_->note_missing_tables(key, "a table", fmt::format("[{}]", dotted(state_->path, key)));
        }
        require(key);
    }
    return *found;
}

TomlTable TomlTable::table_or_empty(std::string_view key) const {
    static const toml::table empty;
    const auto found = optional_table(key);
    return found ? *found : TomlTable(state_->child(std::string(key), empty));
}

std::vector<TomlTable> TomlTable::optional_tables(std::string_view key) const {
    const toml::node* node = state_->find(key);
    std::vector<TomlTable> found;
    if (!node) {
        return found;
    }
    const auto* array = node->as_array();
    if (!array) {
        state_->note(key, node, "an array of tables",
                     fmt::format("Write [[{}]] before each.", dotted(state_->path, key)));
        return found;
    }
    for (const auto& element : *array) {
        const std::string name = fmt::format("{}[{}]", key, found.size());
        const auto* table = element.as_table();
        if (!table) {
            state_->note(name, &element, "a table",
                         fmt::format("Write [[{}]] before each.", dotted(state_->path, key)));
            break;
        }
        found.push_back(TomlTable(state_->child(name, *table)));
    }
    return found;
}

std::vector<TomlTable> TomlTable::table_or_tables(std::string_view key) const {
    const toml::node* node = state_->find(key);
    return node && node->is_array() ? tables(key) : std::vector{table(key)};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
    auto found = optional_tables(key);
    if (found.empty()) {
        if (sound(dotted(state_->path, key))) {
            state_->note_missing_tables(key, "at least one table", fmt::format("[[{}]]", dotted(state_->path, key)));
        }
        require(key);
    }
    return found;
}

} // namespace vkfv
