#include "core/toml_reader.hpp"

#include "core/file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace vkfv {

namespace {

constexpr std::size_t longest_quotation = 60; // characters of an offending value that a message repeats

std::string abbreviated(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    if (text.size() > longest_quotation) {
        text = text.substr(0, longest_quotation) + "...";
    }
    return text;
}

std::string text_of(const toml::node& node) {
    std::ostringstream stream;
    if (const auto* table = node.as_table()) {
        stream << toml::toml_formatter{*table, toml::toml_formatter::default_flags};
        return abbreviated("a table {" + stream.str() + "}");
    }
    if (const auto* array = node.as_array()) {
        stream << *array;
    } else if (const auto* real = node.as_floating_point()) {
        stream << fmt::format("{}", real->get()); // the shortest text that reads back
    } else {
        node.visit([&](const auto& value) {
            if constexpr (toml::is_value<decltype(value)>) {
                stream << value;
            }
        });
    }
    return abbreviated(stream.str());
}

std::string dotted(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : path + "." + std::string(key);
}

// The document, and which file it came from: an override's nodes carry another origin.
struct Document {
    toml::table root;
    std::filesystem::path file;

    SourceLocation place(const toml::source_region& region) const {
        SourceLocation where;
        const bool overridden = region.path && *region.path != file.string();
        where.file = overridden ? std::filesystem::path(*region.path) : file;
        if (!overridden) {
            where.line = static_cast<int>(region.begin.line);
            where.column = static_cast<int>(region.begin.column);
        }
        return where;
    }
};

toml::table parse_text(std::string_view text, const std::filesystem::path& name) {
    try {
        return toml::parse(text, name.string());
    } catch (const toml::parse_error& error) {
        throw InputError(
            {.where = {.file = name,
                       .line = static_cast<int>(error.source().begin.line),
                       .column = static_cast<int>(error.source().begin.column)},
             .key = "",
             .found = abbreviated(std::string(error.description())),
             .expected = "valid TOML 1.0",
             .remedy = "Correct the text at this place (strings need quotes, tables [brackets])."});
    }
}

// Moves `from` into `into`, table by table; what is no table on both sides is replaced.
void merge(toml::table& into, toml::table&& from) {
    for (auto&& [key, node] : from) {
        toml::node* present = into.get(key.str());
        if (present && present->is_table() && node.is_table()) {
            merge(*present->as_table(), std::move(*node.as_table()));
        } else {
            into.insert_or_assign(toml::key(key), std::move(node));
        }
    }
}

toml::table parse_override(const TomlOverride& given) {
    const auto as_document = [&](const std::string& value) {
        return toml::parse(given.key + " = " + value + "\n", given.origin);
    };
    const bool key_is_plain = !given.key.empty() && given.key.find_first_not_of(
                                                        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                        "0123456789_-.") == std::string::npos;
    if (key_is_plain) {
        try {
            // A value may not smuggle further lines in.
            if (given.value.find('\n') == std::string::npos) {
                return as_document(given.value);
            }
        } catch (const toml::parse_error&) {
        }
        try {
            return as_document(toml_quoted(given.value));
        } catch (const toml::parse_error&) {
        }
    }
    throw InputError({.where = {.file = given.origin},
                      .key = "",
                      .found = abbreviated(given.key),
                      .expected = "a dotted key such as specimen.material.g",
                      .remedy = "Name the table and the key as the configuration file does."});
}

} // namespace

bool NumberRange::contains(double value) const {
    return std::isfinite(value) && (minimum_included ? value >= minimum : value > minimum) &&
           (maximum_included ? value <= maximum : value < maximum);
}

std::string NumberRange::to_string() const {
    const bool below = std::isfinite(maximum);
    const bool above = std::isfinite(minimum);
    if (above && below) {
        return fmt::format("in {}{}, {}{}", minimum_included ? '[' : '(', minimum, maximum,
                           maximum_included ? ']' : ')');
    }
    if (above) {
        return fmt::format("{} {}", minimum_included ? ">=" : ">", minimum);
    }
    return below ? fmt::format("{} {}", maximum_included ? "<=" : "<", maximum) : "";
}

