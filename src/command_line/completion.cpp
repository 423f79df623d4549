#include "command_line/completion.hpp"

#include "command_line/command.hpp"
#include "command_line/reference.hpp"
#include "configuration/key_documents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>

namespace vkfv::command_line {

namespace {

std::vector<std::string> command_names() {
    std::vector<std::string> names;
    std::ranges::transform(all_commands(), std::back_inserter(names), &Command::name);
    return names;
}

std::vector<std::string> option_names(const Command& command) {
    std::vector<std::string> names;
    std::ranges::transform(command.options, std::back_inserter(names), first_name);
    names.emplace_back("--help");
    return names;
}

bool takes_files(const Command& command) {
    return std::ranges::any_of(command.operands, [](const auto& operand) {
        return operand.choices.empty() && operand.needed && !operand.key;
    });
}

// Each key of the configuration, dotted, with the words that it takes where these are known: "true" and "false", or its
// choices for any kind of its table.
const std::map<std::string, std::vector<std::string>>& configuration_keys() {
    static const std::map<std::string, std::vector<std::string>> keys = [] {
        std::map<std::string, std::vector<std::string>> all;
        for (const KeyTable* table : key_tables()) {
            for (const Key* key : table->keys) {
                auto& words = all[table->path.empty() ? key->name : table->path + "." + key->name];
                auto known = key->type == Key::Type::choice ? key->choice_names() : std::vector<std::string>();
                if (key->type == Key::Type::boolean) {
                    known = {"true", "false"};
                }
                std::ranges::copy_if(known, std::back_inserter(words), [&words](const std::string& word) {
                    return std::ranges::find(words, word) == words.end();
                });
            }
        }
        return all;
    }();
    return keys;
}

// The keys and tables that `explain` completes.
std::vector<std::string> key_names() {
    std::vector<std::string> names;
    for (const KeyTable* table : key_tables()) {
        if (!table->path.empty()) {
            names.push_back(table->path);
        }
    }
    for (const auto& [key, words] : configuration_keys()) {
        names.push_back(key);
    }
    return names;
}

std::vector<std::string> settings() {
    std::vector<std::string> all;
    for (const auto& [key, words] : configuration_keys()) {
        all.push_back(key + "=");
    }
    return all;
}

// The names of the options whose value is a key with its value.
std::vector<std::string> setting_options() {
    std::vector<std::string> names;
    for (const auto& [option, owners] : all_options()) {
        if (option->setting) {
            names.push_back(first_name(*option));
        }
    }
    return names;
}

// The words that a command's operand may be; none if it is a file.
std::vector<std::string> operand_words(const Command& command) {
    if (!command.operands.empty() && command.operands.front().key) {
        return key_names();
    }
    if (command.operands.empty() || takes_files(command)) {
        return {};
    }
    return command.operands.front().choices.empty() ? command_names() : command.operands.front().choices;
}

std::string quoted(const std::string& text) {
    std::string inside;
    for (const char character : text) {
        inside += character == '\'' ? std::string("'\\''") : std::string(1, character);
    }
    return "'" + inside + "'";
}

// The first word is taken as the command, or as the option that stands for it, `--stack`.
std::string bash_script() {
    std::string options, operands, values, choices;
    std::vector<std::string> flags, free, files;
    for (const auto& [key, words] : configuration_keys()) {
        if (!words.empty()) {
            choices += fmt::format("    {}) words='{}' ;;\n", key, fmt::join(words, " "));
        }
    }
    for (const auto& command : all_commands()) {
        options += fmt::format("    {}) options='{}' ;;\n", command.name, fmt::join(option_names(command), " "));
        if (const auto words = operand_words(command); !words.empty()) {
            operands += fmt::format("    {}) words='{}' ;;\n", command.name, fmt::join(words, " "));
        } else if (takes_files(command)) {
            operands += fmt::format("    {}) files=1 ;;\n", command.name);
        }
        if (command.also_option) {
            flags.push_back("--" + command.name);
        }
    }
    for (const auto& [option, owners] : all_options()) {
        if (!option->choices.empty()) {
            values +=
                fmt::format("    {}) words='{}' files= ;;\n", first_name(*option), fmt::join(option->choices, " "));
        } else if (!option->value.empty() && !option->setting) {
            (option->file ? files : free).push_back(first_name(*option));
        }
    }
    return fmt::format(R"(# bash completion for vkfv: source it, or put it where bash-completion looks
_vkfv() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
    local command=${{COMP_WORDS[1]#--}} options= words= files= IFS=$' \t\n'
    COMPREPLY=()
    # A key and its value are one word to vkfv, and three to bash where "=" parts words.
    local key= at=$COMP_CWORD
    if [[ $word == = ]]; then
        word= key=$before at=$((at - 1))
    elif [[ $before == = ]] && ((at > 2)); then
        key=${{COMP_WORDS[at - 2]}} at=$((at - 2))
    elif [[ $word == *=* ]]; then
        key=${{word%%=*}}
    fi
    if ((at > 2)) && [[ ${{COMP_WORDS[at - 1]}} == @({setting}) ]]; then
        if [[ -n $key ]]; then
            case $key in
{choices}            esac
            local joined=
            [[ $word == *=* ]] && joined=$key=
            COMPREPLY=($(compgen -P "$joined" -W "$words" -- "${{word#"$joined"}}"))
        else
            compopt -o nospace 2> /dev/null
            COMPREPLY=($(compgen -W '{settings}' -- "$word"))
        fi
        return
    fi
    if ((COMP_CWORD == 1)); then
        words='{commands}' options='{flags} --help --version'
        COMPREPLY=($(compgen -W "$words $options" -- "$word"))
        return
    fi
    case $command in
{options}    esac
    case $command in
{operands}    esac
    ((COMP_CWORD > 2)) && case $before in
{values}    {files}) words= files=1 ;;
    {free}) return ;;
    esac
    [[ $word == -* ]] && words=$options files=
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    [[ -z $files ]] && return
    IFS=$'\n'
    COMPREPLY=($(compgen -f -- "$word"))
}}
complete -o filenames -F _vkfv vkfv
)",
                       fmt::arg("commands", fmt::join(command_names(), " ")), fmt::arg("flags", fmt::join(flags, " ")),
                       fmt::arg("options", options), fmt::arg("operands", operands), fmt::arg("values", values),
                       fmt::arg("files", fmt::join(files, " | ")), fmt::arg("free", fmt::join(free, " | ")),
                       fmt::arg("choices", choices), fmt::arg("settings", fmt::join(settings(), " ")),
                       fmt::arg("setting", fmt::join(setting_options(), "|")));
}

