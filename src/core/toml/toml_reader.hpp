// A checked reader of TOML: every value is requested by key, type and range, and an invalid one becomes an InputError
// that names file, line, column, dotted key, value, expectation and remedy.
#pragma once

#include "core/messages/error.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

// The allowed numbers of a key; NaN and infinities are never allowed.
struct NumberRange {
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
    bool minimum_included = true;
    bool maximum_included = true;

    static NumberRange finite() { return {}; }
    static NumberRange positive() { return {.minimum = 0, .minimum_included = false}; }
    static NumberRange at_least(double minimum) { return {.minimum = minimum}; }
    static NumberRange within(double minimum, double maximum) { // both ends included
        return {.minimum = minimum, .maximum = maximum};
    }
    static NumberRange share() { return {0, 1, false, true}; }   // share of a whole, above 0
    static NumberRange between(double minimum, double maximum) { // both ends excluded
        return {minimum, maximum, false, false};
    }

    bool contains(double value) const;
    // The range as text: "> 0", "in [-1, 1]", "in (0, 1)"; empty if all finite numbers are allowed.
    std::string to_string() const;
};

// True for a key whose name says that its value is a length in um; "magnification_per_um" is none.
bool is_length_in_um(std::string_view key);

// The expectation in the message that refuses an unphysical length: 0, or a length of either sign from 1 pm, a
// hundredth of an atom, to 1000 km. None for such a length, and for a key whose name says no length in mm or um.
// Squares and quotients of other lengths would exceed the range of a double.
std::optional<std::string> expected_length(std::string_view key, double value);

// The remedy for a length in um beyond its range that most likely was given in nm; none if it was not.
std::optional<std::string> remedy_for_length_um(double value, const NumberRange& range);

// A value given on the command line that replaces the file's.
struct TomlOverride {
    std::string key;    // dotted path from the root: "trace.rays"
    std::string value;  // TOML ("1e7", "\"quadtree\"", "[1, 2]"); any other text is taken as a string
    std::string origin; // replaces the file in messages: "--rays"
};

// A table of a TOML document. Copies share one document and the record of requested keys; a document must not be used
// by several threads. Every getter throws InputError, unless problems are collected; those that begin with `optional_`
// return none for a missing key.
class TomlTable {
  public:
    // The root table of a file, with the overrides inserted. Throws InputError for a file that cannot be read and for
    // invalid TOML.
    static TomlTable open(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides = {});
    // The root table of a text; `name` stands for the file in messages.
    static TomlTable parse(std::string_view text, const std::filesystem::path& name,
                           const std::vector<TomlOverride>& overrides = {});

    // The dotted key of this table; empty for the root.
    const std::string& path() const;
    // The place of this table's header (the root: line 1), or of a key's value. A missing key has its table's place.
    SourceLocation where() const;
    SourceLocation where(std::string_view key) const;
    bool has(std::string_view key) const; // does not count as requesting the key
    // The keys in alphabetical order, for tables whose keys are data; they count as requested.
    std::vector<std::string> keys() const;

    // Adds keys from the table of this name in another file that this table lacks. They behave as if written here,
    // except that messages name that file, and relative paths start there. Throws InputError for a file without such a
    // table, and for one with content besides it and a `title`.
    void complete_from(const std::filesystem::path& file) const;

    // A number; integers and floats are both accepted.
    double number(std::string_view key, const NumberRange& range = NumberRange::finite()) const;
    std::optional<double> optional_number(std::string_view key, const NumberRange& range = NumberRange::finite()) const;
    // An integer; a float of integral value up to 2^53 is accepted too: 1e9 is an integer.
    std::int64_t integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) const;
    std::optional<std::int64_t> optional_integer(std::string_view key, std::int64_t minimum,
                                                 std::int64_t maximum) const;
    // A pair [first, second], or one integer for both.
    std::array<std::int64_t, 2> integer_pair(std::string_view key, std::int64_t minimum, std::int64_t maximum) const;
    bool boolean(std::string_view key) const;
    std::optional<bool> optional_boolean(std::string_view key) const;
    std::optional<std::vector<bool>> optional_booleans(std::string_view key) const;
    // A string, which is never empty.
    std::string string(std::string_view key) const;
    std::optional<std::string> optional_string(std::string_view key) const;
    // A string that is one of the choices.
    std::string choice(std::string_view key, const std::vector<std::string>& choices) const;
    std::optional<std::string> optional_choice(std::string_view key, const std::vector<std::string>& choices) const;
    // A path, relative to the place where it is written: the file's folder, or the working directory for an override.
    std::filesystem::path file_path(std::string_view key) const;
    std::optional<std::filesystem::path> optional_file_path(std::string_view key) const;
    std::vector<std::filesystem::path> optional_file_paths(std::string_view key) const; // empty if missing
    std::vector<double> numbers(std::string_view key, const NumberRange& range = NumberRange::finite()) const;
    std::optional<std::vector<double>> optional_numbers(std::string_view key,
                                                        const NumberRange& range = NumberRange::finite()) const;
    // The elements of an array of numbers, strings and booleans, at least one, as TOML text for TomlOverride.
    std::vector<std::string> value_texts(std::string_view key) const;
    TomlTable table(std::string_view key) const;
    std::optional<TomlTable> optional_table(std::string_view key) const;
    TomlTable table_or_empty(std::string_view key) const; // a missing table becomes one without keys
    // The tables [[key]] or an array of inline tables; `tables` requires at least one.
    std::vector<TomlTable> tables(std::string_view key) const;
    std::vector<TomlTable> optional_tables(std::string_view key) const;
    // A single [key], or one or several [[key]].
    std::vector<TomlTable> table_or_tables(std::string_view key) const;

    // Throws for the keys, in this table and those obtained from it, that were never requested, and suggests the
    // nearest requested ones; the error includes all noted problems. It must be the last call, on the root.
    void reject_unknown_keys() const;

    // From here on all getters of this document note problems and continue with a harmless value (none, the default, a
    // number in the range, the first choice), so that reject_unknown_keys() can report all at once. A missing table
    // still throws, to the attempt() around it.
    void collect_problems() const;
    // Runs `read`, which reads this key or table and its dependents. While problems are collected an InputError is
    // noted, unless a problem there was noted before: then it may be a consequence. Keys there that were not requested
    // yet do not count as unknown.
    void attempt(std::string_view key, const std::function<void()>& read) const;
    // Throws if a problem was noted at this key, for keys that decide how others are read.
    void require(std::string_view key) const;
    // True if no problem was noted at this path, dotted from the root, or below it.
    bool sound(std::string_view path) const;

    // Throws InputError for this key's value, for conditions that involve several values.
    [[noreturn]] void fail(std::string_view key, std::string expected, std::string remedy) const;
    // Throws like fail(), but while problems are collected the problem is noted instead, once for each key.
    void note(std::string_view key, std::string expected, std::string remedy) const;

  private:
    struct State;
    template <class Convert>
    auto get(std::string_view key, const std::string& expected, Convert convert) const;
    explicit TomlTable(std::shared_ptr<State> state);
    std::shared_ptr<State> state_;
};

// The shortest TOML float that reads back to the same bits.
std::string shortest_toml(double value);

// `text` as a TOML basic string, with its quotes.
std::string toml_quoted(std::string_view text);

// The candidate that a misspelt `word` most likely meant (edit distance, a swap of neighbours counting one); none if
// all are too different, or differ by more than `most_steps`.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates,
                                        std::size_t most_steps = std::string::npos);

} // namespace vkfv
