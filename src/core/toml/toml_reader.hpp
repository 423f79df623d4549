// A checked reader of TOML: every value is asked for by key, type and range, and whatever is wrong with it
// becomes an InputError that names file, line, column, dotted key, value, expectation and remedy.
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

// The numbers a key may have; NaN and infinities never belong to it.
struct NumberRange {
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
    bool minimum_included = true;
    bool maximum_included = true;

    static NumberRange finite() { return {}; }
    static NumberRange positive() { return {.minimum = 0, .minimum_included = false}; }
    static NumberRange at_least(double minimum) { return {.minimum = minimum}; }
    static NumberRange within(double minimum, double maximum) { // ends included
        return {.minimum = minimum, .maximum = maximum};
    }
    static NumberRange share() { return {0, 1, false, true}; }   // of a whole, and not none
    static NumberRange between(double minimum, double maximum) { // ends excluded
        return {minimum, maximum, false, false};
    }

    bool contains(double value) const;
    // "> 0", "in [-1, 1]", "in (0, 1)"; empty if every finite number is meant.
    std::string to_string() const;
};

// A length that nothing has is refused in these words, which say what is expected in its place: 0, or a length of
// either sign from 1 pm, a hundredth of an atom, to 1000 km. None for such a length, and for a key whose name ends
// neither in
// "_mm" nor in "_um". Squares and quotients of lengths beyond these would leave the numbers that a double can hold.
std::optional<std::string> expected_length(std::string_view key, double value);

// What to do about a length in um beyond its range that most likely was given in nm; none if it was not.
std::optional<std::string> remedy_for_length_um(double value, const NumberRange& range);

// A value given on the command line in place of the file's.
struct TomlOverride {
    std::string key;    // dotted, from the root: "trace.rays"
    std::string value;  // TOML ("1e7", "\"quadtree\"", "[1, 2]"); what is no TOML value is taken as a string
    std::string origin; // stands for the file in messages: "--rays"
};

// A table of a TOML document. Copies share one document and one memory of the keys asked for; not for use by
// several threads. Every getter throws InputError, unless problems are collected; those that begin with `optional_`
// give nothing for a missing key.
class TomlTable {
  public:
    // The root table of a file, with the overrides put in their places. Throws InputError for a file that
    // cannot be read and for text that is not TOML.
    static TomlTable open(const std::filesystem::path& file, const std::vector<TomlOverride>& overrides = {});
    // The same of a text; `name` stands for the file in messages.
    static TomlTable parse(std::string_view text, const std::filesystem::path& name,
                           const std::vector<TomlOverride>& overrides = {});

    // Dotted key of this table; empty for the root.
    const std::string& path() const;
    // Of this table's header (the root: line 1), or of a key's value. A missing key has its table's place.
    SourceLocation where() const;
    SourceLocation where(std::string_view key) const;
    bool has(std::string_view key) const; // does not count as asking for it
    // Keys in the order of the alphabet, for tables whose keys are data; they count as asked for.
    std::vector<std::string> keys() const;

    // Takes over what the table of this name in another file has and this one has not: as if it stood here, but
    // messages name that file, and relative paths start there. Throws InputError for a file without such a table, and
    // for one that has more than it and a `title`.
    void complete_from(const std::filesystem::path& file) const;

    // Integers and floats alike.
    double number(std::string_view key, const NumberRange& range = NumberRange::finite()) const;
    std::optional<double> optional_number(std::string_view key, const NumberRange& range = NumberRange::finite()) const;
    // Also a float of integral value up to 2^53: 1e9 is an integer.
    std::int64_t integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) const;
    std::optional<std::int64_t> optional_integer(std::string_view key, std::int64_t minimum,
                                                 std::int64_t maximum) const;
    // [first, second], or one integer for both.
    std::array<std::int64_t, 2> integer_pair(std::string_view key, std::int64_t minimum, std::int64_t maximum) const;
    bool boolean(std::string_view key) const;
    std::optional<bool> optional_boolean(std::string_view key) const;
    std::optional<std::vector<bool>> optional_booleans(std::string_view key) const;
    // Never empty.
    std::string string(std::string_view key) const;
    std::optional<std::string> optional_string(std::string_view key) const;
    // One of the choices.
    std::string choice(std::string_view key, const std::vector<std::string>& choices) const;
    std::optional<std::string> optional_choice(std::string_view key, const std::vector<std::string>& choices) const;
    // A path, relative to where it was written: the file's folder, or the working directory for an override.
    std::filesystem::path file_path(std::string_view key) const;
    std::optional<std::filesystem::path> optional_file_path(std::string_view key) const;
    std::vector<std::filesystem::path> optional_file_paths(std::string_view key) const; // none: empty
    std::vector<double> numbers(std::string_view key, const NumberRange& range = NumberRange::finite()) const;
    std::optional<std::vector<double>> optional_numbers(std::string_view key,
                                                        const NumberRange& range = NumberRange::finite()) const;
    // The elements of an array of numbers, strings and booleans, at least one, as TOML text: what TomlOverride takes.
    std::vector<std::string> value_texts(std::string_view key) const;
    TomlTable table(std::string_view key) const;
    std::optional<TomlTable> optional_table(std::string_view key) const;
    TomlTable table_or_empty(std::string_view key) const; // a missing table is one without keys
    // [[key]] or an array of inline tables; `tables` wants at least one.
    std::vector<TomlTable> tables(std::string_view key) const;
    std::vector<TomlTable> optional_tables(std::string_view key) const;
    // [key] alone, or one or several [[key]].
    std::vector<TomlTable> table_or_tables(std::string_view key) const;

    // Throws for the keys, here and in the tables got from here, that nobody has asked for, and names the
    // nearest of those that were; with them for all that was noted. Call it on the root, last.
    void reject_unknown_keys() const;

    // From here on all getters of this document note what is wrong and go on with a value that does no harm (nothing,
    // the default, a number in the range, the first choice), so that reject_unknown_keys() can tell of all at once. A
    // missing table still throws, to the attempt() around it.
    void collect_problems() const;
    // Reads this key or table, and what belongs to it. While problems are collected an InputError is noted, unless
    // something there was noted before: then it may be a consequence. Keys there that were not asked for by then are
    // not taken as unknown.
    void attempt(std::string_view key, const std::function<void()>& read) const;
    // Throws if something was noted at this key: for those that decide how all else is read.
    void require(std::string_view key) const;
    // Whether nothing was noted at this path, dotted from the root, or below it.
    bool sound(std::string_view path) const;

    // Throws InputError for this key's value as found; for what several values are needed to tell.
    [[noreturn]] void fail(std::string_view key, std::string expected, std::string remedy) const;
    // The same, but noted while problems are collected, once a key.
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

// That of `candidates` that a misspelt `word` most likely meant (edit distance, swapped neighbours counting
// one); none if all are too far off, or more than `most_steps`.
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates,
                                        std::size_t most_steps = std::string::npos);

} // namespace vkfv
