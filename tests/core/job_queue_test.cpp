#include "core/threads/job_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace vkfv {
namespace {

TEST(JobQueue, OneThreadDoesAllJobsInTheirOrder) {
    std::vector<int> done;
    JobQueue jobs(1, 3);
    for (int k = 0; k < 50; ++k) {
        jobs.add([&done, k] { done.push_back(k); });
    }
    jobs.finish();
    std::vector<int> expected(50);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(done, expected);
}

TEST(JobQueue, SeveralThreadsWorkAtATime) {
    std::latch all_there(3); // none ends before three have begun
    JobQueue jobs(3, 3);
    for (int k = 0; k < 3; ++k) {
        jobs.add([&] { all_there.arrive_and_wait(); });
    }
    jobs.finish();
}

TEST(JobQueue, WhoAddsWaitsForRoom) {
    std::latch may_end(1);
    std::atomic<int> added = 0;
    JobQueue jobs(1, 2);
    std::jthread giver([&] {
        for (int k = 0; k < 6; ++k) {
            jobs.add([&] { may_end.wait(); });
            ++added;
        }
    });
    while (added < 3) { // one under way, two waiting
        std::this_thread::yield();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_EQ(added, 3);
    may_end.count_down();
    giver.join();
    jobs.finish();
    EXPECT_EQ(added, 6);
}

TEST(JobQueue, WhatAJobThrowsReachesWhoAddsAndTheRestIsDropped) {
    std::atomic<int> done = 0;
    JobQueue jobs(1, 100);
    std::latch begun(1);
    std::latch may_throw(1);
    jobs.add([&] {
        begun.count_down();
        may_throw.wait();
        throw std::runtime_error("the disk is full");
    });
    begun.wait();
    jobs.add([&] { ++done; });
    may_throw.count_down();
    EXPECT_THROW(jobs.finish(), std::runtime_error);
    EXPECT_THROW(jobs.add([&] { ++done; }), std::runtime_error);
    EXPECT_EQ(done, 0);
}

TEST(JobQueue, ItsEndWaitsForTheJobUnderWayAndDropsTheOthers) {
    std::atomic<int> done = 0;
    std::latch begun(1);
    {
        JobQueue jobs(1, 10);
        jobs.add([&] {
            begun.count_down();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            ++done;
        });
        jobs.add([&] { done += 10; });
        begun.wait();
    }
    EXPECT_EQ(done, 1);
}

} // namespace
} // namespace vkfv
