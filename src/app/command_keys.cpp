#include "app/commands.hpp"
#include "configuration/key_documents.hpp"
#include "core/messages/safe_text.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace vkfv::app {

namespace {

struct KeysOptions {
    bool schema = false;
};

struct ExplainOptions {
    std::string key;
};

void run_keys(const CommandOptions& options) {
    const auto own = options.of<KeysOptions>();
    print_text(options.json       ? keys_json()
               : options.markdown ? keys_markdown()
               : own.schema       ? configuration_schema()
                                  : keys_text());
}

void run_explain(const CommandOptions& options) {
    print_text(explained(options.of<ExplainOptions>().key));
}

void run_template(const CommandOptions&) {
    print_text(configuration_template());
}

} // namespace

Command keys_command() {
    return {.name = "keys",
            .summary = "List every key of a configuration with its default and what it means",
            .options = {json_option(),
                        markdown_option(),
                        {.name = "--schema",
                         .value = "",
                         .description = "A JSON Schema, for the completion of editors",
                         .target = into(&KeysOptions::schema)}},
            .run = run_keys,
            .example = "vkfv keys --schema > vkfv.schema.json",
            .about_vkfv = true};
}

Command explain_command() {
    return {.name = "explain",
            .summary = "Tell of one key of a configuration, or of one of its tables",
            .operands = {{.name = "KEY",
                          .description = "\"trace.rays\", \"rays\" or \"trace\"",
                          .target = into(&ExplainOptions::key),
                          .key = true}},
            .run = run_explain,
            .example = "vkfv explain trace.estimator",
            .about_vkfv = true};
}

Command template_command() {
    return {.name = "template",
            .summary = "Print a configuration with every key, its default and what it means",
            .run = run_template,
            .example = "vkfv template > my.toml",
            .about_vkfv = true};
}

} // namespace vkfv::app
