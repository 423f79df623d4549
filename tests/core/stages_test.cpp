#include "core/messages/stages.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <sstream>
#include <thread>

namespace vkfv {
namespace {

TEST(Stages, AddUpToTheWallClock) {
    const auto start = std::chrono::steady_clock::now();
    enter_stage("first");
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    enter_stage("second");
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    enter_stage("first");
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::istringstream lines(stage_table());
    std::map<std::string, double> seconds;
    std::string line;
    std::getline(lines, line); // the heads of the columns
    while (std::getline(lines, line)) {
        std::istringstream row(line.substr(40));
        row >> seconds[line.substr(0, line.find("  "))];
    }
    EXPECT_GE(seconds.at("first"), 0.059);
    EXPECT_GE(seconds.at("second"), 0.009);
    EXPECT_NEAR(seconds.at("wall clock"), seconds.at("first") + seconds.at("second"), 2e-3);
    EXPECT_NEAR(seconds.at("wall clock"), wall, 0.02);
}

// Stacks that are measured side by side enter stages too, from threads of their own.
TEST(Stages, AreThoseOfTheThreadThatEnteredTheFirst) {
    enter_stage("of this thread");
    std::jthread([] { enter_stage("of another thread"); }).join();
    EXPECT_EQ(stage_now().first, "of this thread");
}

} // namespace
} // namespace vkfv
