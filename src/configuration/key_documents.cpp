#include "configuration/key_documents.hpp"

#include "configuration/tables.hpp"
#include "core/messages/json_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace vkfv {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view any_key = "KEY"; // in a table's path: any key of the configuration

const char* type_text(const Key& key) {
    switch (key.type) {
    case Key::Type::number:
        return "number";
    case Key::Type::integer:
        return "integer";
    case Key::Type::integer_pair:
        return "integer, or two in brackets,";
    case Key::Type::boolean:
        return "true or false";
    case Key::Type::text:
        return "text";
    case Key::Type::choice:
        return "one word of";
    case Key::Type::file:
        return "path";
    case Key::Type::numbers:
        return "list of numbers";
    case Key::Type::booleans:
        return "list of true and false";
    case Key::Type::texts:
        return "list";
    }
    return "";
}

// The values that a key takes, as "number > 0, mm".
std::string value_text(const Key& key) {
    std::string text = type_text(key);
    if (const auto allowed = key.allowed(); !allowed.empty()) {
        text += (key.type == Key::Type::texts ? " of " : " ") + allowed;
    }
    const auto unit = key.unit();
    return unit.empty() ? text : text + ", " + unit;
}

std::string default_text(const Key& key) {
    if (key.fallback.needed) {
        return "must be given";
    }
    return key.fallback.text.empty() ? key.fallback.toml : key.fallback.text;
}

std::string kinds_text(const KeyTable& table, const Key& key) {
    return key.kinds.empty() ? std::string() : fmt::format("{} = \"{}\"", table.kind, fmt::join(key.kinds, "\" or \""));
}

std::string header_of(const KeyTable& table) {
    if (table.path.empty()) {
        return "before the first table";
    }
    return table.presence == KeyTable::Presence::repeated ? "[[" + table.path + "]]" : "[" + table.path + "]";
}

std::string dotted(const KeyTable& table, const Key& key) {
    return table.path.empty() ? key.name : table.path + "." + key.name;
}

std::string explanation(const KeyTable& table, const Key& key) {
    std::string text = fmt::format("{}\n  {}\n  value    {}\n  default  {}\n", dotted(table, key), key.meaning,
                                   value_text(key), default_text(key));
    if (const auto kinds = kinds_text(table, key); !kinds.empty()) {
        text += fmt::format("  only     with {}\n", kinds);
    }
    for (const auto& choice : key.choices) {
        if (!choice.meaning.empty()) {
            text += fmt::format("  {:<16} {}\n", toml_quoted(choice.name), choice.meaning);
        }
    }
    if (key.influence == Influence::nothing) {
        text += "  No traced image depends on it.\n";
    }
    return text;
}

// The text with "|" escaped, which would end a cell of a Markdown table.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
        text.insert(at, "\\");
    }
    return text;
}

Json schema_of(const Key& key) {
    Json schema;
    const auto numbers = [&](Json& of) {
        of["type"] = "number";
        if (std::isfinite(key.range.minimum)) {
            of[key.range.minimum_included ? "minimum" : "exclusiveMinimum"] = key.range.minimum;
        }
        if (std::isfinite(key.range.maximum)) {
            of[key.range.maximum_included ? "maximum" : "exclusiveMaximum"] = key.range.maximum;
        }
    };
    switch (key.type) {
    case Key::Type::number:
    case Key::Type::integer: // TOML integers include 1e9
        numbers(schema);
        break;
    case Key::Type::integer_pair: {
        Json one;
        numbers(one);
        schema["anyOf"] = {one, {{"type", "array"}, {"items", one}, {"minItems", 2}, {"maxItems", 2}}};
        break;
    }
    case Key::Type::boolean:
        schema["type"] = "boolean";
        break;
    case Key::Type::text:
    case Key::Type::file:
        schema["type"] = "string";
        break;
    case Key::Type::choice:
        schema["enum"] = key.choice_names();
        break;
    case Key::Type::numbers:
        schema["type"] = "array";
        numbers(schema["items"]);
        break;
    case Key::Type::booleans:
        schema["type"] = "array";
        schema["items"]["type"] = "boolean";
        break;
    case Key::Type::texts:
        schema["type"] = "array";
        if (!key.choices.empty()) {
            schema["items"]["enum"] = key.choice_names();
        }
        break;
    }
    return schema;
}

