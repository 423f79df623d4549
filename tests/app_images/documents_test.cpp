// The statements of the documents hold: their links lead somewhere, their commands run, their configurations are valid.
//
// Commands stand in fenced blocks without a language. An HTML comment on the line before a block, which readers do not
// see, tells how it is run:
//   <!-- not run: why -->          not at all; the options of its commands must exist all the same
//   <!-- checked: why -->          only its configuration is read, with all settings
//   <!-- run: --set KEY=VALUE -->  with these options at the end of each command that traces
#include "app/commands.hpp"
#include "app/program.hpp"
#include "app/version.hpp"
#include "command_line/command_line.hpp"
#include "command_line/reference.hpp"
#include "configuration/configuration.hpp"
#include "core/messages/error.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;

const fs::path source = VKFV_SOURCE_DIR;

struct Block {
    std::string language;
    std::string marker; // of the comment before it, without <!-- and -->
    std::string text;
    int line = 0; // of its first line
};

struct Heading {
    std::string text;
    int line = 0;
};

struct Link {
    std::string target;
    int line = 0;
};

struct Document {
    std::vector<Block> blocks;
    std::vector<Heading> headings;
    std::vector<Link> links;
    std::vector<Link> code; // in backticks
};

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Document parse_document(const std::string& text) {
    static const std::regex code("`([^`]+)`");
    static const std::regex link(R"(\]\(([^)\s]+)\))");
    Document document;
    std::istringstream lines(text);
    std::string marker;
    bool within = false;
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::string content = trimmed(line);
        if (content.starts_with("```")) {
            if (!within) {
                document.blocks.push_back(
                    {.language = content.substr(3), .marker = marker, .text = "", .line = number + 1});
            }
            within = !within;
            marker.clear();
        } else if (within) {
            document.blocks.back().text += line + "\n";
        } else if (content.starts_with("<!--") && content.ends_with("-->")) {
            marker = trimmed(content.substr(4, content.size() - 7));
        } else {
            if (!content.empty()) {
                marker.clear();
            }
            if (content.starts_with("#")) {
                document.headings.push_back({trimmed(content.substr(content.find_first_not_of('#'))), number});
            }
            for (std::sregex_iterator at(line.begin(), line.end(), code), end; at != end; ++at) {
                document.code.push_back({(*at)[1], number});
            }
            const std::string plain = std::regex_replace(line, code, "");
            for (std::sregex_iterator at(plain.begin(), plain.end(), link), end; at != end; ++at) {
                document.links.push_back({(*at)[1], number});
            }
        }
    }
    return document;
}

// GitHub's anchors of the headings: lower case, punctuation left out, spaces as '-', a number behind those that repeat.
std::set<std::string> anchors_of(const Document& document) {
    std::map<std::string, int> seen;
    std::set<std::string> anchors;
    for (const auto& heading : document.headings) {
        std::string anchor;
        for (const char character : heading.text) {
            if (character == ' ') {
                anchor += '-';
            } else if (std::isalnum(static_cast<unsigned char>(character)) != 0 || character == '-' ||
                       character == '_' || (character & 0x80) != 0) {
                anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
            }
        }
        const int before = seen[anchor]++;
        anchors.insert(before == 0 ? anchor : fmt::format("{}-{}", anchor, before));
    }
    return anchors;
}

// The broken links of a document that lies at `file`, each with its line and the reason.
std::vector<std::string> broken_links(const fs::path& file, const std::string& text) {
    static const std::regex elsewhere("[a-z]+:.*");
    std::vector<std::string> broken;
    for (const auto& [target, line] : parse_document(text).links) {
        if (std::regex_match(target, elsewhere)) {
            continue;
        }
        const auto hash = target.find('#');
        const fs::path path = hash == 0 ? file : file.parent_path() / target.substr(0, hash);
        if (!fs::exists(path)) {
            broken.push_back(fmt::format("{}:{}: {}: no such file", file.string(), line, target));
        } else if (hash != std::string::npos &&
                   !anchors_of(parse_document(hash == 0 ? text : read_file(path))).contains(target.substr(hash + 1))) {
            broken.push_back(fmt::format("{}:{}: {}: no such heading", file.string(), line, target));
        }
    }
    return broken;
}

std::vector<fs::path> documents() {
    std::vector<fs::path> files;
    for (const fs::path& folder : {source, source / "docs"}) {
        for (const auto& entry : fs::directory_iterator(folder)) {
            if (entry.path().extension() == ".md") {
                files.push_back(entry.path());
            }
        }
    }
    std::ranges::sort(files);
    return files;
}

TEST(Documents, LinksLeadSomewhere) {
    for (const auto& file : documents()) {
        EXPECT_THAT(broken_links(file, read_file(file)), testing::IsEmpty());
    }
}

