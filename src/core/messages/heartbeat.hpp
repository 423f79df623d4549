// A word at least every ten seconds from a program that is at work, with a forecast where its work is counted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace vkfv {

// Work that is counted while it is done, from construction to destruction. One at a time: while one is under way,
// others count nothing.
class CountedWork {
  public:
    // total: what advance_work() will have counted at the end; images, and parts of an image.
    explicit CountedWork(double total);
    ~CountedWork();
    CountedWork(const CountedWork&) = delete;
    CountedWork& operator=(const CountedWork&) = delete;

  private:
    bool counts_;
};

// So much of the work under way is done, in any thread.
void advance_work(double done);

// While it lives, advance_work() counts only this share of what it is told: for a loop over equal parts of something
// that is counted as one.
class PartOfWork {
  public:
    explicit PartOfWork(double share);
    ~PartOfWork();
    PartOfWork(const PartOfWork&) = delete;
    PartOfWork& operator=(const PartOfWork&) = delete;

  private:
    double before_;
};

// A heartbeat tells the stage of the main thread (core/messages/stages.hpp), how long it has lasted, and how much of
// the counted work is done.
struct HeartbeatState {
    std::string stage;
    double seconds = 0;      // in the stage, or since the counted work began
    double share = 0;        // of the counted work that is done; 0: not known
    double seconds_left = 0; // at the speed so far; where the share is known

    // "images: 12 % done in 0:20, about 2:27 left", or "specimen: at work for 0:20".
    std::string text() const;
};

// Something was said on standard error: the next heartbeat is a whole interval later.
void note_that_something_was_said();

// Who tells the heartbeats, in the heartbeat's own thread; empty: the log, which also does at first. When this returns,
// the one before tells no more.
void tell_heartbeats_by(std::function<void(const HeartbeatState&)> teller);

// The thread that listens. Where hours lie ahead of counted work it warns, once.
class Heartbeat {
  public:
    explicit Heartbeat(std::chrono::milliseconds interval = std::chrono::seconds(10));
    ~Heartbeat();
    Heartbeat(const Heartbeat&) = delete;
    Heartbeat& operator=(const Heartbeat&) = delete;

  private:
    void listen(std::chrono::milliseconds interval);

    std::mutex mutex_;
    std::condition_variable ended_;
    bool end_ = false;
    std::thread thread_;
};

} // namespace vkfv
