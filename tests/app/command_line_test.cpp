// Commands by name and as options, and all that is told of them, come from the same declarations.
#include "app/commands.hpp"
#include "app/program.hpp"
#include "app/version.hpp"
#include "command_line/command_line.hpp"
#include "command_line/reference.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <set>
#include <sstream>

namespace vkfv::test {
namespace {

// The commands are declared after main() has begun: they ask other rooms for their lists, which static objects must
// not.
class Declared : public testing::Environment {
    void SetUp() override { command_line::declare_commands(app::commands(), app::version_text); }
};
[[maybe_unused]] const auto* const declared = testing::AddGlobalTestEnvironment(new Declared);

using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

// Messages name a command as it was written.
std::string without_dashes_of_commands(std::string text) {
    for (const auto& command : command_line::all_commands()) {
        const std::string option = "--" + command.name;
        for (auto at = text.find(option); at != std::string::npos; at = text.find(option, at)) {
            text.erase(at, 2);
        }
    }
    return text;
}

std::string without_times(const std::string& text) {
    std::istringstream lines(text);
    std::string rest;
    for (std::string line; std::getline(lines, line);) {
        rest += line.ends_with(" s") ? "" : line + "\n";
    }
    return rest;
}

TEST(CommandLine, ACommandIsItsOption) {
    const auto folder = fresh_folder("both");
    write_file(folder / "c.toml", ideal_configuration() + "[diffraction]\nmodel = \"none\"\n");
    write_file(folder / "rays.csv", "x_mm,y_mm,z_mm,l,m,n\n0,0,0,0,0,1\n");
    ASSERT_EQ(run_program({"stack", "c.toml", "--quiet"}, folder).exit_code, 0);
    const std::vector<Words> cases = {{"stack", "c.toml"}, // complete: no times are told
                                      {"stack", "c.toml", "--seed", "2"},
                                      {"image", "c.toml", "--z", "-1", "--rays", "2e3"},
                                      {"image", "c.toml"},
                                      {"image", "c.toml", "--z", "high"},
                                      {"sweep", "c.toml"},
                                      {"calibrate", "c.toml", "--only", "N_X"},
                                      {"budget", "c.toml", "--measurand", "Sq"},
                                      {"capability", "c.toml"}, // too short a scan
                                      {"fit", "out", "--free", "specimen.height"},
                                      {"topography", "out", "--set", "trace.seed=9"},
                                      {"topography", "nowhere"},
                                      {"compare", "out/topography.tif", "out/truth.tif", "--json"},
                                      {"compare", "a.x3p", "b.x3p", "--profile", "1,2,3,4"},
                                      {"surface", "out/truth.tif", "--form", "none", "--s_filter_um", "3"},
                                      {"surface", "part.x3p", "--filter", "median"},
                                      {"surface", "part.x3p", "--s_filter_um", "80", "--l_filter_um", "5"},
                                      {"merge", "out"},
                                      {"merge", "nowhere"},
                                      {"verify", "out"},
                                      {"verify", "nowhere"},
                                      {"check", "c.toml"},
                                      {"check", "c.toml", "--json", "--set", "detector.pixels=9"},
                                      {"check", "c.toml", "--set", "trace.rasy=5"},
                                      {"check", "c.toml", "--rays", "many"},
                                      {"check", "c.toml", "--form", "none"},
                                      {"check", "c.toml", "--rasy"},
                                      {"check", "c.toml", "another.toml"},
                                      {"check", "missing.toml"},
                                      {"camera", "c.toml"},
                                      {"trace-rays", "c.toml", "rays.csv", "--apertures", "off"},
                                      {"trace-rays", "c.toml", "rays.csv", "--precision", "half"},
                                      {"layout", "c.toml", "layout.svg"},
                                      {"optics", "c.toml", "--out", "optics", "--z_range_um", "none"},
                                      {"devices", "--json"},
                                      {"devices", "--quick"},
                                      {"bench", "c.toml", "--runs", "0"},
                                      {"bench", "c.toml", "--bench-parts", "nonsense"},
                                      {"import", "lens.zmx"},
                                      {"list", "scatter"},
                                      {"list", "glases"},
                                      {"keys", "--json"},
                                      {"explain", "trace.rays"},
                                      {"explain", "trace.rasy"},
                                      {"template"}};
    std::set<std::string> seen;
    for (Words words : cases) {
        seen.insert(words.front());
        const auto by_name = run_program(words, folder);
        words.front() = "--" + words.front();
        const auto by_option = run_program(words, folder);
        const std::string asked = fmt::format("{}", fmt::join(words, " "));
        EXPECT_EQ(by_name.exit_code, by_option.exit_code) << asked;
        EXPECT_EQ(without_times(by_name.standard_output), without_times(by_option.standard_output)) << asked;
        EXPECT_EQ(without_dashes_of_commands(by_name.standard_error),
                  without_dashes_of_commands(by_option.standard_error))
            << asked;
    }
    for (const auto& command : command_line::all_commands()) {
        EXPECT_EQ(seen.contains(command.name), command.also_option) << command.name;
    }
}

TEST(CommandLine, OperandsStandAnywhereBehindTheCommand) {
    const auto folder = fresh_folder("anywhere");
    write_file(folder / "c.toml", ideal_configuration());
    EXPECT_EQ(run_program({"check", "--rays", "1e3", "c.toml", "--json"}, folder).exit_code, 0);
    // A list does not swallow the operand.
    const auto bench = run_program({"bench", "--bench-parts", "stages,whole", "none.toml", "--quick"}, folder);
    EXPECT_THAT(bench.standard_error, HasSubstr("none.toml"));
    EXPECT_THAT(bench.standard_error, Not(HasSubstr("bench-parts")));
}

TEST(CommandLine, AWordThatIsNoCommandIsRefusedWithTheNearest) {
    const auto folder = fresh_folder("no_command");
    for (const auto& words : {Words{"stak", "c.toml"}, {"help", "stak"}}) {
        const auto result = run_program(words, folder);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_THAT(result.standard_error, HasSubstr("stak: expected a command. Did you mean stack?"));
    }
    EXPECT_THAT(run_program({"check"}, folder).standard_error, HasSubstr("C.toml is required"));
}

// The words that a command needs to be run at all.
Words needed_by(const app::Command& command) {
    Words words = {command.name};
    for (const auto& operand : command.operands) {
        words.push_back(operand.choices.empty() ? "x" : operand.choices.front());
    }
    if (command.name == "compare") {
        words.emplace_back("y");
    }
    return words;
}

std::string good_value(const app::Option& option) {
    static const std::map<std::string, std::string> values = {
        {"--set", "a=1"}, {"--form", "none"}, {"--profile", "1,2,3,4"}, {"--shard", "1/2"}};
    const auto found = values.find(option.name);
    return found != values.end()     ? found->second
           : !option.choices.empty() ? option.choices.front()
                                     : fmt::format("{}", std::max(1, option.range.first));
}

// The command line is read within this process, as there are hundreds of cases.
std::string refusal_of(Words words) {
    words.insert(words.begin(), "vkfv");
    std::vector<char*> values;
    for (auto& word : words) {
        values.push_back(word.data());
    }
    try {
        command_line::run_command_line(static_cast<int>(values.size()), values.data());
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(CommandLine, AnOptionOfAnotherCommandIsRefused) {
    for (const auto& command : command_line::all_commands()) {
        for (const auto& [option, owners] : app::all_options()) {
            if (std::ranges::find(owners, &command) != owners.end()) {
                continue;
            }
            Words words = needed_by(command);
            words.push_back(app::first_name(*option));
            if (!option->value.empty()) {
                words.push_back(good_value(*option));
            }
            if (command.name == "image") {
                words.insert(words.end(), {"--z", "1"});
            }
            if (command.name == "budget") {
                words.insert(words.end(), {"--measurand", "Sq"});
            }
            if (command.name == "fit") {
                words.insert(words.end(), {"--free", "specimen.height_um"});
            }
            const std::string refusal =
                option->needed.empty()
                    ? fmt::format("{} with {}: expected ", app::first_name(*option), command.name)
                    : fmt::format("{} with {}, and only with it", option->name, owners.front()->name);
            EXPECT_THAT(refusal_of(words), HasSubstr(refusal));
        }
    }
}

TEST(CommandLine, HelpOfACommandNamesItsOptionsAlone) {
    const auto folder = fresh_folder("help");
    const auto overview = run_program({"help"}, folder).standard_output;
    EXPECT_EQ(run_program({"--help"}, folder).standard_output, overview);
    for (const auto& command : command_line::all_commands()) {
        EXPECT_THAT(overview, HasSubstr("\n  " + command.name + "  "));
        const auto help = run_program({command.name, "--help"}, folder);
        EXPECT_EQ(help.exit_code, 0) << command.name;
        EXPECT_EQ(run_program({"help", command.name}, folder).standard_output, help.standard_output);
        for (const auto& [option, owners] : app::all_options()) {
            const bool own = std::ranges::find(owners, &command) != owners.end();
            const std::string entry = "\n  " + app::term_of(*option) + " ";
            EXPECT_EQ(help.standard_output.find(entry) != std::string::npos, own) << command.name << entry;
            EXPECT_THAT(overview, HasSubstr(entry));
        }
    }
}

TEST(CommandLine, DocumentationIsThatOfTheProgram) {
    EXPECT_EQ(read_file(std::filesystem::path(VKFV_SOURCE_DIR) / "docs/commands.md"),
              command_line::reference_markdown())
        << "docs/commands.md is stale. Renew it: " VKFV_BINARY_DIR "/vkfv help --markdown > docs/commands.md";
    EXPECT_EQ(run_program({"help", "--markdown"}, fresh_folder("page")).standard_output,
              command_line::reference_markdown());
}

// Exit code of a shell's command; what it prints is in the file `printed`.
int shell(const std::filesystem::path& folder, const std::string& command) {
    return std::system(fmt::format("cd '{}' && {} > printed 2>&1", folder.string(), command).c_str());
}

TEST(CommandLine, ManualPageRendersWithoutAWarning) {
    const auto folder = fresh_folder("manual");
    const auto page = run_program({"man"}, folder);
    ASSERT_EQ(page.exit_code, 0);
    for (const auto& [option, owners] : app::all_options()) {
        std::string name = app::first_name(*option);
        for (auto at = name.find('-'); at != std::string::npos; at = name.find('-', at + 2)) {
            name.insert(at, "\\");
        }
        EXPECT_THAT(page.standard_output, HasSubstr("\\fB" + name));
    }
    write_file(folder / "vkfv.1", page.standard_output);
    EXPECT_EQ(shell(folder, "groff -man -ww -z -Tascii vkfv.1"), 0);
    EXPECT_EQ(read_file(folder / "printed"), "");
}

TEST(CommandLine, BashCompletes) {
    const auto folder = fresh_folder("completion");
    write_file(folder / "vkfv.bash", run_program({"completion", "bash"}, folder).standard_output);
    write_file(folder / "demo one.toml", "");
    write_file(folder / "drive", "source vkfv.bash\n"
                                 "COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1))\n"
                                 "_vkfv\n"
                                 "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
    ASSERT_EQ(shell(folder, "bash -n vkfv.bash"), 0) << read_file(folder / "printed");
    const std::vector<std::pair<std::string, std::string>> completions = {
        {"vkfv st", "stack\n"},
        {"vkfv --st", "--stack\n"},
        {"vkfv surface x --s_", "--s_filter_um\n"},
        {"vkfv --surface x --fi", "--filter\n"},
        {"vkfv stack x --s_", "\n"},
        {"vkfv surface x --filter sp", "spline\nspline-mirrored\n"},
        {"vkfv check x --traversal ''", "auto\nray-query\nquadtree\nbvh\n"},
        {"vkfv check de", "demo one.toml\n"},
        {"vkfv stack x --out de", "demo one.toml\n"},
        {"vkfv stack x --rays ''", "\n"},
        {"vkfv list gl", "glasses\n"},
        {"vkfv --camera de", "demo one.toml\n"}, // the command, and not the option of `vkfv new`
        {"vkfv stack x --set trace.est", "trace.estimator=\n"},
        {"vkfv stack x --set trace.estimator = ba", "backward\n"}, // bash parts words at "="
        {"vkfv stack x --set trace.estimator = ''", "auto\nforward\nbackward\n"},
        {"vkfv stack x --set trace.estimator =", "auto\nforward\nbackward\n"},
        {"vkfv stack x --set trace.estimator=ba", "trace.estimator=backward\n"}, // where \"=\" parts none
        {"vkfv stack x --set specimen.level = t", "true\n"},
        {"vkfv stack x --set trace.rays = 1", "\n"},
        {"vkfv explain detector.cam", "detector.camera\n"},
        {"vkfv explain detector.pix", "detector.pixel_um\ndetector.pixels\n"},
        {"vkfv check x --color a", "auto\nalways\n"},
        {"vkfv help trace", "trace-rays\n"},
        {"vkfv completion f", "fish\n"}};
    for (const auto& [typed, completed] : completions) {
        ASSERT_EQ(shell(folder, "bash drive " + typed), 0) << read_file(folder / "printed");
        EXPECT_EQ(read_file(folder / "printed"), completed) << typed;
    }
}

TEST(CommandLine, OtherShellsTakeTheirScripts) {
    const auto folder = fresh_folder("other_shells");
    for (const std::string name : {"zsh", "fish"}) {
        const auto script = run_program({"completion", name}, folder).standard_output;
        EXPECT_THAT(script, HasSubstr("glass-catalog"));
        write_file(folder / name, script);
        if (shell(folder, "command -v " + name) == 0) {
            EXPECT_EQ(shell(folder, fmt::format("{} -n {}", name, name)), 0) << read_file(folder / "printed");
        }
    }
}

TEST(CommandLine, ColoursAreForTerminalsUnlessAskedFor) {
    const auto folder = fresh_folder("colours");
    write_file(folder / "c.toml", small_configuration);
    const Words import = {"new", "--out", "my.toml"};
    const auto has_colour = [&](const Words& more, const std::map<std::string, std::string>& environment) {
        std::filesystem::remove(folder / "my.toml");
        Words words = import;
        words.insert(words.end(), more.begin(), more.end());
        const auto said = run_program(words, folder, environment);
        EXPECT_EQ(said.exit_code, 0);
        EXPECT_THAT(said.standard_error, HasSubstr("my.toml is written"));
        return said.standard_error.find("\033[") != std::string::npos;
    };
    EXPECT_FALSE(has_colour({}, {})); // a pipe
    EXPECT_TRUE(has_colour({"--color", "always"}, {}));
    EXPECT_TRUE(has_colour({"--color=always"}, {{"NO_COLOR", "1"}}));
    EXPECT_FALSE(has_colour({"--color", "never"}, {}));
    EXPECT_FALSE(has_colour({"--color", "auto"}, {{"NO_COLOR", "1"}}));
    std::filesystem::remove(folder / "my.toml");
    EXPECT_EQ(run_program({"new", "--out", "my.toml", "-q"}, folder).standard_error, "");
}

TEST(CommandLine, NewWritesWhatChecksClean) {
    const auto folder = fresh_folder("new");
    const Words instruments[] = {{},
                                 {"--objective", "20x/0.45", "--light", "ring", "--specimen", "step:10um"},
                                 {"--objective", "50x/0.8", "--led", "460nm", "--working_distance_mm", "1"},
                                 {"--objective", "telecentric:2x/0.1", "--specimen", "sphere:1mm"},
                                 {"--objective", "5x/0.15", "--camera", "2/3:2448x2048", "--specimen", "plane"}};
    for (const Words& instrument : instruments) {
        Words words = {"new"};
        words.insert(words.end(), instrument.begin(), instrument.end());
        const auto made = run_program(words, folder);
        ASSERT_EQ(made.exit_code, 0) << made.standard_error;
        write_file(folder / "my.toml", made.standard_output);
        const auto check = run_program({"check", "my.toml"}, folder);
        EXPECT_EQ(check.exit_code, 0) << check.standard_error;
        EXPECT_THAT(check.standard_output + check.standard_error, testing::Not(HasSubstr("warning")))
            << fmt::format("{}", fmt::join(instrument, " "));
    }
}

Words names_listed(const std::string& topic, const std::filesystem::path& folder) {
    Words names;
    for (const auto& one : nlohmann::json::parse(run_program({"list", topic, "--json"}, folder).standard_output)) {
        names.push_back(one["name"]);
        EXPECT_NE(one["description"], "") << names.back();
    }
    return names;
}

TEST(List, NamesWhatAConfigurationTakes) {
    const auto folder = fresh_folder("list");
    EXPECT_THAT(names_listed("objectives", folder), testing::Contains("10x_0.28"));
    EXPECT_THAT(names_listed("tube-lenses", folder), testing::Contains("200mm"));
    EXPECT_THAT(names_listed("illuminators", folder), testing::Contains("koehler"));
    EXPECT_THAT(names_listed("cameras", folder), testing::Contains("IMX250"));
    EXPECT_THAT(names_listed("leds", folder), testing::Contains("green"));
    EXPECT_THAT(names_listed("scatter", folder), testing::Contains("henyey-greenstein"));
    EXPECT_THAT(run_program({"--list", "glasses"}, folder).standard_output,
                testing::ContainsRegex("N-BK7 +nd = 1.51680.; SCHOTT"));
    // The list must hold the names that the reader of configurations gives where it refuses another one.
    write_file(folder / "c.toml", replaced(small_configuration, "kind = \"step\"", "kind = \"none of them\""));
    const auto refusal = run_program({"check", "c.toml"}, folder).standard_error;
    std::string all;
    for (const auto& name : names_listed("specimens", folder)) {
        all += fmt::format("{}\"{}\"", all.empty() ? "" : " or ", name);
    }
    EXPECT_THAT(refusal, HasSubstr(all));
}

} // namespace
} // namespace vkfv::test
