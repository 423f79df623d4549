#include "command_line/reference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

namespace vkfv::command_line {

namespace {

struct Entry {
    std::string term, text;
};

struct Section {
    std::string title;
    int level = 1; // 2: of a command in the reference
    std::vector<std::string> paragraphs{};
    std::vector<Entry> entries{};
    std::vector<std::string> lines{}; // lines of input, printed as they are
};

std::string usage(const Command& command) {
    std::string text = "vkfv " + command.name;
    for (const auto& operand : command.operands) {
        text += operand.needed ? " " + operand.name : fmt::format(" [{}]", operand.name);
    }
    for (const auto& option : command.options) {
        if (!option.needed.empty()) {
            text += " " + term_of(option);
        }
    }
    return text + " [OPTIONS]";
}

std::string sentence_of(const Option& option) {
    std::string text = option.description;
    if (!option.choices.empty()) {
        text += fmt::format(": {}", fmt::join(option.choices, ", "));
    }
    if (option.range.second > 0) {
        text += fmt::format(", {} to {}", option.range.first, option.range.second);
    }
    return option.fallback.empty() ? text : fmt::format("{} (default: {})", text, option.fallback);
}

std::vector<Section> sections_of(const Command& command, int level) {
    std::vector<Section> sections = {{.title = "vkfv " + command.name, .level = level}};
    Section& section = sections.front();
    section.paragraphs = {command.summary + "."};
    section.lines = {usage(command)};
    for (const auto& operand : command.operands) {
        const std::string choices =
            operand.choices.empty() ? "" : fmt::format(": {}", fmt::join(operand.choices, ", "));
        section.entries.push_back({operand.name, operand.description + choices});
    }
    for (const auto& option : command.options) {
        section.entries.push_back({term_of(option), sentence_of(option)});
    }
    if (!command.example.empty()) {
        sections.push_back({.title = "Example", .level = level + 1, .lines = {command.example}});
    }
    return sections;
}

std::vector<Section> sections_of_program() {
    Section measure{.title = "Commands"}, about{.title = "About vkfv itself"}, examples{.title = "Examples"};
    std::vector<std::string> alike;
    for (const auto& command : all_commands()) {
        (command.about_vkfv ? about : measure).entries.push_back({command.name, command.summary});
        if (!command.example.empty() && !command.about_vkfv) {
            examples.lines.push_back(command.example);
        }
        if (command.also_option) {
            alike.push_back("--" + command.name);
        }
    }
    Section options{.title = "Options of the commands"};
    for (const auto& [option, owners] : all_options()) {
        std::vector<std::string> names;
        for (const auto* owner : owners) {
            names.push_back(owner->name);
        }
        const std::string owned =
            owners.size() == all_commands().size() ? "" : fmt::format(" ({})", fmt::join(names, ", "));
        options.entries.push_back({term_of(*option), sentence_of(*option) + owned});
    }
    return {
        {.title = "vkfv",
         .paragraphs = {"A virtual focus-variation microscope. It traces light through real lens prescriptions to a "
                        "specimen and back to a detector, position by position, and measures the topography from "
                        "the images.",
                        fmt::format("A command may also be written as an option, anywhere on the line: {}.",
                                    fmt::join(alike, ", "))},
         .entries = {{"-h, --help", "What the program does; behind a command: what it takes"},
                     {"-v, --version", "The program's version"}},
         .lines = {"vkfv COMMAND ... [OPTIONS]", "vkfv help COMMAND"}},
        measure,
        about,
        options,
        examples,
        {.title = "Exit codes",
         .entries = {{"0", "Done"},
                     {"2", "The input is wrong"},
                     {"3", "No usable device"},
                     {"4", "The run failed and can be resumed"},
                     {"5", "Another run is writing there"},
                     {"130, 143, 129", "Ended by SIGINT, SIGTERM, SIGHUP"}}},
        {.title = "Environment",
         .entries = {{"VKFV_ASSETS",
                      "A folder of assets (objectives, tube_lenses, illuminators, glasses, specimens, stacks) that "
                      "is searched first; then those beside the configuration and in the folders above "
                      "it, then those that came with the program"},
                     {"NO_COLOR", "Set to anything: messages without colours, unless --color says otherwise"}}}};
}

std::vector<Section> whole_reference() {
    auto sections = sections_of_program();
    for (const auto& command : all_commands()) {
        std::ranges::move(sections_of(command, 2), std::back_inserter(sections));
    }
    return sections;
}

constexpr std::size_t text_width = 100, term_width = 30;

// The text in lines of at most text_width characters. The first line begins with `start`, padded to `indent`.
std::string wrapped(const std::string& text, std::string start, std::size_t indent) {
    std::string all, line = std::move(start);
    line.resize(std::max(indent, line.size() + (line.empty() ? 0 : 2)), ' ');
    std::istringstream words(text);
    bool fresh = true;
    for (std::string word; words >> word; fresh = false) {
        if (!fresh && line.size() + 1 + word.size() > text_width) {
            all += line + "\n";
            line = std::string(indent, ' ');
            fresh = true;
        }
        line += (fresh ? "" : " ") + word;
    }
    return all + line + "\n";
}

std::string terminal_text(const std::vector<Section>& sections) {
    std::string text;
    for (const auto& section : sections) {
        text += (text.empty() ? "" : "\n") + section.title + "\n";
        for (const auto& paragraph : section.paragraphs) {
            text += wrapped(paragraph, "", 2);
        }
        const std::string gap = section.paragraphs.empty() ? "" : "\n";
        for (const auto& line : section.lines) {
            text += (&line == &section.lines.front() ? gap : "") + "  " + line + "\n";
        }
        text += section.lines.empty() || section.entries.empty() ? "" : "\n";
        for (const auto& [term, meaning] : section.entries) {
            text += wrapped(meaning, "  " + term, term_width);
        }
    }
    return text;
}

// The text with roff's escapes, so that '-' is a minus sign and a '.' at the start of a line no request.
std::string roff(const std::string& text) {
    std::string escaped;
    for (const char character : text) {
        escaped += character == '\\' ? std::string("\\e") : (character == '-' ? "\\-" : std::string(1, character));
    }
    return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

} // namespace

const std::vector<OwnedOption>& all_options() {
    static const auto options = [] {
        std::vector<OwnedOption> list;
        for (const auto& command : all_commands()) {
            for (const auto& option : command.options) {
                auto found = std::ranges::find(list, option.name, [](const auto& known) { return known.option->name; });
                if (found == list.end()) {
                    found = list.insert(list.end(), {.option = &option, .owners = {}});
                }
                found->owners.push_back(&command);
            }
        }
        for (OwnedOption& owned : list) {
            std::stable_partition(owned.owners.begin(), owned.owners.end(),
                                  [&](const auto* owner) { return owner->name == owned.option->foremost; });
        }
        return list;
    }();
    return options;
}

std::string first_name(const Option& option) {
    return option.name.substr(0, option.name.find(','));
}

std::string term_of(const Option& option) {
    return option.value.empty() ? first_name(option) : first_name(option) + " " + option.value;
}

std::string usage_text() {
    std::string text = "usage: vkfv COMMAND ... [OPTIONS]\n\n"
                       "  vkfv new --out my.toml        a configuration to begin with\n"
                       "  vkfv check my.toml            what its instrument does\n"
                       "  vkfv image my.toml --z 0      one image\n"
                       "  vkfv stack my.toml            a focus stack, its heights and a report\n\n";
    std::vector<std::string> names;
    std::ranges::transform(all_commands(), std::back_inserter(names), &Command::name);
    text += wrapped(fmt::format("{}", fmt::join(names, ", ")), "commands:", 11);
    return text + "vkfv help tells of all of them, vkfv help COMMAND of one\n";
}

std::string help_text(const Command* command) {
    return terminal_text(command == nullptr ? sections_of_program() : sections_of(*command, 1));
}

std::string reference_markdown() {
    std::string text;
    for (const auto& section : whole_reference()) {
        const int level = section.title == "vkfv" ? 1 : section.level + 1;
        text += fmt::format("{}{} {}\n", text.empty() ? "" : "\n", std::string(static_cast<std::size_t>(level), '#'),
                            section.title);
        for (const auto& paragraph : section.paragraphs) {
            text += paragraph + "\n\n";
        }
        if (!section.lines.empty()) { // a test runs the lines that are not marked as text
            text += fmt::format("```{}\n{}\n```\n{}", section.title.starts_with("Example") ? "" : "text",
                                fmt::join(section.lines, "\n"), section.entries.empty() ? "" : "\n");
        }
        for (const auto& [term, meaning] : section.entries) {
            text += fmt::format("- `{}`: {}\n", term, meaning);
        }
    }
    return text;
}

std::string reference_manual() {
    std::string text = fmt::format(".TH VKFV 1 \"\" \"vkfv {}\"\n.SH NAME\nvkfv \\- a virtual focus\\-variation "
                                   "microscope\n",
                                   VKFV_VERSION);
    for (const auto& section : whole_reference()) {
        std::string title = section.title == "vkfv" ? "description" : section.title;
        if (section.level == 1) {
            std::ranges::transform(title, title.begin(), [](unsigned char letter) { return std::toupper(letter); });
        }
        text += fmt::format("{} \"{}\"\n", section.level == 1 ? ".SH" : ".SS", roff(title));
        for (const auto& paragraph : section.paragraphs) {
            text += fmt::format(".PP\n{}\n", roff(paragraph));
        }
        if (!section.lines.empty()) {
            text += ".PP\n.nf\n";
            for (const auto& line : section.lines) {
                text += roff(line) + "\n";
            }
            text += ".fi\n";
        }
        for (const auto& [term, meaning] : section.entries) {
            text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(term), roff(meaning));
        }
    }
    return text;
}

} // namespace vkfv::command_line
