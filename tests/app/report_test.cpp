// report.html in a browser: tools/check_report moves, drags and plays, and compares with the files beside.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace vkfv::test {
namespace {

TEST(Report, WorksInABrowser) {
    const auto folder = fresh_folder("report");
    write_file(folder / "c.toml", small_configuration);
    // Every curve's peak is taken: so few rays measure nothing that chance does not.
    const auto stack = run_program({"stack", "c.toml", "--rays", "2e5", "--set", "topography.smoothing_steps=0",
                                    "--set", "topography.false_peak_rate=1", "--set", "topography.most_rival=1"},
                                   folder);
    ASSERT_EQ(stack.exit_code, 0) << stack.standard_error;
    const std::string command = "python3 " VKFV_SOURCE_DIR "/tools/check_report --seconds 30 '" +
                                (folder / "out").string() + "' > '" + (folder / "checks.txt").string() + "' 2>&1";
    const int status = std::system(command.c_str());
    constexpr int no_browser = 77;
    if (WIFEXITED(status) && WEXITSTATUS(status) == no_browser) {
        GTEST_SKIP() << "no Chromium here";
    }
    EXPECT_EQ(status, 0) << read_file(folder / "checks.txt");
    EXPECT_THAT(read_file(folder / "checks.txt"), testing::HasSubstr("holds:"));
}

} // namespace
} // namespace vkfv::test
