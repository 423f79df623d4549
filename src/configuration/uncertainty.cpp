// The tables [uncertainty."KEY"] and [[uncertainty.correlation]]: their keys and reader.
#include "configuration/key_documents.hpp"
#include "configuration/tables.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vkfv {

namespace {

using Distribution = UncertainInput::Distribution;

const ChoiceKey<Distribution>
    distribution("pdf",
                 {{Distribution::normal, "normal", "a Gaussian"},
                  {Distribution::student, "t", "Student's, of the degrees of freedom in dof, scaled by u"},
                  {Distribution::rectangular, "rectangular", "even over plus and minus sqrt(3) u"},
                  {Distribution::triangular, "triangular", "symmetric over plus and minus sqrt(6) u"},
                  {Distribution::arcsine, "arcsine", "of a sine, of amplitude sqrt(2) u"}},
                 Distribution::normal, "Distribution of the values that the key may truly have.");
const NumberKey standard_uncertainty("u", NumberRange::positive(), needed,
                                     "Standard uncertainty of the key's value, in the key's unit.");
const NumberKey freedom("dof", NumberRange::positive(), Default::in_words("infinite"),
                        "Degrees of freedom of this uncertainty.");
const ChoiceKey<std::string> evaluation("type", {{"A", "A", "from observations"}, {"B", "B", "from other knowledge"}},
                                        "B", "How the uncertainty was evaluated (JCGM 100).");
const TextKey source("source", Default::in_words("not stated"), "Where the uncertainty is stated, for the budget.");

const TextsKey correlated("keys", {}, Default::none(), "Two keys that have an uncertainty.");
const NumberKey coefficient("coefficient", NumberRange::within(-1, 1), needed,
                            "Their correlation coefficient. Both distributions must be normal.");

UncertainInput input_of(const std::string& key, const TomlTable& table, ReadKeys& read) {
    UncertainInput input{.key = key};
    // A section records what it reads; the uncertainties are no part of the images, so they are recorded apart.
    const auto known = distribution.choice_names();
    input.distribution =
        distribution.value_of(table.optional_choice(distribution.name, known).value_or(distribution.fallback_text()));
    input.uncertainty = table.number(standard_uncertainty.name, standard_uncertainty.range);
    if (const auto given = table.optional_number(freedom.name, freedom.range)) {
        input.degrees_of_freedom = *given;
    } else if (input.distribution == Distribution::student) {
        table.fail(freedom.name, "the degrees of freedom of Student's distribution", "Add dof = ...");
    }
    input.evaluation =
        table.optional_choice(evaluation.name, evaluation.choice_names()).value_or(evaluation.fallback_text());
    input.source = table.optional_string(source.name).value_or("");
    read.places.emplace("uncertainty." + key, table.where());
    return input;
}

// Whether the configuration has a key of this dotted name that is a number.
bool is_number(const std::string& key) {
    const auto& tables = key_tables();
    return std::ranges::any_of(tables, [&](const KeyTable* table) {
        return std::ranges::any_of(table->keys, [&](const Key* one) {
            return one->type == Key::Type::number && table->path + "." + one->name == key;
        });
    });
}

// Whether a table of the configuration has this dotted name, or one inside it.
bool is_table(const std::string& key) {
    return std::ranges::any_of(
        key_tables(), [&](const KeyTable* table) { return table->path == key || table->path.starts_with(key + "."); });
}

// Reads the tables below `table`, whose names may be whole dotted keys or the parts of one.
void read_inputs(const TomlTable& table, const std::string& before, Configuration& configuration) {
    for (const std::string& name : table.keys()) {
        const std::string key = before.empty() ? name : fmt::format("{}.{}", before, name);
        if (key == "correlation") {
            continue;
        }
        table.attempt(name, [&] {
            const TomlTable below = table.table(name);
            if (is_number(key)) {
                configuration.uncertainty.inputs.push_back(input_of(key, below, configuration));
            } else if (below.has(standard_uncertainty.name) || !is_table(key)) {
                table.fail(name, "a key of the configuration that is a number, as \"stage.scale_error\"",
                           "Correct its name; vkfv keys lists all.");
            } else {
                read_inputs(below, key, configuration);
            }
        });
    }
}

} // namespace

const KeyTable& uncertainty_keys() {
    static const KeyTable table{.path = "uncertainty.KEY",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "The uncertainty of a number of the configuration, for vkfv budget. KEY is "
                                           "the number's dotted key in quotes, as in "
                                           "[uncertainty.\"stage.scale_error\"].",
                                .subject = "an uncertainty",
                                .kind = "",
                                .keys = {&distribution, &standard_uncertainty, &freedom, &evaluation, &source}};
    return table;
}

const KeyTable& uncertainty_correlation_keys() {
    static const KeyTable table{.path = "uncertainty.correlation",
                                .presence = KeyTable::Presence::repeated,
                                .meaning = "Two uncertain numbers that deviate together.",
                                .subject = "a correlation",
                                .kind = "",
                                .keys = {&correlated, &coefficient}};
    return table;
}

// Reads [uncertainty]. No image depends on it, so nothing of it is recorded.
void read_uncertainty(const TomlTable& root, Configuration& configuration) {
    const auto table = root.optional_table("uncertainty");
    if (!table) {
        return;
    }
    read_inputs(*table, "", configuration);
    auto& inputs = configuration.uncertainty.inputs;
    for (const TomlTable& one : table->optional_tables("correlation")) {
        const auto texts = one.value_texts(correlated.name);
        const auto input_at = [&](const std::string& text) {
            return std::ranges::find_if(inputs,
                                        [&](const UncertainInput& input) { return toml_quoted(input.key) == text; });
        };
        if (texts.size() != 2 || texts[0] == texts[1] || input_at(texts[0]) == inputs.end() ||
            input_at(texts[1]) == inputs.end()) {
            one.fail(correlated.name, "two keys that have an uncertainty, in quotes", "Name two of [uncertainty].");
        }
        const auto first = input_at(texts[0]), second = input_at(texts[1]);
        if (first->distribution != Distribution::normal || second->distribution != Distribution::normal) {
            one.fail(correlated.name, "keys of normal distributions", "Give both pdf = \"normal\".");
        }
        configuration.uncertainty.correlations.push_back(
            {.first = static_cast<std::size_t>(first - inputs.begin()),
             .second = static_cast<std::size_t>(second - inputs.begin()),
             .coefficient = one.number(coefficient.name, coefficient.range)});
    }
}

} // namespace vkfv
