// What a command is: what it is called, what may be given to it and what it does. The parser, help, the manual page and
// completion all read these declarations.
#pragma once

#include "configuration/configuration.hpp"
#include "surface/band.hpp"
#include "surface/roughness_profile.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace vkfv::command_line {

// What the command line says, as far as it does not override the configuration. Lengths in mm.
struct CommandOptions {
    std::filesystem::path file; // configuration; for `topography` the stack, for `surface` the surface
    std::vector<TomlOverride> overrides;
    std::optional<std::filesystem::path> out;
    bool quiet = false;
    bool json = false;
    std::string topic; // of the commands that tell of vkfv itself
    bool markdown = false;
    bool schema = false;
    double focal_height = 0;                           // image
    std::filesystem::path rays_file;                   // trace-rays
    std::filesystem::path picture_file;                // layout
    std::vector<std::filesystem::path> compared_files; // compare: measurements, then the truth
    bool align = false;                                // compare: the lateral shift is removed
    surface::Band band;                                // compare, surface: form and filters
    std::optional<surface::ProfileLine> profile_line;  // surface; none: the middle row
    bool float_precision = false;                      // trace-rays: on the device
    bool apertures = true;                             // trace-rays
    int runs = 5;                                      // bench
    std::vector<std::string> bench_parts = {"stages"}; // bench: what to measure (bench.hpp)
    bool quick = false;                                // bench
    std::filesystem::path peer;                        // bench: the program vkfv_bench_peer
    std::string commit;                                // bench: for the report
    std::vector<std::filesystem::path> glass_catalogs; // import
    std::optional<std::uint64_t> shuffle;              // topography: seed of the order in which images are taken
    // topography of a stack that vkfv did not make
    std::optional<double> z_step;  // negative: the images descend
    std::optional<double> pitch;   // surface too, of an image
    std::optional<double> unit;    // surface: mm per unit of an image's value
    std::optional<double> z_start; // of the first image; none: 0
};

// Puts the value of an option where it belongs.
template <class Value>
using Take = std::function<void(CommandOptions&, const Value&)>;

struct Option {
    std::string name;        // "--out"; "--z_step_um,--z-step-um": two spellings
    std::string value;       // what stands for the value in help; empty: a switch
    std::string description; // a sentence without its stop
    std::variant<bool CommandOptions::*, int CommandOptions::*, std::optional<std::uint64_t> CommandOptions::*,
                 Take<bool>, Take<double>, Take<std::string>, Take<std::vector<std::string>>>
        target;
    std::string fallback{};             // what holds if it is not given
    std::vector<std::string> choices{}; // Take<bool>: of true, of false
    bool choices_checked = true;        // else the configuration refuses others, with its own words
    std::pair<int, int> range{};        // of an integer, ends included
    bool list = false;                  // values are parted by commas; else several stand each behind the option
    bool file = false;                  // for completion
    std::string needed{};               // not empty: the command cannot do without, and this says what it is
    std::string foremost{};             // the command that is named first of those that take it
};

struct Operand {
    std::string name; // "C.toml"; "MEASURED... TRUTH": two or more
    std::string description;
    std::variant<std::filesystem::path CommandOptions::*, std::string CommandOptions::*,
                 std::vector<std::filesystem::path> CommandOptions::*>
        target;
    std::vector<std::string> choices{}; // empty: it is a file
    bool needed = true;
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
void declare_commands(std::vector<Command> commands);
const std::vector<Command>& all_commands();
// Throws InputError, with the nearest name, if there is none of this name.
const Command& command_named(const std::string& name);
// Throws InputError of the command line.
[[noreturn]] void refuse_argument(std::string found, std::string expected, std::string remedy);

// Options that several commands take.
std::vector<Option> configuration_options(); // instead of the configuration's values
Option out_option(std::string description);
Option json_option();
Option pitch_option();
std::vector<Option> band_options(); // form and filters
// A length in um.
Take<double> in_mm(std::optional<double> CommandOptions::*length);
// One list after the other.
std::vector<Option> together(std::vector<std::vector<Option>> lists);

} // namespace vkfv::command_line
