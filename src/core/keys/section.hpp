// A table of the configuration as it is read by its keys: what each means also enters the canonical text and the
// identity.
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

// What has been read.
struct ReadKeys {
    // Where each key and table stands that was read, by dotted key; defaults have the place of their table.
    std::map<std::string, SourceLocation> places;

    // Every key with its value, defaults included, in a fixed order and in the file's own units, so that it reads back
    // to the same bits: TOML. Paths are absolute.
    std::string canonical;

    // The same without what no image depends on (Influence), and with digests of what a path or a name stands for in
    // its place.
    std::string identity;
};

// A key that is read is written down with its value, or its default. Keys that are not given and have no default are
// not. The caller sees to it that keys are those of the table.
class Section {
  public:
    // A key of `keys` that the table's kind has not is refused when the kind is read.
    Section(const TomlTable& table, const KeyTable& keys, ReadKeys& read);

    const TomlTable& table() const { return table_; }
    bool has(const Key& key) const { return table_.has(key.name); }

    double number(const NumberKey& key) const;
    // The default, or the range, where they follow from other keys.
    double number(const NumberKey& key, double fallback) const;
    double number_in(const NumberKey& key, const NumberRange& range) const;
    std::optional<double> number_if_given(const NumberKey& key) const;
    std::vector<double> numbers(const NumbersKey& key) const;
    std::int64_t integer(const IntegerKey& key) const;
    std::array<std::int64_t, 2> integer_pair(const IntegerPairKey& key) const;
    std::int64_t integer(const IntegerKey& key, std::int64_t fallback) const;
    bool boolean(const BooleanKey& key) const;
    std::vector<bool> booleans(const BooleansKey& key, const std::vector<bool>& fallback) const;
    std::string text(const TextKey& key) const;
    std::optional<std::string> text_if_given(const TextKey& key) const;
    // A file that the key names, as it is looked for; its canonical text is the absolute path.
    std::filesystem::path file(const FileKey& key) const;
    std::optional<std::filesystem::path> file_if_given(const FileKey& key) const;
    template <class Value>
    Value choice(const ChoiceKey<Value>& key) const {
        return key.value_of(choice_name(key, key.value.has_value()));
    }
    // A choice that decides what other keys there are: a wrong one ends the reading of this table, and keys of other
    // kinds are refused.
    template <class Value>
    Value kind(const ChoiceKey<Value>& key) const {
        return key.value_of(kind_name(key, key.value.has_value()));
    }
    std::string kind_name(const Key& key, bool has_default) const;

    // A value, as TOML, that was read by other means.
    void record(const Key& key, const std::string& value) const;
    // A path or a name in the canonical text; in the identity nothing, or a digest of what it stands for.
    void record_reference(const Key& key, const std::string& value, const std::string& digest = "") const;

    // Throws InputError for this key's value as found; for what several values are needed to tell.
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

// The path; of a file that does not exist the absolute one, so that messages tell where it was looked for.
std::filesystem::path looked_for(const std::filesystem::path& path);

// Runs `work`, which reads a file that the key names, and says where that was named if there is no such file.
void as_named(const TomlTable& table, const std::string& key, const std::filesystem::path& file,
              const std::function<void()>& work);

// Runs `work`, and gives each problem of its InputError the place of the problem's key; without one, if it has none,
// that of the key's table, else `otherwise`.
void at_its_place(const ReadKeys& read, const SourceLocation& otherwise, const std::function<void()>& work);

} // namespace vkfv