// Adds a key to a schema. Keys of one name that differ by the table's kind become one property, which allows what any
// of them takes.
void add_to_schema(Json& properties, const KeyTable& table, const Key& key) {
    Json schema = schema_of(key);
    std::string description = key.meaning;
    if (const auto unit = key.unit(); !unit.empty()) {
        description += fmt::format(" Unit: {}.", unit);
    }
    description += fmt::format(" Default: {}.", default_text(key));
    if (const auto kinds = kinds_text(table, key); !kinds.empty()) {
        description += fmt::format(" Only with {}.", kinds);
    }
    if (!properties.contains(key.name)) {
        schema["description"] = description;
        properties[key.name] = schema;
        return;
    }
    Json& known = properties[key.name];
    const std::string both = known["description"].get<std::string>() + " " + description;
    Json plain = known;
    plain.erase("description");
    if (plain == schema) {
        known["description"] = both;
    } else {
        Json options = plain.contains("anyOf") ? plain["anyOf"] : Json::array({plain});
        options.push_back(schema);
        known = {{"anyOf", options}, {"description", both}};
    }
}

} // namespace

const std::vector<const KeyTable*>& key_tables() {
    static const std::vector<const KeyTable*> tables = [] {
        std::vector<const KeyTable*> all = {
            &root_keys(),          &source_keys(),      &spectrum_keys(),     &illumination_keys(), &light_field_keys(),
            &beam_splitter_keys(), &fold_mirror_keys(), &interfaces_keys(),   &objective_keys(),    &cover_glass_keys(),
            &tube_lens_keys(),     &detector_keys(),    &mesh_element_keys(), &camera_keys()};
        const auto specimens = specimen_key_tables();
        all.insert(all.end(), specimens.begin(), specimens.end());
        all.insert(all.end(),
                   {&scan_keys(), &stage_keys(), &trace_keys(), &topography_keys(), &diffraction_keys(), &output_keys(),
                    &sweep_keys(), &sweep_parameter_keys(), &uncertainty_keys(), &uncertainty_correlation_keys()});
        return all;
    }();
    return tables;
}

std::string keys_text() {
    std::string text;
    for (const KeyTable* table : key_tables()) {
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", header_of(*table));
        for (const Key* key : table->keys) {
            const auto kinds = kinds_text(*table, *key);
            text += fmt::format("  {:<24} {} Default: {}.{}\n", key->name, key->meaning, default_text(*key),
                                kinds.empty() ? "" : fmt::format(" Only with {}.", kinds));
        }
    }
    return text;
}

std::string keys_json() {
    Json list = Json::array();
    for (const KeyTable* table : key_tables()) {
        for (const Key* key : table->keys) {
            Json entry = {{"key", dotted(*table, *key)},
                          {"table", table->path},
                          {"repeated", table->presence == KeyTable::Presence::repeated},
                          {"type", type_text(*key)},
                          {"unit", key->unit()},
                          {"allowed", key->allowed()},
                          {"must_be_given", key->fallback.needed},
                          {"default", default_text(*key)},
                          {"meaning", key->meaning},
                          {"images_depend_on_it", key->influence == Influence::images},
                          {"only_with", key->kinds}};
            Json choices = Json::array();
            for (const auto& choice : key->choices) {
                choices.push_back({{"name", choice.name}, {"meaning", choice.meaning}});
            }
            entry["choices"] = std::move(choices);
            list.push_back(std::move(entry));
        }
    }
    return json_text(list) + "\n";
}

std::string keys_markdown() {
    std::string text = "# The keys of a configuration\n\n"
                       "A configuration is a TOML file. Lengths, angles and the like carry their unit in the key's "
                       "name. A length is 0, where its range says so, or from 1 pm to 1000 km. This page is written by "
                       "`vkfv keys --markdown`; `vkfv explain KEY` tells of one key, "
                       "`vkfv template` prints a configuration with all of them, `vkfv keys --schema` a JSON Schema "
                       "for editors.\n";
    for (const KeyTable* table : key_tables()) {
        const char* presence = table->presence == KeyTable::Presence::needed     ? " Required."
                               : table->presence == KeyTable::Presence::repeated ? " May be repeated."
                                                                                 : "";
        text += table->path.empty() ? "\n## Before the first table\n" : fmt::format("\n## `{}`\n", header_of(*table));
        text +=
            fmt::format("\n{}{}\n\n| key | value | default | meaning |\n|---|---|---|---|\n", table->meaning, presence);
        for (const Key* key : table->keys) {
            std::string meaning = key->meaning;
            if (const auto kinds = kinds_text(*table, *key); !kinds.empty()) {
                meaning += fmt::format(" Only with `{}`.", kinds);
            }
            std::vector<std::string> explained_choices;
            for (const auto& choice : key->choices) {
                if (!choice.meaning.empty()) {
                    explained_choices.push_back(fmt::format("`{}`: {}", toml_quoted(choice.name), choice.meaning));
                }
            }
            if (!explained_choices.empty()) {
                meaning += fmt::format(" {}.", fmt::join(explained_choices, "; "));
            }
            text += fmt::format("| `{}` | {} | {} | {} |\n", key->name, cell(value_text(*key)),
                                cell(default_text(*key)), cell(meaning));
        }
    }
    return text;
}

