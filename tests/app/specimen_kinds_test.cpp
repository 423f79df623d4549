// Every kind of specimen is read by its keys, and by no others.
#include "configuration/tables.hpp"
#include "core/files/file.hpp"
#include "specimen/kinds.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace vkfv {
namespace {

using testing::HasSubstr;

// A value of the key as TOML; empty for a file in place of which there are other keys.
std::string value_of(const Key& key) {
    if (!key.example.empty()) {
        return key.example;
    }
    if (!key.fallback.toml.empty()) {
        return key.fallback.toml;
    }
    switch (key.type) {
    case Key::Type::number:
        return "0.1";
    case Key::Type::text:
        return "\"F\"";
    case Key::Type::choice:
        return toml_quoted(key.choices.front().name);
    default:
        EXPECT_EQ(key.type, Key::Type::file) << key.name;
        return "";
    }
}

// [specimen] with all keys of the kind.
std::string table_of(const specimen::Kind& kind) {
    std::string text = fmt::format("[specimen]\nkind = \"{}\"\n", kind.name);
    for (const Key* key : kind.keys) {
        const std::string value = value_of(*key);
        text += value.empty() ? "" : fmt::format("{} = {}\n", key->name, value);
    }
    return text;
}

Configuration read(const std::string& text) {
    const auto root = TomlTable::parse(text, "test.toml");
    Configuration configuration;
    configuration.file = root.where().file;
    read_specimen(root, configuration);
    root.reject_unknown_keys();
    return configuration;
}

std::string message_of(const std::string& text) {
    try {
        (void)read(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(SpecimenKinds, AreReadByAllTheirKeysAndWrittenOut) {
    for (const auto& kind : specimen::kinds()) {
        const std::string text = table_of(kind);
        ASSERT_EQ(message_of(text), "no error") << text;
        const Configuration configuration = read(text);
        EXPECT_EQ(specimen::kinds()[configuration.specimen->shape.index()].name, kind.name);
        for (const Key* key : kind.keys) {
            if (!value_of(*key).empty()) {
                EXPECT_THAT(configuration.canonical, HasSubstr("\n" + key->name + " = ")) << kind.name;
            }
        }
        const Configuration again = read(configuration.canonical);
        EXPECT_EQ(again.canonical, configuration.canonical);
        EXPECT_EQ(again.identity, configuration.identity);
        EXPECT_TRUE(specimen::Description(*again.specimen).shape == configuration.specimen->shape) << kind.name;
    }
}

TEST(SpecimenKinds, RefuseTheKeysOfOthers) {
    for (const auto& kind : specimen::kinds()) {
        std::set<std::string> own;
        std::ranges::transform(kind.keys, std::inserter(own, own.end()), &Key::name);
        for (const Key* key : (*specimen_key_tables().front()).keys) {
            if (key->kinds.empty() || own.contains(key->name)) {
                continue;
            }
            const std::string value = value_of(*key).empty() ? "\"a\"" : value_of(*key);
            EXPECT_THAT(message_of(table_of(kind) + key->name + " = " + value + "\n"),
                        testing::AllOf(HasSubstr("specimen." + key->name),
                                       HasSubstr(fmt::format("no such key for a specimen of kind \"{}\"", kind.name))));
        }
    }
}

TEST(SpecimenKinds, TakeRoughnessUnlessTheyAreMeshes) {
    const std::string roughness = "[specimen.roughness]\nnoise_um = 0.1\nkernel_um = 1\npitch_um = 0.5\n";
    for (const auto& kind : specimen::kinds()) {
        EXPECT_THAT(message_of(table_of(kind) + roughness),
                    HasSubstr(kind.takes_roughness ? "no error" : "no roughness for a specimen of kind"))
            << kind.name;
    }
}

TEST(SpecimenKinds, SayWhatTheirKeysAreFor) {
    for (const Key* key : (*specimen_key_tables().front()).keys) {
        EXPECT_FALSE(key->meaning.empty()) << key->name;
        EXPECT_TRUE(key->name == "kind" || key->name == "standard" || !key->kinds.empty()) << key->name;
    }
    EXPECT_EQ((*specimen_key_tables().front()).kinds().size(), specimen::kinds().size());
}

// Every file in assets/specimens is read as if its keys stood in the configuration, and some of them may stand there
// too.
TEST(Standards, AreReadAsTheirKeysAreAndLeaveNoNameBehind) {
    int found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(VKFV_SOURCE_DIR "/assets/specimens")) {
        if (entry.path().extension() != ".toml") {
            continue;
        }
        ++found;
        const std::string file = read_file(entry.path()), name = entry.path().stem().string();
        EXPECT_THAT(file, testing::StartsWith("title = \"Type ")) << name;
        const auto keys = read(file.substr(file.find("[specimen]")));
        const auto named = read(fmt::format("[specimen]\nstandard = \"{}\"\n", name));
        EXPECT_EQ(named.canonical, keys.canonical);
        EXPECT_EQ(named.identity, keys.identity);
        EXPECT_THAT(named.canonical, testing::Not(HasSubstr("standard")));
        EXPECT_TRUE(named.specimen->shape == keys.specimen->shape) << name;
        EXPECT_THAT(read(fmt::format("[specimen]\nstandard = \"{}\"\npitch_um = 0.25\n", name)).canonical,
                    HasSubstr("pitch_um = 0.25\n"))
            << name;
    }
    EXPECT_GE(found, 13);
}

} // namespace
} // namespace vkfv
