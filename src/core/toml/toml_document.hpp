// The parts that the tables of one TOML document share: its nodes, their places, and the problems found so far. It is
// internal to the reader (toml_reader.hpp).
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

// The dotted path: "a.b" from "a" and "b"; "b" from "" and "b".
std::string dotted(const std::string& path, std::string_view key);

// A value as messages quote it: at most a line.
std::string text_of(const toml::node& node);

// A document and the file it came from; nodes of an override carry another origin.
struct TomlDocument {
    // Parses a file's text and inserts the overrides. Throws InputError for invalid TOML, and for one nested deeper
    // than deepest_toml_nesting.
    TomlDocument(std::string_view text, std::filesystem::path name, const std::vector<TomlOverride>& overrides);

    // Adds values that another file has in the table of this dotted key and this document lacks.
    void complete(const std::string& path, const std::filesystem::path& other_file);

    SourceLocation place(const toml::source_region& region) const;

    struct Noted {
        std::string path; // dotted path from the root to the invalid part
        InputProblem problem;
        // Name and expectation of a missing key or table; else empty.
        std::string missing;  // its name
        std::string expected; // "a finite number > 0"
    };

    // True if no problem was noted at this dotted key or below.
    bool sound(std::string_view at) const;
    bool abandoned(std::string_view at) const;

    // The problems of this file by their places, then all others in the order in which they were noted.
    std::vector<InputProblem> problems() const;

    toml::table root;
    std::filesystem::path file;
    std::set<std::filesystem::path> completed_from;
    bool collecting = false;
    std::vector<Noted> noted;
    std::vector<std::string> abandoned_paths; // reading ended early there, so whether other keys are known is undecided
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
    // Throws the problem. The next three functions note it instead while problems are collected.
    [[noreturn]] void refuse(std::string_view key, const toml::node* node, std::string expected,
                             std::string remedy) const;
    void note(std::string_view key, const toml::node* node, std::string expected, std::string remedy) const;
    // Does nothing if the key exists, as its problem was noted already.
    void note_missing(std::string_view key, const std::string& expected) const;
    void note_missing_tables(std::string_view key, const std::string& expected, const std::string& header) const;

    // Notes the unknown keys of tables that were read completely.
    void note_unknown();

  private:
    void add(TomlDocument::Noted noted) const;
    void pair_missing_with_unknown(std::set<std::string>& paired);
};

} // namespace vkfv
