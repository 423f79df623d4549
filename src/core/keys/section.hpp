// A table of the configuration read by its keys; each value read also enters the canonical text and the identity.
#pragma once

#include "core/keys/key.hpp"

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// The configuration as far as it has been read.
struct ReadKeys {
    // The place of each key and table that was read, by dotted key; a default has the place of its table.
    std::map<std::string, SourceLocation> places;

    // The canonical text: all keys with their values, defaults included, in a fixed order and in the file's own units,
    // as TOML that reads back to the same bits. Paths are absolute.
    std::string canonical;

    // The identity: the canonical text without keys that affect no image (Influence), and with digests of files and
    // assets instead of their paths and names.
    std::string identity;
};

// A table of the configuration with its keys. Each key read is recorded with its value or default; keys that are not
// given and have no default are not. The caller must use only keys of this table.
class Section {
  public:
    // Starts to read a table. A key of `keys` that the table's kind lacks is refused when the kind is read.
    Section(const TomlTable& table, const KeyTable& keys, ReadKeys& read);

    const TomlTable& table() const { return table_; }
    bool has(const Key& key) const { return table_.has(key.name); }

    double number(const NumberKey& key) const;
    // For defaults, or ranges, that follow from other keys.
    double number(const NumberKey& key, double fallback) const;
    double number_in(const NumberKey& key, const NumberRange& range) const;
    std::optional<double> number_if_given(const NumberKey& key) const;
    std::vector<double> numbers(const NumbersKey& key) const;
    std::int64_t integer(const IntegerKey& key) const;
    std::array<std::int64_t, 2> integer_pair(const IntegerPairKey& key) const;
    std::int64_t integer(const IntegerKey& key, std::int64_t fallback) const;
    std::optional<std::int64_t> integer_if_given(const IntegerKey& key) const;
    bool boolean(const BooleanKey& key) const;
    std::vector<bool> booleans(const BooleansKey& key, const std::vector<bool>& fallback) const;
    std::string text(const TextKey& key) const;
    std::optional<std::string> text_if_given(const TextKey& key) const;
    // The path of a file that the key names, as looked_for(); the canonical text has the absolute path.
    std::filesystem::path file(const FileKey& key) const;
    std::optional<std::filesystem::path> file_if_given(const FileKey& key) const;
    template <class Value>
    Value choice(const ChoiceKey<Value>& key) const {
        return key.value_of(choice_name(key, key.value.has_value()));
    }
    // A choice that decides which other keys exist: an invalid one ends the reading of this table, and keys of other
    // kinds are refused.
    template <class Value>
    Value kind(const ChoiceKey<Value>& key) const {
        return key.value_of(kind_name(key, key.value.has_value()));
    }
    std::string kind_name(const Key& key, bool has_default) const;

    // Records a value, as TOML, that was read by other means.
    void record(const Key& key, const std::string& value) const;
    // Records a path or a name in the canonical text; the identity gets a digest of the content, or nothing.
    void record_reference(const Key& key, const std::string& value, const std::string& digest = "") const;

    // Throws InputError for this key's value, for conditions that involve several values.
    [[noreturn]] void fail(const Key& key, std::string expected, std::string remedy) const {
        table_.fail(key.name, std::move(expected), std::move(remedy));
    }
    void note(const Key& key, std::string expected, std::string remedy) const {
        table_.note(key.name, std::move(expected), std::move(remedy));
    }

  private:
    std::string choice_name(const Key& key, bool has_default) const;
    void reject_keys_of_other_kinds(const std::string& kind) const;
    void note_place(const std::string& name) const;

    TomlTable table_;
    const KeyTable* keys_;
    ReadKeys* read_;
};

std::filesystem::path absolute_path(const std::filesystem::path& path);

// The path, made absolute if the file does not exist, so that messages name the place searched.
std::filesystem::path looked_for(const std::filesystem::path& path);

// Runs `work`, which reads a file that the key names; if the file does not exist, the error also states where it is
// named.
void as_named(const TomlTable& table, const std::string& key, const std::filesystem::path& file,
              const std::function<void()>& work);

// Runs `work`, and places each problem of its InputError at the problem's key. A problem whose key has no place, and
// without a file, gets the place of the key's table, else `otherwise`.
void at_its_place(const ReadKeys& read, const SourceLocation& otherwise, const std::function<void()>& work);

} // namespace vkfv
