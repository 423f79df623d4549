#include "core/toml/toml_document.hpp"

#include "core/files/file.hpp"
#include "core/parsing/text_encoding.hpp"
#include "core/toml/toml_nesting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <tuple>

namespace vkfv {

namespace {

constexpr std::size_t longest_quotation = 60; // characters of an offending value that a message quotes

std::string abbreviated(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    if (text.size() > longest_quotation) {
        text = text.substr(0, longest_quotation) + "...";
    }
    return text;
}

// Checks the depth before the parser sees the text, as the parser's recursion has no limit for names.
void require_shallow(std::string_view text, const SourceLocation& origin, bool with_place) {
    const auto place = too_deep_toml(text);
    if (!place) {
        return;
    }
    SourceLocation where = origin;
    if (with_place) {
        where.line = place->line;
        where.column = place->column;
    }
    throw InputError({.where = where,
                      .key = "",
                      .found = fmt::format("a name or value {} levels deep", deepest_toml_nesting + 1),
                      .expected = fmt::format("tables and arrays nested at most {} deep", deepest_toml_nesting),
                      .remedy = "Shorten the dotted name, or take brackets out; text needs quotes."});
}

toml::table parse_text(std::string_view text, const std::filesystem::path& name) {
    require_shallow(text, {.file = name}, true);
    try {
        return toml::parse(text, name.string());
    } catch (const toml::parse_error& error) {
        throw InputError({.where = {.file = name,
                                    .line = static_cast<int>(error.source().begin.line),
                                    .column = static_cast<int>(error.source().begin.column)},
                          .key = "",
                          .found = abbreviated(std::string(error.description())),
                          .expected = "valid TOML 1.0",
                          .remedy = "Correct the text at this place (strings need quotes, tables [brackets])."});
    }
}

// The table of an array of tables that a key "0", "1", ... stands for; none for other keys.
toml::table* element_of(toml::array& tables, std::string_view key) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    toml::node* element = error == std::errc() && end == key.data() + key.size() ? tables.get(index) : nullptr;
    return element != nullptr ? element->as_table() : nullptr;
}

// Moves `from` into `into`, table by table; other values are replaced. For an array of tables, `from` is a table whose
// keys are the numbers of its tables. Throws InputError if the array has no such table.
void merge(toml::table& into, toml::table&& from, const TomlOverride& given) {
    for (auto&& [key, node] : from) {
        toml::node* present = into.get(key.str());
        if (present && present->is_table() && node.is_table()) {
            merge(*present->as_table(), std::move(*node.as_table()), given);
        } else if (present && present->is_array_of_tables() && node.is_table()) {
            toml::array& tables = *present->as_array();
            for (auto&& [index, own] : *node.as_table()) {
                toml::table* element = element_of(tables, index.str());
                if (element == nullptr || !own.is_table()) {
                    throw InputError(
                        {.where = {.file = given.origin},
                         .key = given.key,
                         .found = fmt::format("\"{}\" after \"{}\"", index.str(), key.str()),
                         .expected =
                             fmt::format("which [[{}]] is meant, by its number, 0 to {}", key.str(), tables.size() - 1),
                         .remedy = fmt::format("Write {}.0.{} for that of the first.", key.str(),
                                               element == nullptr && own.is_table() ? "KEY" : index.str())});
                }
                merge(*element, std::move(*own.as_table()), given);
            }
        } else {
            into.insert_or_assign(toml::key(key), std::move(node));
        }
    }
}

// Moves those values of `from` into `into` that it lacks, table by table.
void add_missing(toml::table& into, toml::table&& from) {
    for (auto&& [key, node] : from) {
        toml::node* present = into.get(key.str());
        if (!present) {
            into.insert(toml::key(key), std::move(node));
        } else if (present->is_table() && node.is_table()) {
            add_missing(*present->as_table(), std::move(*node.as_table()));
        }
    }
}

toml::table parse_override(const TomlOverride& given) {
    const auto as_document = [&](const std::string& value) {
        const std::string text = given.key + " = " + value + "\n";
        require_shallow(text, {.file = given.origin}, false);
        return toml::parse(text, given.origin);
    };
    const bool key_is_plain =
        !given.key.empty() && given.key.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                          "0123456789_-.") == std::string::npos;
    if (key_is_plain) {
        if (!is_utf8(given.value)) {
            throw InputError({.where = {.file = given.origin},
                              .key = given.key,
                              .found = "bytes that are no UTF-8",
                              .expected = "text in UTF-8, as a configuration is written in",
                              .remedy = "Give another text; rename the folder or file whose name this is."});
        }
        try {
            // A value with further lines is not parsed as TOML, as they could set other keys.
            if (given.value.find('\n') == std::string::npos) {
                return as_document(given.value);
            }
        } catch (const toml::parse_error&) {
        }
        return as_document(toml_quoted(given.value));
    }
    throw InputError({.where = {.file = given.origin},
                      .key = "",
                      .found = abbreviated(given.key),
                      .expected = "a dotted key such as specimen.material.g",
                      .remedy = "Name the table and the key as the configuration file does."});
}

