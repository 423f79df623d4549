#include "core/messages/heartbeat.hpp"

#include "core/messages/log.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/stages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <sstream>
#include <thread>
#include <vector>

using testing::HasSubstr;
using testing::MatchesRegex;
using vkfv::CountedWork;
using vkfv::Heartbeat;
using vkfv::HeartbeatState;

namespace {

using namespace std::chrono_literals;

// Collects the states that are told until there are so many.
class Listener {
  public:
    Listener() {
        vkfv::tell_heartbeats_by([this](const HeartbeatState& state) {
            const std::scoped_lock lock(mutex_);
            states_.push_back(state);
            more_.notify_all();
        });
    }
    ~Listener() { vkfv::tell_heartbeats_by({}); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    HeartbeatState next() {
        std::unique_lock lock(mutex_);
        const std::size_t before = states_.size();
        EXPECT_TRUE(more_.wait_for(lock, 60s, [&] { return states_.size() > before; }));
        return states_.back();
    }

  private:
    std::mutex mutex_;
    std::condition_variable more_;
    std::vector<HeartbeatState> states_;
};

// Several quiet jobs at once would else take the heartbeats from each other and from the log.
TEST(Heartbeat, IsNotTakenByAQuietJob) {
    Listener listener;
    std::ostringstream stream;
    vkfv::Progress quiet(stream, vkfv::Progress::Style::quiet);
    quiet.begin(3, 0);
    const Heartbeat heartbeat(5ms);
    listener.next();
    quiet.end();
    listener.next();
    EXPECT_EQ(stream.str(), "");
}

TEST(Heartbeat, TellsTheStageOfWorkThatNobodyCounts) {
    vkfv::enter_stage("specimen of this test");
    Listener listener;
    const Heartbeat heartbeat(5ms);
    const auto state = listener.next();
    EXPECT_EQ(state.stage, "specimen of this test");
    EXPECT_EQ(state.share, 0);
    EXPECT_THAT(state.text(), MatchesRegex("specimen of this test: at work for 0:.*"));
}

TEST(Heartbeat, TellsShareAndTimeLeftOfCountedWork) {
    vkfv::enter_stage("images");
    const CountedWork two_images(2);
    vkfv::advance_work(0.5);
    {
        const vkfv::PartOfWork of_four_lights(0.25);
        vkfv::advance_work(1); // a quarter
    }
    const CountedWork within(1); // counts nothing, and ends nothing
    Listener listener;
    const Heartbeat heartbeat(5ms);
    const auto state = listener.next();
    EXPECT_DOUBLE_EQ(state.share, 0.375);
    EXPECT_NEAR(state.seconds_left, state.seconds * 0.625 / 0.375, 1e-9 + 1e-9 * state.seconds_left);
    EXPECT_EQ((HeartbeatState{.stage = "images", .seconds = 20, .share = 0.12, .seconds_left = 146.7}.text()),
              "images: 12 % done in 0:20, about 2:27 left");
}

// The speed is that of the work that is done, not of finding out what was done before.
TEST(Heartbeat, TimeOfWorkThatWasDoneBeforeDoesNotCount) {
    vkfv::enter_stage("images");
    const CountedWork three_images(3);
    std::this_thread::sleep_for(200ms);
    vkfv::leave_out_work(1);
    vkfv::advance_work(1);
    Listener listener;
    const Heartbeat heartbeat(5ms);
    const auto state = listener.next();
    EXPECT_DOUBLE_EQ(state.share, 0.5);
    EXPECT_LT(state.seconds_left, 0.15);
}

TEST(Heartbeat, WorkThatHasEndedIsNoLongerTold) {
    {
        const CountedWork work(1);
        vkfv::advance_work(0.5);
    }
    Listener listener;
    const Heartbeat heartbeat(5ms);
    EXPECT_EQ(listener.next().share, 0);
}

TEST(Heartbeat, IsSilentWhileOthersSpeak) {
    std::atomic<int> beats = 0;
    vkfv::tell_heartbeats_by([&](const HeartbeatState&) { ++beats; });
    {
        const Heartbeat heartbeat(2s);
        for (int k = 0; k < 30; ++k) {
            vkfv::note_that_something_was_said();
            std::this_thread::sleep_for(10ms);
        }
    }
    vkfv::tell_heartbeats_by({});
    EXPECT_EQ(beats, 0);
}

TEST(Heartbeat, WarnsOnceBeforeHours) {
    const vkfv::MessagesHeard heard;
    {
        const CountedWork work(1);
        vkfv::advance_work(1e-9);
        Listener listener;
        const Heartbeat heartbeat(5ms);
        listener.next();
        listener.next();
        listener.next();
    }
    const auto messages = heard.messages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages.front().level, spdlog::level::warn);
    EXPECT_THAT(messages.front().text, HasSubstr("are left at this speed"));
}

TEST(Heartbeat, WarnsBeforeHoursAlsoWhileOthersSpeak) {
    const vkfv::MessagesHeard heard;
    {
        const CountedWork work(1);
        vkfv::advance_work(1e-9);
        const Heartbeat heartbeat(50ms);
        for (int k = 0; k < 30 && heard.messages().empty(); ++k) {
            vkfv::note_that_something_was_said();
            std::this_thread::sleep_for(10ms);
        }
    }
    const auto messages = heard.messages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_THAT(messages.front().text, HasSubstr("are left at this speed"));
}

TEST(Heartbeat, WorkThatIsDoneAlreadyIsLeftOut) {
    const CountedWork work(4);
    vkfv::advance_work(1);
    vkfv::leave_out_work(2);
    Listener listener;
    const Heartbeat heartbeat(5ms);
    EXPECT_DOUBLE_EQ(listener.next().share, 0.5);
}

TEST(Heartbeat, IsTheProgressOfAStackWhereThereIsOne) {
    std::ostringstream stream;
    vkfv::Progress progress(stream, vkfv::Progress::Style::lines);
    progress.begin(7, 2);
    progress.beat({.stage = "images", .seconds = 20, .share = 0.01, .seconds_left = 1980});
    progress.beat({.stage = "images", .seconds = 20});
    EXPECT_EQ(stream.str(), "images 2/7 stored before\nimages 2/7  1 % of the work  33:00 left\n"
                            "images 2/7  at work for 0:20\n");
}

} // namespace
