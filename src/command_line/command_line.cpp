#include "command_line/command_line.hpp"

#include "command_line/command.hpp"
#include "command_line/reference.hpp"
#include "core/messages/heartbeat.hpp"
#include "core/messages/log.hpp"
#include "core/messages/safe_text.hpp"
#include "core/messages/stages.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <functional>
#include <iterator>
#include <map>
#include <string_view>

namespace vkfv::command_line {

namespace {

// The commands, which declare_commands() sets once.
std::vector<Command>& declared() {
    static std::vector<Command> commands;
    return commands;
}

std::function<std::string()>& declared_version() {
    static std::function<std::string()> version;
    return version;
}

// The arguments, parsed by the declarations of all commands. A command is either named first (`vkfv stack C.toml`), or
// written as an option (`vkfv --stack C.toml`).
class CommandLine {
  public:
    explicit CommandLine(const Command* named) : named_(named), app_("", "vkfv") {
        app_.set_version_flag("-v,--version", declared_version());
        app_.allow_extras(); // refuse_leftovers() suggests a word for them
        operands_.resize(all_commands().size());
        for (std::size_t k = 0; k < all_commands().size(); ++k) {
            if (named_ == nullptr && all_commands()[k].also_option) {
                declare_as_option(all_commands()[k], operands_[k]);
            } else if (named_ == &all_commands()[k]) {
                declare_operands(*named_, operands_[k]);
            }
        }
        for (const auto& option : all_options()) {
            if (is_declared(option)) {
                declare(*option.option);
            }
        }
    }

    void parse(int count, char** words) { app_.parse(count, words); }

    void run() {
        refuse_leftovers();
        for (const auto& take : taken_) {
            take();
        }
        const Command& command = named_ != nullptr ? *named_ : chosen();
        for (const auto& option : all_options()) {
            if (is_declared(option)) {
                check_needed(option, command);
            }
        }
        for (const auto& option : all_options()) {
            if (is_declared(option)) {
                refuse_stray(option, command);
            }
        }
        place_operands(command);
        spdlog::set_level(options_.quiet ? spdlog::level::warn : spdlog::level::info);
        {
            const Heartbeat heartbeat;
            command.run(options_);
        }
        if (options_.timings) {
            fmt::print(options_.json ? stderr : stdout, "{}", stage_table()); // JSON stands alone on standard output
        }
    }

  private:
    // Tells whether the parser knows the option. Where commands are options, the options of commands that have no such
    // form are left out, since they could be mistaken for commands.
    bool is_declared(const OwnedOption& owned) const {
        return named_ != nullptr ||
               std::ranges::any_of(owned.owners, [](const Command* owner) { return owner->also_option; });
    }

    void declare_as_option(const Command& command, std::vector<std::string>& operands) {
        const std::string name = "--" + command.name;
        std::vector<std::string> names;
        for (const auto& operand : command.operands) {
            names.push_back(operand.name);
        }
        const bool several = !names.empty() && takes_several(command.operands.front());
        if (names.empty()) {
            app_.add_flag(name, flag_);
        } else if (names.size() == 1 && !several) {
            app_.add_option_function<std::string>(name, [&](const std::string& one) { operands = {one}; })
                ->type_name(names.front());
        } else {
            app_.add_option(name, operands)
                ->expected(several ? command.operands.front().least : 2,
                           several ? CLI::detail::expected_max_vector_size : static_cast<int>(names.size()));
        }
    }

    void declare_operands(const Command& command, std::vector<std::string>& operands) {
        for (const auto& operand : command.operands) {
            const std::string name = operand.name.substr(0, operand.name.find(' '));
            if (takes_several(operand)) {
                app_.add_option(name, operands)
                    ->expected(operand.least, CLI::detail::expected_max_vector_size)
                    ->required();
            } else {
                app_.add_option_function<std::string>(name, [&](const std::string& one) { operands.push_back(one); })
                    ->required(operand.needed);
            }
        }
    }

    static bool takes_several(const Operand& operand) {
        return std::holds_alternative<Take<std::vector<std::string>>>(operand.target);
    }