TEST(Documents, ABrokenLinkIsFound) {
    const fs::path file = source / "docs/waves.md";
    const std::string text = read_file(file);
    ASSERT_THAT(broken_links(file, text), testing::IsEmpty());
    EXPECT_THAT(broken_links(file, text + "[a](valdation.md)\n"),
                testing::ElementsAre(testing::HasSubstr("no such file")));
    EXPECT_THAT(broken_links(file, text + "[a](../README.md#nowhere) `[b](c)`\n"),
                testing::ElementsAre(testing::HasSubstr("no such heading")));
    EXPECT_THAT(broken_links(file, text + "[a](#what-it-costs) [b](../README.md#two-commands)\n"), testing::IsEmpty());
}

TEST(Documents, EveryDocumentIsLinkedFromTheReadme) {
    const std::string readme = read_file(source / "README.md");
    for (const auto& entry : fs::directory_iterator(source / "docs")) {
        if (entry.path().extension() != ".md") {
            continue; // pictures and notebooks belong to documents
        }
        EXPECT_THAT(readme, testing::HasSubstr("](docs/" + entry.path().filename().string() + ")"));
    }
    EXPECT_LE(std::ranges::count(readme, '\n'), 150);
}

TEST(Documents, CitationPythonPackageAndChangelogAreOfThisVersion) {
    EXPECT_THAT(read_file(source / "CITATION.cff"), testing::HasSubstr("\nversion: " VKFV_VERSION "\n"));
    EXPECT_THAT(read_file(source / "tools/python/vkfv/__init__.py"),
                testing::HasSubstr("\n__version__ = \"" VKFV_VERSION "\"\n"));
    EXPECT_THAT(read_file(source / "CHANGELOG.md"), testing::HasSubstr("\n## [" VKFV_VERSION "] - "));
}

// The words of a command of vkfv in backticks; empty if that is no whole command.
std::vector<std::string> words_of(const std::string& code) {
    std::vector<std::string> words;
    std::istringstream stream(code);
    for (std::string word; stream >> word;) {
        words.push_back(word);
    }
    return words.size() > 1 && words.front() == "vkfv" ? words : std::vector<std::string>();
}

// Options of a command in backticks that it does not take, and unknown commands.
std::vector<std::string> unknown_words(const std::string& code) {
    auto words = words_of(code);
    std::vector<std::string> unknown;
    if (words.empty()) {
        return unknown;
    }
    const command_line::Command* named = nullptr;
    for (const auto& command : command_line::all_commands()) {
        if (std::ranges::find(words, "--" + command.name) != words.end() || words[1] == command.name) {
            named = &command;
        }
    }
    if (named == nullptr && words[1] != "--help" && words[1] != "--version" && words[1] != "COMMAND") {
        return {words[1]};
    }
    for (const auto& word : words) {
        const bool known = std::ranges::any_of(command_line::all_options(), [&](const auto& owned) {
            return command_line::first_name(*owned.option) == word &&
                   std::ranges::find(owned.owners, named) != owned.owners.end();
        });
        if (word.starts_with("--") && !known && word != "--help" && word != "--version" &&
            word != "--" + (named != nullptr ? named->name : "")) {
            unknown.push_back(word);
        }
    }
    return unknown;
}

void declare() {
    if (command_line::all_commands().empty()) {
        command_line::declare_commands(app::commands(), app::version_text);
    }
}

TEST(Documents, CommandsInBackticksExist) {
    declare();
    EXPECT_THAT(unknown_words("vkfv stak C.toml"), testing::ElementsAre("stak"));
    EXPECT_THAT(unknown_words("vkfv stack C.toml --align"), testing::ElementsAre("--align"));
    for (const auto& file : documents()) {
        if (file.filename() == "CHANGELOG.md") { // it names commands of earlier versions
            continue;
        }
        for (const auto& [code, line] : parse_document(read_file(file)).code) {
            EXPECT_THAT(unknown_words(code), testing::IsEmpty()) << file << ":" << line << ": " << code;
        }
    }
}

// Exit code of a script of bash in the folder; what it prints is in the file `printed`.
int run_script(const fs::path& folder, const std::string& script) {
    write_file(folder / "script", script);
    return std::system(fmt::format("cd '{}' && bash -eu script > printed 2>&1", folder.string()).c_str());
}

// `vkfv` as the documents call it: the program, with few rays, pixels and images where it traces, and without waves.
// `optics`, `bench`, `calibrate`, `budget`, `capability` and configurations that are to be checked alone take long
// whatever is asked of them: `layout` reads the same configuration.
const std::string small_vkfv = R"(#!/usr/bin/env bash
command=${1#--}
words=("$1")
case $HOW:$command in
run:optics | run:bench | run:calibrate | run:budget | run:capability | check:check | check:stack | check:image | \
    check:calibrate | check:budget | check:capability)
    command=layout
    ;;
