// The ledger of a stack is read back as it was written.
#include "scan/ledger_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace vkfv::scan {
namespace {

TEST(LedgerTable, HasTheMeanOfAllImages) {
    const std::filesystem::path folder = testing::TempDir() + "ledger_table";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "ledger.csv")
        << "image,z_um,rays,detected_rays,emitted_W,detected_W,\"beside, \"\"it\"\"_W\","
           "residual_W\n0,-1,10,3,2,0.5,1.5,0\n1,0,10,4,2,0.25,1.75,1e-17\n";
    const auto ledger = mean_ledger(folder);
    EXPECT_EQ(ledger.emitted, 2);
    ASSERT_EQ(ledger.shares.size(), 3u);
    EXPECT_EQ(ledger.shares[0].name, "detected");
    EXPECT_EQ(ledger.shares[0].power, 0.375);
    EXPECT_EQ(ledger.shares[1].name, "beside, \"it\"");
    EXPECT_EQ(ledger.shares[1].power, 1.625);
    EXPECT_EQ(ledger.shares[2].power, 5e-18);
    std::ofstream(folder / "ledger.csv", std::ios::app) << "2,1,10\n"; // cut off
    EXPECT_TRUE(mean_ledger(folder).shares.empty());
    EXPECT_TRUE(mean_ledger(folder / "none").shares.empty());
}

} // namespace
} // namespace vkfv::scan