std::string toml_quoted(std::string_view text) {
    std::string quoted = "\"";
    for (const char character : text) {
        if (character == '"' || character == '\\') {
            quoted += '\\';
            quoted += character;
        } else if (static_cast<unsigned char>(character) < 0x20 || character == 0x7f) {
            quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(character));
        } else {
            quoted += character;
        }
    }
    return quoted + '"';
}

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
    // Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours cost one.
    const auto distance = [&](std::string_view other) {
        std::vector<std::size_t> before(other.size() + 1), above(other.size() + 1), row(other.size() + 1);
        for (std::size_t j = 0; j <= other.size(); ++j) {
            above[j] = j;
        }
        for (std::size_t i = 1; i <= word.size(); ++i) {
            row[0] = i;
            for (std::size_t j = 1; j <= other.size(); ++j) {
                row[j] = std::min(
                    {above[j] + 1, row[j - 1] + 1, above[j - 1] + (word[i - 1] == other[j - 1] ? 0u : 1u)});
                if (i > 1 && j > 1 && word[i - 1] == other[j - 2] && word[i - 2] == other[j - 1]) {
                    row[j] = std::min(row[j], before[j - 2] + 1);
                }
            }
            before.swap(above);
            above.swap(row);
        }
        return above[other.size()];
    };
    const std::size_t furthest = std::max<std::size_t>(2, word.size() / 2);
    std::optional<std::string> nearest;
    std::size_t smallest = furthest + 1;
    for (const auto& candidate : candidates) {
        const std::size_t steps = distance(candidate);
        // Nothing in common: as many steps as letters.
        if (steps < smallest && steps < std::max(word.size(), candidate.size())) {
            smallest = steps;
            nearest = candidate;
        }
    }
    return nearest;
}

struct TomlTable::State {
    std::shared_ptr<const Document> document;
    const toml::table* table = nullptr;
    std::string path;
    SourceLocation where;
    std::set<std::string, std::less<>> asked;
    std::map<std::string, std::shared_ptr<State>, std::less<>> children;

    const toml::node* find(std::string_view key) {
        asked.emplace(key);
        return table->get(key);
    }

    std::shared_ptr<State> child(const std::string& name, const std::string& child_path,
                                 const toml::table& node) {
        auto& state = children[name];
        if (!state) {
            state = std::make_shared<State>();
            state->document = document;
            state->table = &node;
            state->path = child_path;
            state->where = node.source().begin ? document->place(node.source()) : where;
        }
        return state;
    }

