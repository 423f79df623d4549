// The problems that a reader notes: invalid values, missing keys, and last the unknown keys.
#include "core/toml/toml_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv {

namespace {

constexpr std::size_t most_noted = 1000; // more would not be read, and all are compared with each other

// The key without its unit, and the unit: "z_step" and "um" of "z_step_um". Keys that differ only there state the same
// quantity.
std::pair<std::string_view, std::string_view> without_unit(std::string_view key) {
    const auto last = key.rfind('_');
    return last == std::string_view::npos ? std::pair(key, std::string_view())
                                          : std::pair(key.substr(0, last), key.substr(last + 1));
}

std::string remedy_for_misspelt(std::string_view found, std::string_view meant) {
    const auto [found_stem, found_unit] = without_unit(found);
    const auto [meant_stem, meant_unit] = without_unit(meant);
    const bool other_unit = found_stem == meant_stem && !meant_unit.empty();
    return fmt::format("Did you mean \"{}\"? Rename it{}.", meant,
                       other_unit ? fmt::format(", and give its value in {}", meant_unit) : "");
}

} // namespace

const toml::node* TomlTable::State::find(std::string_view key) {
    asked.emplace(key);
    return table->get(key);
}

std::shared_ptr<TomlTable::State> TomlTable::State::child(const std::string& name, const toml::table& node) {
    auto& state = children[name];
    if (!state) {
        state = std::make_shared<State>();
        state->document = document;
        state->table = &node;
        state->path = dotted(path, name);
        state->where = node.source().begin ? document->place(node.source()) : where;
    }
    return state;
}

InputProblem TomlTable::State::problem(std::string_view key, const toml::node* node, std::string expected,
                                       std::string remedy) const {
    return {.where = node && node->source().begin ? document->place(node->source()) : where,
            .key = dotted(path, key),
            .found = node ? text_of(*node) : "",
            .expected = std::move(expected),
            .remedy = std::move(remedy)};
}

void TomlTable::State::refuse(std::string_view key, const toml::node* node, std::string expected,
                              std::string remedy) const {
    throw InputError(problem(key, node, std::move(expected), std::move(remedy)));
}

void TomlTable::State::add(TomlDocument::Noted one) const {
    if (!document->collecting) {
        throw InputError(std::move(one.problem));
    }
    if (document->noted.size() >= most_noted) {
        throw InputError(document->problems());
    }
    // A key that is read twice is reported once.
    const auto same = [&](const TomlDocument::Noted& other) {
        return other.path == one.path && other.problem.where == one.problem.where;
    };
    if (std::ranges::none_of(document->noted, same)) {
        document->noted.push_back(std::move(one));
    }
}

void TomlTable::State::note(std::string_view key, const toml::node* node, std::string expected,
                            std::string remedy) const {
    add({.path = dotted(path, key),
         .problem = problem(key, node, std::move(expected), std::move(remedy)),
         .missing = "",
         .expected = ""});
}

void TomlTable::State::note_missing(std::string_view key, const std::string& expected) const {
    if (table->get(key)) {
        return;
    }
    add({.path = dotted(path, key),
         .problem =
             problem(key, nullptr, expected + ", found nothing",
                     path.empty() ? fmt::format("Add the key {}.", key) : fmt::format("Add {} to [{}].", key, path)),
         .missing = std::string(key),
         .expected = expected});
}

void TomlTable::State::note_missing_tables(std::string_view key, const std::string& expected,
                                           const std::string& header) const {
    add({.path = dotted(path, key),
         .problem =
             problem(key, table->get(key), expected + ", found nothing", fmt::format("Add {} with its keys.", header)),
         .missing = table->get(key) ? "" : std::string(key),
         .expected = expected});
}

