#include "configuration/configuration.hpp"
#include "configuration/key_documents.hpp"
#include "core/files/file.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace vkfv {
namespace {

using testing::HasSubstr;

TEST(Keys, EachIsDeclaredOnceForAKindAndSaysWhatItIs) {
    std::set<std::string> seen;
    for (const KeyTable* table : key_tables()) {
        const auto kinds = table->kinds();
        EXPECT_EQ(table->kind.empty(), kinds.empty()) << table->path;
        for (const Key* key : table->keys) {
            SCOPED_TRACE(table->path + "." + key->name);
            EXPECT_TRUE(key->meaning.ends_with(".")) << key->meaning;
            EXPECT_FALSE(key->fallback.needed && !(key->fallback.toml.empty() && key->fallback.text.empty()));
            const std::vector<std::string> of_all = {""};
            for (const auto& kind : key->kinds.empty() ? of_all : key->kinds) {
                EXPECT_TRUE(seen.insert(table->path + "." + key->name + " " + kind).second);
                EXPECT_TRUE(kind.empty() || std::ranges::find(kinds, kind) != kinds.end()) << kind;
            }
        }
    }
    EXPECT_GT(seen.size(), 140u);
}

// The page that readers see is the one that the program would write.
TEST(Keys, ThePageInDocsIsNotStale) {
    EXPECT_EQ(read_file(VKFV_SOURCE_DIR "/docs/configuration.md"), keys_markdown())
        << "renew it: vkfv keys --markdown > docs/configuration.md";
}

TEST(Keys, ATemplateIsAConfigurationWithEveryKey) {
    const std::string text = configuration_template();
    const auto configuration = read_configuration(TomlTable::parse(text, "template.toml"));
    EXPECT_TRUE(configuration.specimen.has_value());
    EXPECT_TRUE(configuration.scan.has_value());
    for (const KeyTable* table : key_tables()) {
        for (const Key* key : table->keys) {
            EXPECT_THAT(text, HasSubstr(key->name + " = "));
            EXPECT_THAT(text, HasSubstr(key->meaning));
        }
    }
}

// The template's values that are commented out are the defaults: with them the configuration means the same.
TEST(Keys, DefaultsAreWhatTheReaderTakes) {
    const auto bare = read_configuration(TomlTable::parse(configuration_template(), "template.toml"));
    int tried = 0;
    for (const KeyTable* table : key_tables()) {
        const std::string path = table->path;
        if (!bare.places.contains(path)) {
            continue; // a table that is not there
        }
        for (const Key* key : table->keys) {
            const std::string dotted = path + "." + key->name;
            if (key->fallback.toml.empty() || !bare.places.contains(dotted)) {
                continue;
            }
            const auto same = read_configuration(
                TomlTable::parse(configuration_template(), "template.toml", {{dotted, key->fallback.toml, "test"}}));
            EXPECT_EQ(same.canonical, bare.canonical) << dotted;
            ++tried;
        }
    }
    EXPECT_GT(tried, 40);
}

TEST(Keys, JsonAndSchemaNameEveryKey) {
    const auto list = nlohmann::json::parse(keys_json());
    const auto schema = nlohmann::json::parse(configuration_schema());
    std::size_t keys = 0;
    for (const KeyTable* table : key_tables()) {
        keys += table->keys.size();
    }
    EXPECT_EQ(list.size(), keys);
    EXPECT_EQ(schema["properties"]["source"]["properties"]["flux_W"]["maximum"], 1e15);
    EXPECT_EQ(schema["properties"]["fold_mirror"]["type"], "array");
    EXPECT_THAT(schema["properties"]["trace"]["properties"]["estimator"]["enum"].dump(), HasSubstr("backward"));
    EXPECT_EQ(schema["properties"]["source"]["properties"]["spectrum"]["type"], "object");
    EXPECT_EQ(schema["properties"]["source"]["type"], nlohmann::json({"object", "array"})); // [source] or [[source]]
    EXPECT_EQ(schema["properties"]["source"]["items"]["properties"]["flux_W"]["maximum"], 1e15);
}

TEST(Keys, OneIsExplainedByItsNameOrItsLastWord) {
    EXPECT_THAT(explained("source.radius_mm"), HasSubstr("Radius of the disc"));
    EXPECT_THAT(explained("source.radius_mm"), HasSubstr("must be given"));
    EXPECT_THAT(explained("flux_W"), HasSubstr("source.flux_W"));
    EXPECT_THAT(explained("trace"), HasSubstr("trace.estimator"));
    try {
        explained("trace.ray");
        ADD_FAILURE();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("Did you mean trace.rays?"));
    }
}

} // namespace
} // namespace vkfv
