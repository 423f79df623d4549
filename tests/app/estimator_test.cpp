// A stack whose configuration leaves the estimator to vkfv: the folder names the one that was taken and goes on with
// it, and the report shows where light is lost, which backward paths do not tell.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class EstimatorOfAStack : public testing::Test {
  protected:
    EstimatorOfAStack() : folder_(fresh_folder("estimator")) {
        write_file(folder_ / "c.toml", replaced(small_configuration, "estimator = \"forward\"\n", "") +
                                           "[diffraction]\nmodel = \"none\"\n");
    }
    ProgramResult stack(std::vector<std::string> further) const {
        std::vector<std::string> words = {"stack", "c.toml", "--device", "host"};
        words.insert(words.end(), further.begin(), further.end());
        return run_program(words, folder_);
    }

    fs::path folder_;
};

// The ledger in the data of a report.
json ledger_of(const std::string& page) {
    const auto begin = page.find("\"ledger\":") + std::string("\"ledger\":").size();
    int depth = 0;
    auto end = begin;
    do {
        depth += page[end] == '{' ? 1 : page[end] == '}' ? -1 : 0;
        ++end;
    } while (depth > 0 && end < page.size());
    return json::parse(page.substr(begin, end - begin));
}

TEST_F(EstimatorOfAStack, IsBackwardAndItsReportShowsTheWayOfTheLight) {
    ASSERT_EQ(stack({"--out", "chosen"}).exit_code, 0);
    EXPECT_THAT(read_file(folder_ / "chosen/stack.toml"), HasSubstr("estimator = \"backward\""));
    const json ledger = ledger_of(read_file(folder_ / "chosen/report.html"));
    EXPECT_EQ(ledger["rays"], 1000);
    double sum = 0, lost_at_lenses = 0;
    for (const auto& share : ledger["shares"]) {
        const std::string name = share[0];
        EXPECT_NE(name, "not followed backward");
        sum += share[1].get<double>();
        lost_at_lenses += name.starts_with("vignetted") ? share[1].get<double>() : 0;
    }
    EXPECT_NEAR(sum / ledger["emitted"].get<double>(), 1, 1e-6);
    EXPECT_GT(lost_at_lenses, 0);
    // The same images evaluated again have the same ledger.
    ASSERT_EQ(run_program({"topography", "chosen", "--out", "again"}, folder_).exit_code, 0);
    EXPECT_EQ(ledger_of(read_file(folder_ / "again/report.html")), ledger);
}

TEST_F(EstimatorOfAStack, IsTheOneThatTheFolderWasBegunWith) {
    ASSERT_EQ(stack({"--out", "begun", "--estimator", "forward"}).exit_code, 0);
    fs::remove(folder_ / "begun/images/z_0002.tif");
    const auto continued = stack({"--out", "begun"});
    ASSERT_EQ(continued.exit_code, 0) << continued.standard_error;
    EXPECT_THAT(continued.standard_error, HasSubstr("1 images traced"));
    EXPECT_THAT(read_file(folder_ / "begun/stack.toml"), HasSubstr("estimator = \"forward\""));
    EXPECT_EQ(ledger_of(read_file(folder_ / "begun/report.html"))["rays"], 0);
    const auto refused = stack({"--out", "begun", "--estimator", "backward"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.standard_error, HasSubstr("trace.estimator"));
}

} // namespace
} // namespace vkfv::test