    void declare(const Option& option) {
        std::visit([&](const auto& target) { declare(option, target); }, option.target);
    }
    template <class Value>
    void declare(const Option& option, const Take<Value>& take) {
        if constexpr (std::is_same_v<Value, bool>) {
            if (option.value.empty()) {
                bool& given = switches_.emplace_back();
                app_.add_flag(option.name, given);
                taken_.push_back([this, take, &given] {
                    if (given) {
                        take(options_, true);
                    }
                });
                return;
            }
        }
        // Values are taken when all is parsed, so that an option that does not exist is reported first.
        auto* declared = app_.add_option_function<Value>(option.name, [this, take](const Value& value) {
            taken_.push_back([this, take, value] { take(options_, value); });
        });
        if constexpr (std::is_same_v<Value, bool>) {
            declared->transform(CLI::CheckedTransformer(
                std::map<std::string, bool>{{option.choices.front(), true}, {option.choices.back(), false}}));
            return;
        }
        if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
            if (option.list) {
                declared->delimiter(',');
                if (named_ != nullptr) {
                    declared->allow_extra_args(false); // further values would take the operand
                }
            } else {
                declared->expected(1)->take_all();
            }
        }
        if (option.range.second > 0) {
            declared->check(CLI::Range(option.range.first, option.range.second));
        } else if (!option.choices.empty() && option.choices_checked) {
            declared->check(CLI::IsMember(option.choices));
        } else {
            declared->type_name(option.value);
        }
    }

    // The command as it was written: "--stack" as an option, "stack" as the first word.
    std::string spelled(const std::string& command) const { return (named_ == nullptr ? "--" : "") + command; }
    std::size_t count(const Option& option) const { return app_.count(first_name(option)); }

    // Refuses what CLI11 left over. An unknown option most likely meant the nearest known one.
    void refuse_leftovers() const {
        const auto leftovers = app_.remaining();
        if (leftovers.empty()) {
            return;
        }
        std::vector<std::string> known;
        for (const auto* option : app_.get_options()) {
            if (option->nonpositional()) {
                known.push_back(option->get_name());
            }
        }
        const auto meant = nearest_word(leftovers.front(), known);
        refuse_argument(leftovers.front(), "a known option",
                        meant ? fmt::format("Did you mean {}? vkfv --help lists all.", *meant)
                              : "vkfv --help lists all.");
    }

    // The one command that was given as an option. Throws InputError if there is none, or more than one.
    const Command& chosen() const {
        const Command* chosen = nullptr;
        std::vector<std::string> measuring;
        for (const auto& command : all_commands()) {
            if (!command.about_vkfv) {
                measuring.push_back(command.name);
            }
            if (!command.also_option || app_.count("--" + command.name) == 0) {
                continue;
            }
            if (chosen != nullptr) {
                refuse_argument(fmt::format("--{} and --{}", chosen->name, command.name), "one command",
                                "Run one after the other.");
            }
            chosen = &command;
        }
        if (chosen == nullptr) {
            refuse_argument("no command", fmt::format("one of {}", fmt::join(measuring, ", ")),
                            "vkfv --help tells what they do.");
        }
        return *chosen;
    }

    void check_needed(const OwnedOption& owned, const Command& command) const {
        const auto& [option, owners] = owned;
        const bool given = count(*option) > 0;
        if (option->needed.empty() || given == takes(owned, command)) {
            return;
        }
        const std::string owner = spelled(owners.front()->name);
        refuse_argument(given ? option->name : fmt::format("{} without {}", owner, option->name),
                        fmt::format("{} with {}, and only with it", option->name, owner),
                        fmt::format("Give {} {}, {}, to {}.", option->name, option->value, option->needed, owner));
    }

    // Refuses an option that the command does not take, which would have no effect or another meaning than was meant.
    void refuse_stray(const OwnedOption& owned, const Command& command) const {
        if (count(*owned.option) == 0 || takes(owned, command)) {
            return;
        }
        std::vector<std::string> owners;
        for (const auto* owner : owned.owners) {
            owners.push_back(spelled(owner->name));
        }
        const std::string name = first_name(*owned.option);
        refuse_argument(fmt::format("{} with {}", name, spelled(command.name)),
                        fmt::format("{}", fmt::join(owners, " or ")), fmt::format("Leave {} out.", name));
    }

    static bool takes(const OwnedOption& owned, const Command& command) {
        return std::ranges::find(owned.owners, &command) != owned.owners.end();
    }

    void place_operands(const Command& command) {
        const auto& given = operands_[static_cast<std::size_t>(&command - all_commands().data())];
        for (std::size_t k = 0; k < std::min(given.size(), command.operands.size()); ++k) {
            const Operand& operand = command.operands[k];
            if (const auto* take_all = std::get_if<Take<std::vector<std::string>>>(&operand.target)) {
                (*take_all)(options_, given);
            } else {
                require_choice(given[k], operand);
                std::get<Take<std::string>>(operand.target)(options_, given[k]);
            }
        }
    }

