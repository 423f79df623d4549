// The declaration of a command: its name, its operands and options, and the function that runs it. The parser, help,
// the manual page and completion all read these declarations.
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

// The options and operands of a command line, except those that override the configuration. Options of several commands
// are members; each command keeps its other options in a struct of its own file.
struct CommandOptions {
    std::filesystem::path file; // the configuration; the stack of `topography`, the surface of `surface`
    std::vector<TomlOverride> overrides;
    std::optional<std::filesystem::path> out;
    bool quiet = false;
    bool timings = false;
    bool log_json = false; // acted upon before the parse: run_command_line()
    std::string color;     // acted upon before the parse: run_command_line()
    bool json = false;
    bool small = false; // a first look: a part of the field and of the scan, fewer measurements
    bool markdown = false;

    // The struct of the command itself, as its options have filled it.
    template <class Own>
    Own& of() {
        if constexpr (std::is_same_v<Own, CommandOptions>) {
            return *this;
        } else {
            return std::any_cast<Own&>(own_.try_emplace(typeid(Own), Own{}).first->second);
        }
    }
    // The struct of the command itself; with its defaults, if no option filled it.
    template <class Own>
    Own of() const {
        const auto found = own_.find(typeid(Own));
        return found == own_.end() ? Own{} : std::any_cast<const Own&>(found->second);
    }

  private:
    std::map<std::type_index, std::any> own_;
};

// The distance (mm) of an image's pixels on the specimen, for images whose file does not state it.
struct PixelPitch {
    std::optional<double> value;
};

// Tells whether to read surface files whose checksums are stale.
struct AcceptChecksum {
    bool value = false;
};

// A function that stores the value of an option.
template <class Value>
using Take = std::function<void(CommandOptions&, const Value&)>;

// The type that the parser delivers for a member of this type.
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

// Stores the value in a member of CommandOptions or of a command's own struct.
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

// Stores a length that is given in um in a member in mm.
template <class Own, class Member>
Take<double> in_mm(Member Own::*length) {
    return [length](CommandOptions& options, double um) { options.of<Own>().*length = um / um_per_mm; };
}

struct Option {
    std::string name;        // "--out"; "--z_step_um,--z-step-um": two spellings
    std::string value;       // stands for the value in help; empty: a switch
    std::string description; // sentence without its full stop
    std::variant<Take<bool>, Take<int>, Take<std::uint64_t>, Take<double>, Take<std::string>,
                 Take<std::vector<std::string>>>
        target;
    std::string fallback{};             // value if the option is not given
    std::vector<std::string> choices{}; // words allowed; for Take<bool>, those of true and false
    bool choices_checked = true;        // by the parser; otherwise the configuration refuses others
    std::pair<int, int> range{};        // of an integer, with both ends
    bool list = false;                  // commas part the values; otherwise each follows an option
    bool file = false;                  // the value is a file, for completion
    bool setting = false;               // the value is a key of the configuration, "=" and its value, for completion
    std::string needed{};               // not empty: the option is required; says what it gives
    std::string foremost{};             // the command named first of those that take the option
};

struct Operand {
    std::string name; // "C.toml"; "MEASURED... TRUTH": several
    std::string description;
    std::variant<Take<std::string>, Take<std::vector<std::string>>> target;
    std::vector<std::string> choices{}; // words allowed; empty: a file
    bool needed = true;
    int least = 2;    // the least number of several
    bool key = false; // a key or table of the configuration, for completion
};

struct Command {
    std::string name;
    std::string summary; // sentences without the last full stop
    std::vector<Operand> operands{};
    std::vector<Option> options{};
    void (*run)(const CommandOptions&) = nullptr;
    std::string example{};
    bool about_vkfv = false; // informs about vkfv instead of measuring
    bool also_option = true; // `vkfv --stack C.toml` is `vkfv stack C.toml`
};

// Declares the commands of the program, in the order in which help lists them. It must be called once, before all other
// functions here.
void declare_commands(std::vector<Command> commands, std::function<std::string()> version);
const std::vector<Command>& all_commands();
// The command of this name. Throws InputError, with the nearest name, if there is none.
const Command& command_named(const std::string& name);
// Throws an InputError of the command line.
[[noreturn]] void refuse_argument(std::string found, std::string expected, std::string remedy);

// Options that several commands take.
std::vector<Option> configuration_options(); // override values of the configuration
Option out_option(std::string description);
Option json_option();
Option small_option(std::string description);
Option markdown_option();
Option pitch_option();              // a PixelPitch
Option accept_checksum_option();    // an AcceptChecksum
std::vector<Option> band_options(); // form and filters: a surface::Band
// Joins the lists in their order.
std::vector<Option> together(std::vector<std::vector<Option>> lists);

} // namespace vkfv::command_line
