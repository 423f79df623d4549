// Keys of the configuration, each declared once: their checks for readers, and their descriptions for documents.
#pragma once

#include "core/toml/toml_reader.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vkfv {

// States whether the bits of the images depend on a key.
enum class Influence { images, nothing };

// The meaning of a key without a value.
struct Default {
    std::string toml;   // default as TOML; empty: none that could be written
    std::string text;   // in words, if it is no fixed value: "all of the file"
    bool needed = true; // true: no default, the key must be given

    static Default none() { return {}; }
    static Default of(double value);
    static Default of(std::int64_t value);
    static Default of(bool value);
    static Default of(const std::string& value);
    static Default in_words(std::string text) { return {.toml = {}, .text = std::move(text), .needed = false}; }
};

// Marks a key without a default, which must be given.
inline constexpr std::nullopt_t needed = std::nullopt;

// The properties common to keys of all types. The name ends in the unit, if there is one: "radius_mm".
class Key {
  public:
    enum class Type { number, integer, integer_pair, boolean, text, choice, file, numbers, booleans, texts };
    struct Choice {
        std::string name;
        std::string meaning; // a sentence; empty: the name is clear
    };

    std::string name;
    Type type;
    std::string meaning; // one sentence
    Default fallback;
    NumberRange range{};              // for numbers and integers
    std::vector<Choice> choices{};    // for a choice, or for each of several texts
    std::string example{};            // TOML for templates, of keys that must be given
    std::vector<std::string> kinds{}; // values of the table's `kind` key that have this key; empty: all
    Influence influence = Influence::images;

    // The unit: "mm", "um", "deg", "W", "s"; empty for a number without a unit and for other types.
    std::string unit() const;
    // The allowed values: "> 0", "1 to 64", "\"disc\" or \"ring\""; empty: every value of the type.
    std::string allowed() const;
    std::vector<std::string> choice_names() const;
    // The default of a text or a choice without its quotes; empty if there is none.
    std::string fallback_text() const;
};

// A number. Without a `fallback` the key must be given.
class NumberKey : public Key {
  public:
    NumberKey(std::string name, NumberRange range, std::optional<double> fallback, std::string meaning);
    // A number with a default that is only described in words; it has no value if it is not given.
    NumberKey(std::string name, NumberRange range, Default fallback, std::string meaning);
    std::optional<double> value; // default
};

class IntegerKey : public Key {
  public:
    IntegerKey(std::string name, std::int64_t minimum, std::int64_t maximum, std::optional<std::int64_t> fallback,
               std::string meaning);
    // An integer with a default that is only described in words; it has no value if it is not given.
    IntegerKey(std::string name, std::int64_t minimum, std::int64_t maximum, Default fallback, std::string meaning);
    std::int64_t minimum, maximum;
    std::optional<std::int64_t> value;
};

// Two integers in brackets, or one for both.
class IntegerPairKey : public Key {
  public:
    // The constructor of a pair that must be given.
    IntegerPairKey(std::string name, std::int64_t minimum, std::int64_t maximum, std::string meaning);
    std::int64_t minimum, maximum;
};

class BooleanKey : public Key {
  public:
    BooleanKey(std::string name, bool fallback, std::string meaning);
    bool value;
};

class TextKey : public Key {
  public:
    TextKey(std::string name, Default fallback, std::string meaning);
};

// A path, relative to the place where it is written.
class FileKey : public Key {
  public:
    FileKey(std::string name, Default fallback, std::string meaning);
};

class NumbersKey : public Key {
  public:
    NumbersKey(std::string name, NumberRange range, Default fallback, std::string meaning);
};

class BooleansKey : public Key {
  public:
    BooleansKey(std::string name, Default fallback, std::string meaning);
};

// Several texts, each one of the choices, if there are any.
class TextsKey : public Key {
  public:
    TextsKey(std::string name, std::vector<Choice> choices, Default fallback, std::string meaning);
};

// One of several words, each of which stands for a value of the type Value.
template <class Value>
class ChoiceKey : public Key {
  public:
    struct Option {
        Value value;
        std::string name;
        std::string meaning{};
    };
    // A choice with its options. Without a fallback the key must be given.
    ChoiceKey(std::string key_name, std::vector<Option> options_, std::optional<Value> fallback_,
              std::string key_meaning)
        : Key{.name = std::move(key_name), .type = Type::choice, .meaning = std::move(key_meaning), .fallback = {}},
          options(std::move(options_)), value(fallback_) {
        for (const auto& option : options) {
            choices.push_back({option.name, option.meaning});
            if (value == option.value) {
                fallback = Default::of(option.name);
            }
        }
    }
    const std::string& name_of(Value wanted) const {
        for (const auto& option : options) {
            if (option.value == wanted) {
                return option.name;
            }
        }
        return options.front().name;
    }
    Value value_of(const std::string& wanted) const {
        for (const auto& option : options) {
            if (option.name == wanted) {
                return option.value;
            }
        }
        return options.front().value;
    }

    std::vector<Option> options;
    std::optional<Value> value;
};

// The functions below add a property to a key at its declaration.
template <class AnyKey>
AnyKey of_kinds(std::vector<std::string> kinds, AnyKey key) {
    key.kinds = std::move(kinds);
    return key;
}
template <class AnyKey>
AnyKey without_influence(AnyKey key) {
    key.influence = Influence::nothing;
    return key;
}
template <class AnyKey>
AnyKey with_default(Default fallback, AnyKey key) {
    key.fallback = std::move(fallback);
    return key;
}
template <class AnyKey>
AnyKey for_example(std::string toml, AnyKey key) {
    key.example = std::move(toml);
    return key;
}

// A table of the configuration.
struct KeyTable {
    enum class Presence { needed, optional, repeated }; // repeated: [[path]], any number of times
    std::string path;                                   // dotted path: "source.spectrum"; empty: the root
    Presence presence = Presence::needed;
    std::string meaning; // one or two sentences
    std::string subject; // subject of messages with `kind`: "a source"; empty: the key is named
    std::string kind;    // key that decides which other keys exist; empty: none
    std::vector<const Key*> keys;
    bool shown = false;   // true: shown in a template although optional
    bool several = false; // true: either one [path] or several [[path]]

    // The values of the key `kind`, in the order of its choices.
    std::vector<std::string> kinds() const;
};

} // namespace vkfv