    static void require_choice(const std::string& given, const Operand& operand) {
        if (operand.choices.empty() || std::ranges::find(operand.choices, given) != operand.choices.end()) {
            return;
        }
        const auto meant = nearest_word(given, operand.choices);
        refuse_argument(given, fmt::format("{}", fmt::join(operand.choices, ", ")),
                        meant ? fmt::format("Did you mean {}?", *meant) : "Name one of these.");
    }

    const Command* named_; // null: commands are options
    CLI::App app_;
    CommandOptions options_;
    std::deque<bool> switches_;
    bool flag_ = false;                              // for commands without operands; CLI11 counts which were given
    std::vector<std::vector<std::string>> operands_; // of each command, in their order
    std::vector<std::function<void()>> taken_;       // store the values that were given, in the order of declaration
};

} // namespace

const std::vector<Command>& all_commands() {
    return declared();
}

const Command& command_named(const std::string& name) {
    const auto found = std::ranges::find(all_commands(), name, &Command::name);
    if (found == all_commands().end()) {
        std::vector<std::string> names;
        std::ranges::transform(all_commands(), std::back_inserter(names), &Command::name);
        const auto meant = nearest_word(name, names);
        refuse_argument(name, "a command",
                        fmt::format("{}vkfv --help lists all.", meant ? fmt::format("Did you mean {}? ", *meant) : ""));
    }
    return *found;
}

void declare_commands(std::vector<Command> commands, std::function<std::string()> version) {
    for (auto& command : commands) {
        command.options.push_back({.name = "--quiet,-q",
                                   .value = "",
                                   .description = "Only warnings and errors, no progress; also -q",
                                   .target = into(&CommandOptions::quiet)});
        command.options.push_back({.name = "--log-json",
                                   .value = "",
                                   .description = "Messages and progress as JSON, an object a line",
                                   .target = into(&CommandOptions::log_json)});
        command.options.push_back({.name = "--color",
                                   .value = "WHEN",
                                   .description = "Colours of messages; auto: on a terminal, unless NO_COLOR is set",
                                   .target = into(&CommandOptions::color),
                                   .fallback = "auto",
                                   .choices = {"auto", "always", "never"}});
        command.options.push_back({.name = "--timings",
                                   .value = "",
                                   .description = "At the end, where the command's time went",
                                   .target = into(&CommandOptions::timings)});
    }
    declared() = std::move(commands);
    declared_version() = std::move(version);
}

namespace {

// Sets the log's colours by the word behind the last `--color`, before the command line is parsed, so that the parser's
// own messages have them. The parser refuses a word that is none of the choices.
void colour_log_as_asked(int argument_count, char** argument_values) {
    constexpr std::string_view name = "--color";
    for (int i = 1; i < argument_count; ++i) {
        const std::string_view word = argument_values[i];
        const std::string_view next = i + 1 < argument_count ? argument_values[i + 1] : "";
        const bool joined = word.starts_with(name) && word.substr(name.size()).starts_with('=');
        const std::string_view value = joined ? word.substr(name.size() + 1) : word == name ? next : "";
        if (value == "always") {
            colour_log(LogColours::always);
        } else if (value == "never") {
            colour_log(LogColours::never);
        } else if (value == "auto") {
            colour_log(LogColours::automatic);
        }
    }
}

} // namespace

bool run_command_line(int argument_count, char** argument_values) {
    if (argument_count < 2) {
        fmt::print(stderr, "{}", usage_text());
        return false;
    }
    colour_log_as_asked(argument_count, argument_values);
    // The log is JSON before the parse, so that a wrong command line is reported in JSON too.
    if (std::any_of(argument_values, argument_values + argument_count,
                    [](const char* word) { return std::string_view(word) == "--log-json"; })) {
        log_as_json();
    }
    const std::string first = argument_count > 1 ? argument_values[1] : "";
    const bool is_name = !first.empty() && !first.starts_with('-');
    const Command* named = is_name ? &command_named(first) : nullptr;
    CommandLine line(named);
    try {
        line.parse(argument_count - (is_name ? 1 : 0), argument_values + (is_name ? 1 : 0));
    } catch (const CLI::CallForHelp&) {
        print_text(help_text(named));
        return true;
    } catch (const CLI::CallForVersion& version) {
        print_text(version.what() + std::string("\n"));
        return true;
    }
    line.run();
    return true;
}

} // namespace vkfv::command_line
