// What a command is: what it is called, what may be given to it and what it does. The parser, help, the manual page and
// completion all read these declarations.
#pragma once

#include "configuration/configuration.hpp"
#include "core/mathematics/units.hpp"

#include <any>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <typeindex>
#include <utility>
#include <variant>
#include <vector>

namespace vkfv::command_line {

// What the command line says, as far as it does not override the configuration: what several commands take, and what a
// command keeps for itself in a struct of its own file.
struct CommandOptions {
    std::filesystem::path file; // configuration; for `topography` the stack, for `surface` the surface
    std::vector<TomlOverride> overrides;
    std::optional<std::filesystem::path> out;
    bool quiet = false;
    bool timings = false;
    bool log_json = false; // acted upon before anything else is read: run_command_line()
    std::string color;     // likewise
    bool json = false;
    bool markdown = false;

    // The command's own struct, as its options have filled it.
    template <class Own>
    Own& of() {
        if constexpr (std::is_same_v<Own, CommandOptions>) {
            return *this;
        } else {
            return std::any_cast<Own&>(own_.try_emplace(typeid(Own), Own{}).first->second);
        }
    }
    // Its defaults, if none was given.
    template <class Own>
    Own of() const {
        const auto found = own_.find(typeid(Own));
        return found == own_.end() ? Own{} : std::any_cast<const Own&>(found->second);
    }

  private:
    std::map<std::type_index, std::any> own_;
};

// Distance of the pixels of an image on the specimen, in mm; for images whose file does not say it.
struct PixelPitch {
    std::optional<double> value;
};

// Whether surface files whose checksums are stale are read.
struct AcceptChecksum {
    bool value = false;
};

// Puts the value of an option where it belongs.
template <class Value>
using Take = std::function<void(CommandOptions&, const Value&)>;

// What the parser gives for a member of this type.
template <class Member>
struct Given {
    using Value = Member;
};
template <class Member>
struct Given<std::optional<Member>> : Given<Member> {};
template <>
struct Given<std::filesystem::path> {
    using Value = std::string;
};
template <>
struct Given<std::vector<std::filesystem::path>> {
    using Value = std::vector<std::string>;
};

// Into a member of CommandOptions or of a command's own struct.
template <class Own, class Member>
auto into(Member Own::*member) {
    using Value = typename Given<Member>::Value;
    return Take<Value>([member](CommandOptions& options, const Value& value) {
        if constexpr (std::is_same_v<Member, std::vector<std::filesystem::path>>) {
            (options.of<Own>().*member).assign(value.begin(), value.end());
        } else {
            options.of<Own>().*member = value;
        }
    });
}

// A length that is given in um, into one in mm.
template <class Own, class Member>
Take<double> in_mm(Member Own::*length) {
    return [length](CommandOptions& options, double um) { options.of<Own>().*length = um / um_per_mm; };
}

struct Option {
    std::string name;        // "--out"; "--z_step_um,--z-step-um": two spellings
    std::string value;       // what stands for the value in help; empty: a switch
    std::string description; // a sentence without its stop
    std::variant<Take<bool>, Take<int>, Take<std::uint64_t>, Take<double>, Take<std::string>,
                 Take<std::vector<std::string>>>
        target;
    std::string fallback{};             // what holds if it is not given
    std::vector<std::string> choices{}; // Take<bool> that is no switch: of true, of false
    bool choices_checked = true;        // else the configuration refuses others, with its own words
    std::pair<int, int> range{};        // of an integer, ends included
    bool list = false;                  // values are parted by commas; else several stand each behind the option
    bool file = false;                  // for completion
    bool setting = false;               // likewise: a key of the configuration, "=" and its value
    std::string needed{};               // not empty: the command cannot do without, and this says what it is
    std::string foremost{};             // the command that is named first of those that take it
};

struct Operand {
    std::string name; // "C.toml"; "MEASURED... TRUTH": several
    std::string description;
    std::variant<Take<std::string>, Take<std::vector<std::string>>> target;
    std::vector<std::string> choices{}; // empty: it is a file
    bool needed = true;
    int least = 2;    // of several
    bool key = false; // of the configuration, or a table: for completion
};

struct Command {
    std::string name;
    std::string summary; // sentences without the last stop
    std::vector<Operand> operands{};
    std::vector<Option> options{};
    void (*run)(const CommandOptions&) = nullptr;
    std::string example{};
    bool about_vkfv = false; // tells of vkfv itself instead of measuring
    bool also_option = true; // `vkfv --stack C.toml` is `vkfv stack C.toml`
};

// Once, before all else here: the commands of the program, in the order in which help lists them.
void declare_commands(std::vector<Command> commands, std::function<std::string()> version);
const std::vector<Command>& all_commands();
// Throws InputError, with the nearest name, if there is none of this name.
const Command& command_named(const std::string& name);
// Throws InputError of the command line.
[[noreturn]] void refuse_argument(std::string found, std::string expected, std::string remedy);

// Options that several commands take.
std::vector<Option> configuration_options(); // instead of the configuration's values
Option out_option(std::string description);
Option json_option();
Option markdown_option();
Option pitch_option();              // a PixelPitch
Option accept_checksum_option();    // an AcceptChecksum
std::vector<Option> band_options(); // form and filters: a surface::Band
// One list after the other.
std::vector<Option> together(std::vector<std::vector<Option>> lists);

} // namespace vkfv::command_line
