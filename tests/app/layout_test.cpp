// vkfv layout draws the instrument, through the real program.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vkfv::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string demo = VKFV_SOURCE_DIR "/assets/stacks/demo.toml";

TEST(LayoutCommand, WritesAPictureThatItsNameHeads) {
    const auto folder = fresh_folder("layout");
    const auto result = run_program({"--layout", demo, "demo.svg"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_EQ(result.standard_output, "");
    const auto text = read_file(folder / "demo.svg");
    EXPECT_THAT(text, StartsWith("<svg "));
    EXPECT_THAT(text, HasSubstr("<title>demo: 10x, NA 0.277, 587.6 nm"));
}

TEST(LayoutCommand, SaysWhatCannotBeWritten) {
    const auto folder = fresh_folder("layout_unwritable");
    const auto result = run_program({"--layout", demo, "missing/demo.svg"}, folder);
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_THAT(result.standard_error, HasSubstr("missing/demo.svg: cannot be written"));
    EXPECT_THAT(result.standard_error, HasSubstr("Check the path"));
}

} // namespace
} // namespace vkfv::test