esac
while shift && (($#)); do
    case $command:$1 in
    *:--rays) words+=(--rays 2000) && shift ;;
    *:trace.rays=*) words+=(trace.rays=2000) ;;
    layout:--out | layout:--only | layout:--measurand | layout:--trials | layout:--repeats | layout:--wavelengths | \
        layout:--amplitudes) shift ;;
    layout:--small) ;;
    *) words+=("$1") ;;
    esac
done
few=(--set trace.rays=2000 --set detector.pixels=16 --set diffraction.model=none)
case $command in
check | image) words+=("${few[@]}") ;;
# With so few rays no height is better than chance.
stack) words+=(--set scan.z_start_um=-4 --set scan.z_stop_um=4 --set scan.z_step_um=4 --set topography.false_peak_rate=1 "${few[@]}") ;;
fit) words+=(--replicates 8) ;;
sweep) words+=(--set specimen.pitch_um=2 "${few[@]}") ;;
camera) words+=(--pixels 32 --averaged 4) ;;
layout) [[ ${words[0]} == *layout ]] || words=(layout "${words[1]}" layout.svg "${words[@]:2}" "${few[@]}") ;;
esac
case $command in check | image | stack | sweep | layout) words+=($MORE) ;; esac
exec PROGRAM "${words[@]}"
)";