// Pairs a missing key with an unknown one: most likely the one is the other, misspelt. They become one problem, at the
// misspelt key's place. Each must be the nearest to the other, and nearer still where reading ended early, as keys that
// it would have asked for stand there too.
void TomlTable::State::pair_missing_with_unknown(std::set<std::string>& paired) {
    const std::size_t furthest = document->abandoned(path) ? 2 : std::string::npos;
    std::vector<std::string> unknown;
    for (auto&& [key, node] : *table) {
        if (!asked.contains(key.str())) {
            unknown.emplace_back(key.str());
        }
    }
    const std::vector<std::string> known(asked.begin(), asked.end());
    for (auto& one : document->noted) {
        if (one.missing.empty() || one.path != dotted(path, one.missing)) {
            continue;
        }
        const auto found = nearest_word(one.missing, unknown, furthest);
        if (!found || nearest_word(*found, known, furthest) != one.missing || !paired.insert(*found).second) {
            continue;
        }
        const toml::node* node = table->get(*found);
        const auto* key = &table->find(*found)->first;
        one.problem = problem(*found, node, fmt::format("{} as {}", one.path, one.expected),
                              remedy_for_misspelt(*found, one.missing));
        if (key->source().begin) {
            one.problem.where = document->place(key->source());
        }
    }
}

void TomlTable::State::note_unknown() {
    std::set<std::string> paired;
    pair_missing_with_unknown(paired);
    if (document->abandoned(path)) {
        return;
    }
    const std::vector<std::string> known(asked.begin(), asked.end());
    for (auto&& [key, node] : *table) {
        const std::string name(key.str());
        if (asked.contains(name) || paired.contains(name) || document->noted.size() >= most_noted) {
            continue;
        }
        const auto meant = nearest_word(name, known);
        auto unknown = problem(
            name, &node, known.empty() ? "no key here" : fmt::format("a known key (one of {})", fmt::join(known, ", ")),
            meant ? fmt::format("Did you mean \"{}\"? Correct or remove it.", *meant) : "Remove it.");
        // The key's place, if known, is more exact than the value's; an inserted override keeps its own origin.
        if (key.source().begin) {
            unknown.where = document->place(key.source());
        }
        document->noted.push_back(
            {.path = dotted(path, name), .problem = std::move(unknown), .missing = "", .expected = ""});
    }
    for (const auto& [name, state] : children) {
        state->note_unknown();
    }
}

void TomlTable::collect_problems() const {
    state_->document->collecting = true;
}

bool TomlTable::sound(std::string_view path) const {
    return state_->document->sound(path);
}

void TomlTable::require(std::string_view key) const {
    const std::string path = dotted(state_->path, key);
    for (const auto& one : state_->document->noted) {
        if (one.path == path) {
            throw InputError(one.problem);
        }
    }
}

void TomlTable::attempt(std::string_view key, const std::function<void()>& read) const {
    auto& document = *state_->document;
    if (!document.collecting) {
        read();
        return;
    }
    const std::string path = dotted(state_->path, key);
    try {
        read();
    } catch (const InputError& error) {
        state_->asked.emplace(key);
        document.abandoned_paths.push_back(path);
        // An error behind an unreadable part may be its consequence and is not reported.
        if (document.sound(path)) {
            for (const auto& problem : error.problems()) {
                document.noted.push_back({.path = path, .problem = problem, .missing = "", .expected = ""});
            }
        }
    }
}

void TomlTable::note(std::string_view key, std::string expected, std::string remedy) const {
    const std::string path = dotted(state_->path, key);
    if (!state_->document->collecting || state_->document->sound(path)) {
        state_->note(key, state_->table->get(key), std::move(expected), std::move(remedy));
    }
}

void TomlTable::fail(std::string_view key, std::string expected, std::string remedy) const {
    state_->refuse(key, state_->table->get(key), std::move(expected), std::move(remedy));
}

void TomlTable::reject_unknown_keys() const {
    auto& document = *state_->document;
    state_->note_unknown();
    if (!document.noted.empty()) {
        const InputError error(document.problems());
        document.noted.clear();
        throw error;
    }
}

} // namespace vkfv
