#include "core/messages/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <vector>

using testing::ElementsAre;
using testing::HasSubstr;
using vkfv::Progress;

namespace {

using namespace std::chrono_literals;
using Duration = std::chrono::steady_clock::duration;

// A job of `total` images of 8'100'000 rays, one each `each`, on a clock of its own.
std::string report(Progress::Style style, int total, int done, Duration each) {
    std::ostringstream stream;
    std::chrono::steady_clock::time_point now{};
    Progress progress(stream, style, [&now] { return now; });
    progress.begin(total, done);
    for (int image = done; image < total; ++image) {
        now += each;
        progress.advance(8'100'000);
    }
    progress.end();
    return stream.str();
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) {
        parts.push_back(part);
    }
    return parts;
}

TEST(Progress, PlainLinesTellImagesRateAndTimeLeft) {
    EXPECT_THAT(split(report(Progress::Style::lines, 4, 0, 30s), '\n'),
                ElementsAre("images 1/4  270.0 kray/s  1:30 left", "images 2/4  270.0 kray/s  1:00 left",
                            "images 3/4  270.0 kray/s  0:30 left", "images 4/4  270.0 kray/s  2:00 in all"));
}

TEST(Progress, PlainLinesComeAtMostEveryTwoSeconds) {
    // In 10 s, 100 images are told of at 0.1 s, then each time two seconds have passed (2.1, 4.1, 6.1, 8.1), and at the
    // end.
    EXPECT_EQ(split(report(Progress::Style::lines, 100, 0, 100ms), '\n').size(), 6u);
}

TEST(Progress, ImagesOfAnEarlierRunEnterNoRate) {
    EXPECT_THAT(split(report(Progress::Style::lines, 12, 10, 1s), '\n'),
                ElementsAre("images 10/12 stored before", "images 11/12  8.1 Mray/s  0:01 left",
                            "images 12/12  8.1 Mray/s  0:02 in all"));
}

TEST(Progress, TheRateFollowsAChangeWithinTheWindow) {
    std::ostringstream stream;
    std::chrono::steady_clock::time_point now{};
    Progress progress(stream, Progress::Style::lines, [&now] { return now; });
    progress.begin(200, 0);
    for (int image = 0; image < 150; ++image) {
        now += image < 100 ? 10s : 2s;
        progress.advance(2'000'000);
    }
    // A mean over the whole run would say 0.27 Mray/s and 6:07.
    EXPECT_THAT(split(stream.str(), '\n').back(), "images 150/200  1.0 Mray/s  1:40 left");
}

TEST(Progress, ABarRenewsOneLineOfATerminal) {
    const std::string text = report(Progress::Style::bar, 4, 0, 30s);
    EXPECT_EQ(text.find('\n'), text.size() - 1);
    const auto updates = split(text.substr(0, text.size() - 1), '\r');
    ASSERT_EQ(updates.size(), 6u); // nothing before the first return, the start, four images
    for (std::size_t i = 1; i < updates.size(); ++i) {
        EXPECT_EQ(updates[i].size(), 79u);
    }
    EXPECT_THAT(updates[1], HasSubstr("[........................] images 0/4 "));
    EXPECT_THAT(updates[3], HasSubstr("[############............] images 2/4  270.0 kray/s  1:00 left"));
    EXPECT_THAT(updates[5], HasSubstr("[########################] images 4/4  270.0 kray/s  2:00 in all"));
}

TEST(Progress, ABarIsRenewedAtMostTenTimesASecond) {
    const std::string text = report(Progress::Style::bar, 1001, 0, 1ms);
    // The run of 1.001 s has a return at its start, ten at intervals of 100 ms and a last one at its end, but not one
    // an image.
    EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 12);
}

TEST(Progress, AnUnfinishedBarLeavesItsLine) {
    std::ostringstream stream;
    {
        Progress progress(stream, Progress::Style::bar);
        progress.begin(3, 0);
    }
    EXPECT_EQ(stream.str().back(), '\n');
}

TEST(Progress, QuietIsSilentAndSoIsAFinishedStack) {
    EXPECT_EQ(report(Progress::Style::quiet, 4, 0, 1s), "");
    EXPECT_EQ(report(Progress::Style::bar, 4, 4, 1s), "");
    EXPECT_EQ(report(Progress::Style::lines, 4, 4, 1s), "images 4/4 stored before\n");
}

TEST(Progress, NumbersReadWell) {
    EXPECT_EQ(vkfv::duration_text(0), "0:00");
    EXPECT_EQ(vkfv::duration_text(66.2), "1:07");
    EXPECT_EQ(vkfv::duration_text(7384), "2:03:04");
    EXPECT_EQ(vkfv::ray_rate_text(8.14e6), "8.1 Mray/s");
    EXPECT_EQ(vkfv::ray_rate_text(999.96), "1.0 kray/s");
    EXPECT_EQ(vkfv::ray_rate_text(2.5e12), "2500.0 Gray/s");
    EXPECT_EQ(vkfv::ray_rate_text(std::numeric_limits<double>::infinity()), "- ray/s");
}

} // namespace
