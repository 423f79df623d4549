// What tables of one TOML document share: its nodes, where they stand, and what was found wrong so far. Inside of the
// reader (toml_reader.hpp).
#pragma once

#include "core/toml/toml_reader.hpp"

#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv {

// "a.b" of "a" and "b"; "b" of "" and "b".
std::string dotted(const std::string& path, std::string_view key);

// A value as messages quote it: at most a line.
std::string text_of(const toml::node& node);

// The document, and which file it came from: an override's nodes carry another origin.
struct TomlDocument {
    // Of a file's text, with the overrides put in their places. Throws InputError for what is not TOML, or nests deeper
    // than deepest_toml_nesting.
    TomlDocument(std::string_view text, std::filesystem::path name, const std::vector<TomlOverride>& overrides);

    // What another file has in the table of this dotted key, where this document has nothing.
    void complete(const std::string& path, const std::filesystem::path& other_file);

    SourceLocation place(const toml::source_region& region) const;

    struct Noted {
        std::string path; // dotted, from the root: what the problem spoils
        InputProblem problem;
        // Of a missing key or table; else empty.
        std::string missing;  // its name
        std::string expected; // "a finite number > 0"
    };

    // Whether nothing was noted at this dotted key or below.
    bool sound(std::string_view at) const;
    bool abandoned(std::string_view at) const;

    // In the order of their places: those of the file, of the command line, of other files.
    std::vector<InputProblem> problems() const;

    toml::table root;
    std::filesystem::path file;
    std::set<std::filesystem::path> completed_from;
    bool collecting = false;
    std::vector<Noted> noted;
    std::vector<std::string> abandoned_paths; // reading ended early: their other keys are neither known nor unknown
};

// The part of a TomlTable that its copies share.
struct TomlTable::State {
    std::shared_ptr<TomlDocument> document;
    const toml::table* table = nullptr;
    std::string path;
    SourceLocation where;
    std::set<std::string, std::less<>> asked;
    std::map<std::string, std::shared_ptr<State>, std::less<>> children;

    const toml::node* find(std::string_view key);
    std::shared_ptr<State> child(const std::string& name, const toml::table& node);

    InputProblem problem(std::string_view key, const toml::node* node, std::string expected, std::string remedy) const;
    // Throws the problem; while problems are collected, the next three note it and return.
    [[noreturn]] void refuse(std::string_view key, const toml::node* node, std::string expected,
                             std::string remedy) const;
    void note(std::string_view key, const toml::node* node, std::string expected, std::string remedy) const;
    // Nothing for a key that is there: what is wrong with it was noted already.
    void note_missing(std::string_view key, const std::string& expected) const;
    void note_missing_tables(std::string_view key, const std::string& expected, const std::string& header) const;

    // Of the tables that were read to their ends.
    void note_unknown();

  private:
    void add(TomlDocument::Noted noted) const;
    void pair_missing_with_unknown(std::set<std::string>& paired);
};

} // namespace vkfv
