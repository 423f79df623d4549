// A browser shows report.html: tests/acceptance/check_report moves, drags and plays, and compares with the files
// beside.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace vkfv::test {
namespace {

// Elsewhere tools/setup installs Chromium; Ubuntu has it as a snap alone, which a user of Ubuntu may do without. In CI
// (hosts of CI set the variable of this name) a browser is always needed, so that no report goes unseen there.
bool may_lack_a_browser() {
    return std::getenv("CI") == nullptr && read_file("/etc/os-release").find("\nID=ubuntu") != std::string::npos;
}

// The checks of a report that do not hold, as text; none if there is no browser and none has to be installed.
std::optional<std::string> failures_of(const std::filesystem::path& results) {
    const auto told = results.parent_path() / "checks.txt";
    const std::string command = "python3 " VKFV_SOURCE_DIR "/tests/acceptance/check_report --seconds 30 '" +
                                results.string() + "' > '" + told.string() + "' 2>&1";
    const int status = std::system(command.c_str());
    constexpr int no_browser = 77;
    if (WIFEXITED(status) && WEXITSTATUS(status) == no_browser && may_lack_a_browser()) {
        return std::nullopt;
    }
    EXPECT_THAT(read_file(told), testing::HasSubstr("holds:"));
    return status == 0 ? "" : read_file(told);
}

TEST(Report, OfAStackWorksInABrowser) {
    const auto folder = fresh_folder("report");
    write_file(folder / "c.toml", small_configuration);
    // Every curve's peak is taken: so few rays measure nothing that chance does not.
    const auto stack = run_program({"stack", "c.toml", "--rays", "2e5", "--set", "topography.smoothing_steps=0",
                                    "--set", "topography.false_peak_rate=1", "--set", "topography.most_rival=1"},
                                   folder);
    ASSERT_EQ(stack.exit_code, 0) << stack.standard_error;
    const auto failures = failures_of(folder / "out");
    if (!failures) {
        GTEST_SKIP() << "no browser, and Ubuntu has no package of Chromium";
    }
    EXPECT_EQ(*failures, "");
}

// The numbers along the axis are so wide that not each of its ticks can have one.
TEST(Report, OfASweepWorksInABrowser) {
    const auto folder = fresh_folder("sweep_report");
    write_file(folder / "c.toml", small_configuration +
                                      "\n[sweep]\nz_um = 0.5\n[[sweep.parameter]]\nkey = \"specimen.material.g\"\n"
                                      "label = \"g\"\nvalues = [0.3, 1.0]\n[[sweep.parameter]]\n"
                                      "key = \"trace.seed\"\nlabel = \"seed\"\nvalues = [260000, 1000000, 4200000]\n");
    const auto sweep = run_program({"sweep", "c.toml", "--out", "out", "--device", "host"}, folder);
    ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
    const auto failures = failures_of(folder / "out");
    if (!failures) {
        GTEST_SKIP() << "no browser, and Ubuntu has no package of Chromium";
    }
    EXPECT_EQ(*failures, "");
}

} // namespace
} // namespace vkfv::test
