// A mistake is told once, whatever else depends on it: every value of every example is damaged by itself, and every key
// misspelt.
#include "app/program.hpp"
#include "configuration/configuration.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>

namespace vkfv::test {
namespace {

std::vector<std::string> lines_of(const std::filesystem::path& file) {
    std::istringstream stream(read_file(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const auto& line : lines) {
        text += line + "\n";
    }
    return text;
}

std::vector<InputProblem> problems_of(const std::vector<std::string>& lines, const std::filesystem::path& file) {
    try {
        (void)read_configuration(TomlTable::parse(joined(lines), file), Needs::exposure);
    } catch (const InputError& error) {
        return error.problems();
    }
    return {};
}

// The place where the value of "key = value" on one line begins; none for other lines.
std::optional<std::size_t> value_in(const std::string& line) {
    const auto equals = line.find(" = ");
    const bool whole =
        equals != std::string::npos && line[0] >= 'a' && line[0] <= 'z' && !line.ends_with('[') && !line.ends_with(',');
    return whole ? std::optional(equals + 3) : std::nullopt;
}

std::string all_of(const std::vector<InputProblem>& problems) {
    return problems.empty() ? "nothing" : InputError(problems).what();
}

TEST(ConfigurationProblems, ADamagedValueIsToldOnceAndNothingElse) {
    int damaged = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(VKFV_SOURCE_DIR) / "assets" / "stacks")) {
        if (entry.path().extension() != ".toml") {
            continue;
        }
        const auto lines = lines_of(entry.path());
        ASSERT_TRUE(problems_of(lines, entry.path()).empty())
            << entry.path() << all_of(problems_of(lines, entry.path()));
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const auto value = value_in(lines[i]);
            if (!value) {
                continue;
            }
            auto changed = lines;
            changed[i] = lines[i].substr(0, *value) + "1979-05-27"; // a date, which no key takes
            const auto problems = problems_of(changed, entry.path());
            ASSERT_EQ(problems.size(), 1u) << entry.path() << "\n" << lines[i] << "\n" << all_of(problems);
            EXPECT_EQ(problems[0].where.line, static_cast<int>(i) + 1) << all_of(problems);
            ++damaged;
        }
    }
    EXPECT_GT(damaged, 300);
}

TEST(ConfigurationProblems, AMisspeltKeyIsToldAtItsPlace) {
    for (const char* name : {"demo.toml", "decentred.toml", "ideal_lenses.toml"}) {
        const auto file = std::filesystem::path(VKFV_SOURCE_DIR) / "assets" / "stacks" / name;
        const auto lines = lines_of(file);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const auto value = value_in(lines[i]);
            // Without its kind a table's other keys may belong to none.
            if (!value || lines[i].starts_with("kind")) {
                continue;
            }
            auto changed = lines;
            std::swap(changed[i][1], changed[i][2]);
            if (changed[i] == lines[i] || *value < 6) {
                continue;
            }
            const auto problems = problems_of(changed, file);
            ASSERT_EQ(problems.size(), 1u) << name << "\n" << changed[i] << "\n" << all_of(problems);
            EXPECT_EQ(problems[0].where.line, static_cast<int>(i) + 1) << all_of(problems);
            EXPECT_NE(problems[0].remedy.find(lines[i].substr(0, *value - 3)), std::string::npos) << all_of(problems);
        }
    }
}

} // namespace
} // namespace vkfv::test