// Images of another instrument, in one file and in a folder: texture that is sharpest in the middle.
void write_stack(const fs::path& file, const fs::path& folder) {
    constexpr int side = 16;
    const OIIO::ImageSpec spec(side, side, 1, OIIO::TypeDesc::UINT8);
    const auto pages = OIIO::ImageOutput::create("x.tif");
    auto mode = OIIO::ImageOutput::Create;
    for (const int contrast : {10, 30, 60, 31, 11}) {
        std::vector<std::uint8_t> pixels;
        pixels.reserve(std::size_t{side} * side);
        for (int k = 0; k < side * side; ++k) {
            pixels.push_back(static_cast<std::uint8_t>(128 + (k * 7919 % 13 > 6 ? contrast : -contrast)));
        }
        ASSERT_TRUE(pages->open(file.string(), spec, mode));
        ASSERT_TRUE(pages->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
        mode = OIIO::ImageOutput::AppendSubimage;
        const auto one = OIIO::ImageOutput::create("x.png");
        ASSERT_TRUE(one->open((folder / fmt::format("{}.png", contrast)).string(), spec));
        ASSERT_TRUE(one->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
        one->close();
    }
    pages->close();
}

// Fills a folder as a checkout is, with the files that documents take for granted.
void furnish(const fs::path& folder) {
    fs::create_directories(folder / "bin");
    write_file(folder / "bin/vkfv", replaced(small_vkfv, "PROGRAM", program()));
    fs::permissions(folder / "bin/vkfv", fs::perms::owner_all);
    for (const std::string name : {"objectives", "tube_lenses", "illuminators", "specimens", "stacks"}) {
        fs::create_directories(folder / "assets" / name);
        for (const auto& entry : fs::directory_iterator(source / "assets" / name)) {
            if (entry.is_regular_file()) {
                // A sweep's rays are its own.
                write_file(folder / "assets" / name / entry.path().filename(),
                           std::regex_replace(read_file(entry.path()), std::regex("values = \\[1e4, .*1e7\\]"),
                                              "values = [1e2, 1e3]"));
            }
        }
    }
    fs::copy_file(source / "assets/specimens/letter_F.x3p", folder / "measured.x3p");
    fs::copy_file(source / "assets/stacks/step.toml", folder / "C.toml");
    fs::copy_file(source / "tests/fuzz/corpus/zmx/doublet.zmx", folder / "lens.zmx");
    write_file(folder / "rays.csv", "x_mm,y_mm,z_mm,l,m,n\n0,0,0,0,0,1\n");
    fs::create_directories(folder / "photographs");
    write_stack(folder / "images.tif", folder / "photographs");
}

// The next line of a block, with those that continue it. False at the end.
bool next_command(std::istream& lines, std::string& command) {
    const bool found = static_cast<bool>(std::getline(lines, command));
    for (std::string more; command.ends_with("\\") && std::getline(lines, more);) {
        command = command.substr(0, command.size() - 1) + more;
    }
    return found;
}

// Runs the commands of a document, in their order. Returns a line of "line: command: output" for each that failed.
std::vector<std::string> failures_of(const std::string& text, const fs::path& folder) {
    declare();
    furnish(folder);
    const std::string environment =
        fmt::format("export PATH='{}':$PATH MORE= HOW=run\nset -o pipefail\n", (folder / "bin").string());
    EXPECT_EQ(run_script(folder, environment + "vkfv surface measured.x3p --form none --out truth.tif\n"), 0);
    if (text.find(" shard-1 shard-2\n") != std::string::npos) {
        EXPECT_EQ(
            run_script(folder, environment + "for k in 1 2; do vkfv stack C.toml --shard $k/2 --out shard-$k; done\n"),
            0);
    }
    std::vector<std::string> failures;
    std::set<std::string> done;
    std::string variables; // assignments of earlier lines
    for (const auto& block : parse_document(text).blocks) {
        if (!block.language.empty()) {
            continue;
        }
        const bool run = block.marker.starts_with("run: ");
        const bool check = block.marker.starts_with("checked: ");
        const bool left_out = block.marker.starts_with("not run: ");
        if (!run && !check && !left_out && !block.marker.empty()) {
            failures.push_back(fmt::format("{}: unknown comment: {}", block.line, block.marker));
            continue;
        }
        std::istringstream lines(block.text);
        std::string line;
        for (int number = block.line; next_command(lines, line); ++number) {
            if (const auto unknown = unknown_words(line.substr(0, line.find(" #"))); !unknown.empty()) {
                failures.push_back(fmt::format("{}: {}: unknown: {}", number, line, unknown.front()));
            } else if (left_out || !done.insert(line).second) {
                continue;
            } else if (std::regex_match(line, std::regex("[a-z_]+=.*"))) {
                variables += line + "\n";
            } else if (run_script(folder, fmt::format("{}MORE='{}' HOW={}\n{}{}\n", environment,
                                                      run ? block.marker.substr(5) : "", check ? "check" : "run",
                                                      variables, line)) != 0) {
                failures.push_back(fmt::format("{}: {}: {}", number, line, read_file(folder / "printed")));
            }
        }
    }
    return failures;
}

class DocumentCommands : public testing::TestWithParam<fs::path> {};

TEST_P(DocumentCommands, Run) {
    EXPECT_THAT(failures_of(read_file(GetParam()), fresh_folder("furnished")), testing::IsEmpty()) << GetParam();
}

// The identity of what a reader gets who copies all tables of a document into one file.
std::string identity_of_tables(const std::string& text) {
    std::string all;
    for (const auto& block : parse_document(text).blocks) {
        all += block.language == "toml" ? block.text + "\n" : "";
    }
    const auto file = fresh_folder("tables") / "microscope.toml";
    write_file(file, all);
    return load_configuration(file).identity;
}

TEST(Documents, TheTutorialsTablesAreTheMicroscopeThatItNames) {
    const std::string text = read_file(source / "docs/tutorial.md");
    EXPECT_EQ(identity_of_tables(text), load_configuration(source / "assets/stacks/own_microscope.toml").identity);
    EXPECT_NE(identity_of_tables(replaced(text, "height_um = 10.0", "height_um = 10.1")), identity_of_tables(text));
    EXPECT_THROW(identity_of_tables(replaced(text, "focal_length_mm = 10.0", "focal_length_mn = 10.0")), InputError);
}

TEST(Documents, ABrokenCommandIsFound) {
    const auto folder = fresh_folder("furnished");
    const std::string text =
        "```\nvkfv check C.toml # comment\n```\n"
        "```\nvkfv check D.toml\n```\n"
        "```\nvkfv check C.toml --set trace.rasy=3\n```\n"
        "<!-- run: --set trace.seed=-1 -->\n```\nvkfv check C.toml --set trace.seed=3\n```\n"
        "<!-- checked: it takes long -->\n```\nvkfv stack C.toml --set scan.z_step=1 --out x\n```\n"
        "<!-- not run: it takes long -->\n```\nvkfv stack C.toml --aline\nno_such_program\n```\n"
        "<!-- note -->\n```\nvkfv check C.toml\n```\n"
        "```\nsome=3\nexit $some\n```\n"
        "```text\nvkfv stak\n```\n";
    using testing::HasSubstr;
    EXPECT_THAT(failures_of(text, folder),
                testing::ElementsAre(HasSubstr("D.toml: no such file"), HasSubstr("trace.rasy"),
                                     HasSubstr("trace.seed"), HasSubstr("scan.z_step"), HasSubstr("unknown: --aline"),
                                     HasSubstr("unknown comment"), HasSubstr("exit $some")));
}

INSTANTIATE_TEST_SUITE_P(Documents, DocumentCommands, testing::ValuesIn(documents()),
                         [](const auto& info) { return info.param.stem().string(); });

} // namespace
} // namespace vkfv::test