// A text as a field of zsh's _arguments, whose fields end at brackets and colons.
std::string zsh_field(const std::string& text) {
    std::string escaped;
    for (const char character : text) {
        escaped +=
            std::string(std::string_view("[]:\\").find(character) != std::string_view::npos ? "\\" : "") + character;
    }
    return escaped;
}

std::string zsh_script() {
    std::string described, cases, choices;
    for (const auto& [key, words] : configuration_keys()) {
        if (!words.empty()) {
            choices += fmt::format("        {}) compadd -- {} ;;\n", key, fmt::join(words, " "));
        }
    }
    for (const auto& command : all_commands()) {
        described += fmt::format("        {}\n", quoted(command.name + ":" + command.summary));
        cases += fmt::format("    {}) _arguments '--help[what it takes]'", command.name);
        for (const auto& option : command.options) {
            const std::string action = option.setting            ? "_vkfv_setting"
                                       : !option.choices.empty() ? fmt::format("({})", fmt::join(option.choices, " "))
                                                                 : (option.file ? "_files" : " ");
            const std::string value = option.value.empty() ? "" : ":" + zsh_field(option.value) + ":" + action;
            cases += " " + quoted(first_name(option) + "[" + zsh_field(option.description) + "]" + value);
        }
        if (const auto words = operand_words(command); !words.empty()) {
            cases += fmt::format(" '*:{}:({})'", command.operands.front().name, fmt::join(words, " "));
        } else if (takes_files(command)) {
            cases += " '*:file:_files'";
        }
        cases += " ;;\n";
    }
    return fmt::format(R"(#compdef vkfv
_vkfv_setting() {{
    if [[ $PREFIX == *=* ]]; then
        local key=${{PREFIX%%=*}}
        compset -P '*='
        case $key in
{}        esac
    else
        compadd -S '' -- {}
    fi
}}
_vkfv() {{
    local -a commands=(
{})
    if ((CURRENT == 2)); then
        _describe command commands
        return
    fi
    shift words
    ((CURRENT--))
    case ${{words[1]#--}} in
{}    esac
}}
compdef _vkfv vkfv
)",
                       choices, fmt::join(settings(), " "), described, cases);
}

std::string fish_script() {
    std::vector<std::string> whole; // settings, with their values if known
    for (const auto& [key, words] : configuration_keys()) {
        if (words.empty()) {
            whole.push_back(key + "=");
        }
        std::ranges::transform(words, std::back_inserter(whole),
                               [&key = key](const std::string& word) { return key + "=" + word; });
    }
    std::string script = fmt::format("set -g __vkfv_settings {}\ncomplete -c vkfv -f\n", fmt::join(whole, " "));
    for (const auto& command : all_commands()) {
        script += fmt::format("complete -c vkfv -n __fish_use_subcommand -a {} -d {}\n", command.name,
                              quoted(command.summary));
        const std::string inside = fmt::format("complete -c vkfv -n '__fish_seen_subcommand_from {}'", command.name);
        for (const auto& option : command.options) {
            const std::string value = option.setting ? " -x -a '$__vkfv_settings'"
                                      : !option.choices.empty()
                                          ? fmt::format(" -x -a '{}'", fmt::join(option.choices, " "))
                                      : option.value.empty() ? ""
                                                             : (option.file ? " -r -F" : " -x");
            script += fmt::format("{} -l {}{} -d {}\n", inside, first_name(option).substr(2), value,
                                  quoted(option.description));
        }
        if (const auto words = operand_words(command); !words.empty()) {
            script += fmt::format("{} -a '{}'\n", inside, fmt::join(words, " "));
        } else if (takes_files(command)) {
            script += inside + " -F\n";
        }
    }
    return script;
}

} // namespace

std::string completion_script(const std::string& shell) {
    return shell == "bash" ? bash_script() : shell == "zsh" ? zsh_script() : fish_script();
}

} // namespace vkfv::command_line
