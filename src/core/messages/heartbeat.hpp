// Heartbeats: a message at least every ten seconds while the program works, with a forecast if the work is counted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace vkfv {

// Work whose progress is counted, from construction to destruction. Only one counts at a time: others meanwhile have no
// effect.
class CountedWork {
  public:
    // total: the sum that advance_work() will reach at the end; it includes images and parts of an image.
    explicit CountedWork(double total);
    ~CountedWork();
    CountedWork(const CountedWork&) = delete;
    CountedWork& operator=(const CountedWork&) = delete;

  private:
    bool counts_;
};

// Adds to the progress of the counted work, from any thread.
void advance_work(double done);

// Takes work that turned out to be done already off the total of the counted work, from any thread.
void leave_out_work(double done);

// Scales the progress counted by advance_work() by this share during its life, for a loop over equal parts of a unit of
// counted work.
class PartOfWork {
  public:
    explicit PartOfWork(double share);
    ~PartOfWork();
    PartOfWork(const PartOfWork&) = delete;
    PartOfWork& operator=(const PartOfWork&) = delete;

  private:
    double before_;
};

// The content of a heartbeat: the stage of the main thread (core/messages/stages.hpp), its duration so far, and the
// progress of the counted work.
struct HeartbeatState {
    std::string stage;
    double seconds = 0;      // in the stage, or since the counted work began
    double share = 0;        // done share of the counted work; 0: not known
    double seconds_left = 0; // at the average speed so far; valid if the share is known

    // The text, such as "images: 12 % done in 0:20, about 2:27 left", or "specimen: at work for 0:20".
    std::string text() const;
};

// Postpones the next heartbeat by a whole interval, after output on standard error.
void note_that_something_was_said();

// Sets the function that outputs heartbeats, called in the heartbeat's own thread; empty: the log, which is the
// default. After the return the previous function is no longer called.
void tell_heartbeats_by(std::function<void(const HeartbeatState&)> teller);

// The thread of the heartbeat. It warns once if counted work will take hours, also where so much else is said that no
// heartbeat is due.
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