std::string explained(const std::string& key) {
    std::string text;
    std::vector<std::string> known;
    for (const KeyTable* table : key_tables()) {
        if (table->path == key && !table->path.empty()) {
            text += fmt::format("{}\n  {}\n", header_of(*table), table->meaning);
            for (const Key* one : table->keys) {
                text += "\n" + explanation(*table, *one);
            }
        }
        known.push_back(table->path);
        for (const Key* one : table->keys) {
            known.push_back(dotted(*table, *one));
            // A key is also found by its last word.
            if (known.back() == key || (one->name == key && !table->path.empty())) {
                text += (text.empty() ? "" : "\n") + explanation(*table, *one);
            }
        }
    }
    if (text.empty()) {
        const auto meant = nearest_word(key, known);
        throw InputError(
            {.where = {.file = "command line", .line = 0, .column = 0, .byte_offset = {}},
             .key = "",
             .found = key,
             .expected = "a key of the configuration, or one of its tables",
             .remedy = meant ? fmt::format("Did you mean {}? vkfv keys lists all.", *meant) : "vkfv keys lists all."});
    }
    return text;
}

std::string configuration_template() {
    std::string text = "# A configuration of vkfv with every key. What is commented out stands at its default.\n"
                       "# vkfv explain KEY tells more of one.\n";
    for (const KeyTable* table : key_tables()) {
        if (table->path.empty()) {
            for (const Key* key : table->keys) {
                text += fmt::format("\n# {}\n# {} = []\n", key->meaning, key->name);
            }
            continue;
        }
        std::string kind; // the kind whose keys are not commented out
        for (const Key* key : table->keys) {
            if (key->name == table->kind) {
                const auto& toml = key->fallback.needed ? key->example : key->fallback.toml;
                kind = toml.size() < 2 ? key->choices.front().name : toml.substr(1, toml.size() - 2);
            }
        }
        const bool absent = table->presence != KeyTable::Presence::needed && !table->shown;
        const char* off = absent ? "# " : "";
        text += fmt::format("\n# {}\n{}{}\n", table->meaning, off, header_of(*table));
        std::set<std::string> written;
        for (const Key* key : table->keys) {
            const bool applies = key->kinds.empty() || std::ranges::find(key->kinds, kind) != key->kinds.end();
            const bool given = applies && !key->example.empty() && !absent && written.insert(key->name).second;
            const std::string value = !key->example.empty()         ? key->example
                                      : !key->fallback.toml.empty() ? key->fallback.toml
                                                                    : "...";
            std::string comment = key->meaning;
            if (key->fallback.needed || key->fallback.toml.empty() || !key->kinds.empty()) {
                const auto kinds = kinds_text(*table, *key);
                comment += (key->fallback.needed ? "" : fmt::format(" Default: {}.", default_text(*key))) +
                           (kinds.empty() ? "" : fmt::format(" Only with {}.", kinds));
            }
            if (const auto allowed = key->allowed(); !allowed.empty()) {
                comment += fmt::format(" {}.", value_text(*key));
            }
            text += fmt::format("# {}\n{}{} = {}\n", comment, given ? "" : "# ", key->name, value);
        }
    }
    return text;
}

std::string configuration_schema() {
    Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                   {"title", "Configuration of vkfv"},
                   {"type", "object"},
                   {"additionalProperties", false}};
    schema["properties"] = Json::object();
    Json required = Json::array();
    for (const KeyTable* table : key_tables()) {
        Json* object = &schema;
        // The path is followed from dot to dot, since a table may stand in another.
        for (std::string path = table->path; !path.empty();) {
            const auto dot = path.find('.');
            const std::string name = path.substr(0, dot);
            path = dot == std::string::npos ? "" : path.substr(dot + 1);
            // A table whose name is data stands for all tables there without a name of their own.
            Json& below = name == any_key ? (*object)["additionalProperties"] : (*object)["properties"][name];
            const bool repeated = path.empty() && table->presence == KeyTable::Presence::repeated;
            if (below.is_null() || below == false) {
                below = {{"type", repeated ? "array" : "object"}, {"description", table->meaning}};
                if (repeated) {
                    below["items"] = {{"type", "object"}};
                }
            }
            object = below.contains("items") ? &below["items"] : &below;
            if (!object->contains("additionalProperties")) {
                (*object)["additionalProperties"] = false;
            }
        }
        if (table->presence == KeyTable::Presence::needed && table->path.find('.') == std::string::npos) {
            required.push_back(table->path);
        }
        for (const Key* key : table->keys) {
            add_to_schema((*object)["properties"], *table, *key);
        }
    }
    for (const KeyTable* table : key_tables()) {
        if (table->several) {
            Json& one = schema["properties"][table->path];
            const Json properties = one["properties"];
            one["items"] = {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
            one["type"] = {"object", "array"};
        }
    }
    schema["required"] = required;
    return json_text(schema) + "\n";
}

} // namespace vkfv