// True if `path` is `ancestor`, or a key or element in it.
bool is_within(std::string_view path, std::string_view ancestor) {
    return ancestor.empty() ||
           (path.starts_with(ancestor) &&
            (path.size() == ancestor.size() || path[ancestor.size()] == '.' || path[ancestor.size()] == '['));
}

} // namespace

std::string dotted(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : key.empty() ? path : path + "." + std::string(key);
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
        stream << fmt::format("{}", real->get()); // shortest text that reads back
    } else {
        node.visit([&](const auto& value) {
            if constexpr (toml::is_value<decltype(value)>) {
                stream << value;
            }
        });
    }
    return abbreviated(stream.str());
}

TomlDocument::TomlDocument(std::string_view text, std::filesystem::path name,
                           const std::vector<TomlOverride>& overrides)
    : root(parse_text(text, name)), file(std::move(name)) {
    std::vector<InputProblem> wrong;
    for (const auto& given : overrides) {
        try {
            merge(root, parse_override(given), given);
        } catch (const InputError& error) {
            wrong.push_back(error.problem());
        }
    }
    if (!wrong.empty()) {
        throw InputError(std::move(wrong));
    }
}

void TomlDocument::complete(const std::string& path, const std::filesystem::path& other_file) {
    toml::table other = parse_text(read_file(other_file), other_file);
    toml::table* from = other.at_path(path).as_table();
    const auto refuse = [&](std::string found) {
        refuse_file(other_file, path, std::move(found), fmt::format("a title and a table [{}]", path),
                    "Correct the file, or name another.");
    };
    if (!from) {
        refuse("no such table");
    }
    for (auto&& [key, node] : other) {
        if (key.str() != path && key.str() != "title") {
            refuse(fmt::format("{} beside it", key.str()));
        }
    }
    completed_from.insert(other_file);
    add_missing(*root.at_path(path).as_table(), std::move(*from));
}

SourceLocation TomlDocument::place(const toml::source_region& region) const {
    SourceLocation where;
    const bool overridden = region.path && *region.path != file.string() && !completed_from.contains(*region.path);
    where.file = region.path ? std::filesystem::path(*region.path) : file;
    if (!overridden) {
        where.line = static_cast<int>(region.begin.line);
        where.column = static_cast<int>(region.begin.column);
    }
    return where;
}

bool TomlDocument::sound(std::string_view at) const {
    return std::ranges::none_of(noted, [&](const Noted& one) { return is_within(one.path, at); });
}

bool TomlDocument::abandoned(std::string_view at) const {
    return std::ranges::any_of(abandoned_paths, [&](const std::string& path) { return is_within(at, path); });
}

std::vector<InputProblem> TomlDocument::problems() const {
    std::vector<InputProblem> told;
    for (const Noted& one : noted) {
        told.push_back(one.problem);
    }
    const auto rank = [&](const InputProblem& problem) {
        const bool here = problem.where.file == file;
        return std::tuple(here ? 0 : 1, here ? problem.where.line : 0, here ? problem.where.column : 0);
    };
    std::ranges::stable_sort(told, {}, rank);
    return told;
}

} // namespace vkfv
