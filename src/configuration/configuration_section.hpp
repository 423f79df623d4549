// Tables of the configuration as they are read: what each key means also enters the canonical text and the identity.
#pragma once

#include "configuration/configuration.hpp"
#include "core/section.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// The shortest TOML float that reads back to the same bits.
std::string shortest_text(double value);

// Runs `work`, and gives each problem of its InputError the place of the problem's key; without one, if it has none,
// that of the key's table, else `otherwise`.
void at_its_place(const Configuration& configuration, const SourceLocation& otherwise,
                  const std::function<void()>& work);

// The keys that belong to each kind of a thing; those of all kinds are not among them.
using KeysOfKinds = std::map<std::string, std::vector<std::string>>;

// Refuses a key of `table` that another kind has but not `kind`. subject: "a specimen".
void reject_keys_of_other_kinds(const TomlTable& table, const KeysOfKinds& keys_of_kinds, const std::string& kind,
                                const std::string& subject);

// A table of the configuration that writes down what is read from it, with defaults, for the canonical text
// and the identity.
class OldSection {
  public:
    OldSection(const TomlTable& table, Configuration& configuration);

    const TomlTable& table() const { return table_; }

    double number(const std::string& key, const NumberRange& range, std::optional<double> fallback = {},
                  Influence influence = Influence::images) const;
    std::optional<double> number_if_given(const std::string& key, const NumberRange& range) const;
    std::vector<double> numbers(const std::string& key, const NumberRange& range) const;
    std::int64_t integer(const std::string& key, std::int64_t minimum, std::int64_t maximum,
                         std::optional<std::int64_t> fallback = {}, Influence influence = Influence::images) const;
    bool boolean(const std::string& key, bool fallback, Influence influence = Influence::images) const;
    std::vector<bool> booleans(const std::string& key, const std::vector<bool>& fallback) const;
    std::string string(const std::string& key, std::optional<std::string> fallback = {}) const;
    std::string choice(const std::string& key, const std::vector<std::string>& choices,
                       std::optional<std::string> fallback = {}, Influence influence = Influence::images) const;
    // A choice that decides what other keys there are: a wrong one ends the reading of this table.
    std::string kind(const std::string& key, const std::vector<std::string>& kinds,
                     std::optional<std::string> fallback = {}, Influence influence = Influence::images) const;
    void record(const std::string& key, const std::string& value, Influence influence) const;
    // A path or a name in the canonical text; in the identity nothing, or a digest of what it stands for.
    void record_reference(const std::string& key, const std::string& value, const std::string& digest = "") const;

  private:
    void note_place(const std::string& key) const;

    TomlTable table_;
    Configuration& configuration_;
};

} // namespace vkfv