    [[noreturn]] void refuse(std::string_view key, const toml::node* node, std::string expected,
                             std::string remedy) const {
        throw InputError({.where = node && node->source().begin ? document->place(node->source()) : where,
                          .key = dotted(path, key),
                          .found = node ? text_of(*node) : "",
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
    }

    [[noreturn]] void refuse_missing(std::string_view key, const std::string& expected) const {
        refuse(key, nullptr, expected + ", found nothing",
               path.empty() ? fmt::format("Add the key {}.", key)
                            : fmt::format("Add {} to [{}].", key, path));
    }

    // Gives the value that `convert` makes of the node, or nothing if the key is missing.
    template <class Convert>
    auto get(std::string_view key, const std::string& expected, Convert convert)
        -> decltype(convert(std::declval<const toml::node&>())) {
        const toml::node* node = find(key);
        if (!node) {
            return std::nullopt;
        }
        auto value = convert(*node);
        if (!value) {
            refuse(key, node, expected, fmt::format("Correct {}.", dotted(path, key)));
        }
        return value;
    }

    void reject_unknown() const {
        for (auto&& [key, node] : *table) {
            if (asked.contains(key.str())) {
                continue;
            }
            const std::vector<std::string> known(asked.begin(), asked.end());
            const auto meant = nearest_word(key.str(), known);
            // An inserted override has its own origin; only the key's place is more exact than the value's.
            const auto& region = key.source().begin ? key.source() : node.source();
            throw InputError(
                {.where = document->place(region),
                 .key = dotted(path, key.str()),
                 .found = text_of(node),
                 .expected = known.empty() ? "no key here"
                                           : fmt::format("a known key (one of {})", fmt::join(known, ", ")),
                 .remedy = meant ? fmt::format("Did you mean \"{}\"? Correct or remove it.", *meant)
                                 : "Remove it."});
        }
        for (const auto& [name, state] : children) {
            state->reject_unknown();
        }
    }
};

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

} // namespace

TomlTable::TomlTable(std::shared_ptr<State> state) : state_(std::move(state)) {}

TomlTable TomlTable::parse(std::string_view text, const std::filesystem::path& name,
                           const std::vector<TomlOverride>& overrides) {
    auto document = std::make_shared<Document>();
    document->root = parse_text(text, name);
    document->file = name;
    for (const auto& given : overrides) {
        merge(document->root, parse_override(given));
    }
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

std::optional<double> TomlTable::optional_number(std::string_view key, const NumberRange& range) const {
    return state_->get(key, described("a finite number", range), [&](const toml::node& node) {
        auto value = as_number(node);
        return value && range.contains(*value) ? value : std::nullopt;
    });
}

double TomlTable::number(std::string_view key, const NumberRange& range) const {
    auto value = optional_number(key, range);
    if (!value) {
        state_->refuse_missing(key, described("a finite number", range));
    }
    return *value;
}

namespace {
std::string integer_expected(std::int64_t minimum, std::int64_t maximum) {
    return maximum == std::numeric_limits<std::int64_t>::max()
               ? fmt::format("an integer >= {}", minimum)
               : fmt::format("an integer in [{}, {}]", minimum, maximum);
}
} // namespace

std::optional<std::int64_t> TomlTable::optional_integer(std::string_view key, std::int64_t minimum,
                                                        std::int64_t maximum) const {
    return state_->get(
        key, integer_expected(minimum, maximum), [&](const toml::node& node) -> std::optional<std::int64_t> {
            std::optional<std::int64_t> value;
            if (const auto* integer = node.as_integer()) {
                value = integer->get();
            } else if (const auto* real = node.as_floating_point()) {
                constexpr double exact = 9007199254740992.0; // 2^53: beyond, doubles skip integers
                const double number = real->get();
                if (std::abs(number) <= exact && number == std::trunc(number)) {
                    value = static_cast<std::int64_t>(number);
                }
            }
            return value && *value >= minimum && *value <= maximum ? value : std::nullopt;
        });
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) const {
    auto value = optional_integer(key, minimum, maximum);
    if (!value) {
        state_->refuse_missing(key, integer_expected(minimum, maximum));
    }
    return *value;
}

std::optional<bool> TomlTable::optional_boolean(std::string_view key) const {
    return state_->get(key, "true or false", [](const toml::node& node) { return node.value_exact<bool>(); });
}

std::optional<std::vector<bool>> TomlTable::optional_booleans(std::string_view key) const {
    return state_->get(key, "an array of true and false", [](const toml::node& node) {
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
        state_->refuse_missing(key, "true or false");
    }
    return *value;
}

std::optional<std::string> TomlTable::optional_string(std::string_view key) const {
    return state_->get(key, "a string that is not empty", [](const toml::node& node) {
        auto value = node.value_exact<std::string>();
        return value && !value->empty() ? value : std::nullopt;
    });
}

std::string TomlTable::string(std::string_view key) const {
    auto value = optional_string(key);
    if (!value) {
        state_->refuse_missing(key, "a string that is not empty");
    }
    return *value;
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
    state_->refuse(key, node, choice_expected(choices),
                   meant ? fmt::format("Did you mean \"{}\"?", *meant) : "Choose one of these.");
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& choices) const {
    auto value = optional_choice(key, choices);
    if (!value) {
        state_->refuse_missing(key, choice_expected(choices));
    }
    return *value;
}

std::optional<std::filesystem::path> TomlTable::optional_file_path(std::string_view key) const {
    const auto value = optional_string(key);
    if (!value) {
        return std::nullopt;
    }
    const bool overridden = where(key).file != state_->document->file;
    return overridden ? std::filesystem::path(*value) : state_->document->file.parent_path() / *value;
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
        state_->refuse(key, node, expected, "Put the paths in brackets: [\"a\", \"b\"].");
    }
    const bool overridden = where(key).file != state_->document->file;
    for (const auto& element : *array) {
        const auto value = element.value_exact<std::string>();
        if (!value || value->empty()) {
            state_->refuse(fmt::format("{}[{}]", key, paths.size()), &element, "a string that is not empty",
                           "Correct this element.");
        }
        paths.push_back(overridden ? std::filesystem::path(*value)
                                   : state_->document->file.parent_path() / *value);
    }
    return paths;
}

std::filesystem::path TomlTable::file_path(std::string_view key) const {
    auto value = optional_file_path(key);
    if (!value) {
        state_->refuse_missing(key, "the path of a file");
    }
    return *value;
}

std::optional<std::vector<double>> TomlTable::optional_numbers(std::string_view key,
                                                               const NumberRange& range) const {
    const std::string expected = described("an array of finite numbers", range);
    const toml::node* node = state_->find(key);
    if (!node) {
        return std::nullopt;
    }
    const auto* array = node->as_array();
    if (!array) {
        state_->refuse(key, node, expected, "Put the numbers in brackets: [1, 2, 3].");
    }
    std::vector<double> values;
    for (const auto& element : *array) {
        const auto value = as_number(element);
        if (!value || !range.contains(*value)) {
            state_->refuse(fmt::format("{}[{}]", key, values.size()), &element,
                           described("a finite number", range), "Correct this element.");
        }
        values.push_back(*value);
    }
    return values;
}

std::vector<double> TomlTable::numbers(std::string_view key, const NumberRange& range) const {
    auto value = optional_numbers(key, range);
    if (!value) {
        state_->refuse_missing(key, described("an array of finite numbers", range));
    }
    return std::move(*value);
}

std::vector<std::string> TomlTable::value_texts(std::string_view key) const {
    constexpr const char* expected = "an array of numbers, strings or booleans";
    const toml::node* node = state_->find(key);
    if (!node) {
        state_->refuse_missing(key, expected);
    }
    const auto* array = node->as_array();
    if (!array || array->empty()) {
        state_->refuse(key, node, expected, "Put the values in brackets: [1e7, 1e8].");
    }
    std::vector<std::string> texts;
    for (const auto& element : *array) {
        if (const auto text = element.value_exact<std::string>()) {
            texts.push_back(toml_quoted(*text));
        } else if (const auto truth = element.value_exact<bool>()) {
            texts.emplace_back(*truth ? "true" : "false");
        } else if (const auto value = as_number(element)) {
            texts.push_back(fmt::format("{}", *value));
        } else {
            state_->refuse(fmt::format("{}[{}]", key, texts.size()), &element, "a number, a string or a boolean",
                           "Correct this element.");
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
        state_->refuse(key, node, "a table", fmt::format("Write [{}].", dotted(state_->path, key)));
    }
    return TomlTable(state_->child(std::string(key), dotted(state_->path, key), *table));
}

TomlTable TomlTable::table(std::string_view key) const {
    auto found = optional_table(key);
    if (!found) {
        state_->refuse(key, nullptr, "a table, found nothing",
                       fmt::format("Add [{}] with its keys.", dotted(state_->path, key)));
    }
    return *found;
}

TomlTable TomlTable::table_or_empty(std::string_view key) const {
    static const toml::table empty;
    const auto found = optional_table(key);
    return found ? *found : TomlTable(state_->child(std::string(key), dotted(state_->path, key), empty));
}

std::vector<TomlTable> TomlTable::optional_tables(std::string_view key) const {
    const toml::node* node = state_->find(key);
    std::vector<TomlTable> found;
    if (!node) {
        return found;
    }
    const auto* array = node->as_array();
    if (!array) {
        state_->refuse(key, node, "an array of tables",
                       fmt::format("Write [[{}]] before each.", dotted(state_->path, key)));
    }
    for (const auto& element : *array) {
        const std::string name = fmt::format("{}[{}]", key, found.size());
        const auto* table = element.as_table();
        if (!table) {
            state_->refuse(name, &element, "a table",
                           fmt::format("Write [[{}]] before each.", dotted(state_->path, key)));
        }
        found.push_back(TomlTable(state_->child(name, dotted(state_->path, name), *table)));
    }
    return found;
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
    auto found = optional_tables(key);
    if (found.empty()) {
        state_->refuse(key, state_->table->get(key), "at least one table",
                       fmt::format("Add [[{}]] with its keys.", dotted(state_->path, key)));
    }
    return found;
}

void TomlTable::reject_unknown_keys() const {
    state_->reject_unknown();
}

void TomlTable::fail(std::string_view key, std::string expected, std::string remedy) const {
    state_->refuse(key, state_->table->get(key), std::move(expected), std::move(remedy));
}

} // namespace vkfv
