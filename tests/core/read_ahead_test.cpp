#include "core/threads/read_ahead.hpp"

#include <gtest/gtest.h>

#include <latch>
#include <stdexcept>
#include <utility>
#include <vector>

namespace vkfv {
namespace {

TEST(ReadAhead, ItemsAreUsedInTheirOrder) {
    std::vector<std::pair<int, int>> used;
    read_ahead(
        20, [](int k) { return 7 * k; }, [&](int k, int item) { used.emplace_back(k, item); });
    ASSERT_EQ(used.size(), 20u);
    for (int k = 0; k < 20; ++k) {
        EXPECT_EQ(used[static_cast<std::size_t>(k)], std::pair(k, 7 * k));
    }
    read_ahead(
        0, [](int k) { return k; }, [](int, int) { FAIL() << "there is no item"; });
}

TEST(ReadAhead, TheNextItemIsReadWhileOneIsUsed) {
    std::latch second_read(1); // the first is used until the second is read: no other order ends
    read_ahead(
        2,
        [&](int k) {
            if (k == 1) {
                second_read.count_down();
            }
            return k;
        },
        [&](int k, int) {
            if (k == 0) {
                second_read.wait();
            }
        });
}

TEST(ReadAhead, AnExceptionEndsTheSeries) {
    std::vector<int> used;
    const auto use = [&](int k, int) { used.push_back(k); };
    const auto read = [](int k) { return k == 3 ? throw std::runtime_error("unreadable") : k; };
    EXPECT_THROW(read_ahead(9, read, use), std::runtime_error);
    EXPECT_EQ(used, (std::vector<int>{0, 1, 2}));
    const auto refuse = [](int k, int) {
        if (k == 2) {
            throw std::runtime_error("another size");
        }
    };
    EXPECT_THROW(read_ahead(
                     9, [](int k) { return k; }, refuse),
                 std::runtime_error);
}

} // namespace
} // namespace vkfv
