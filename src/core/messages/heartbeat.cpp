#include "core/messages/heartbeat.hpp"

#include "core/messages/log.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/stages.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace vkfv {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double long_wait = 3600; // s; a wait that deserves a warning

std::atomic<Clock::rep> last_said{0};
std::atomic<double> work_done{0};
std::atomic<double> share_of_parts{1};

// The state of counted work in progress, if there is any.
struct Work {
    std::mutex mutex;
    bool under_way = false;
    double total = 0;
    Clock::time_point begun{};
    bool warned = false;
};

struct Teller {
    std::mutex mutex;
    std::function<void(const HeartbeatState&)> tell;
};

Work& work() {
    static Work instance;
    return instance;
}

Teller& teller() {
    static Teller instance;
    return instance;
}

double seconds_since(Clock::time_point begun) {
    return std::chrono::duration<double>(Clock::now() - begun).count();
}

HeartbeatState state_now() {
    const auto [stage, begun] = stage_now();
    Work& counted = work();
    const std::scoped_lock lock(counted.mutex);
    const bool counts = counted.under_way && counted.total > 0;
    const double share = counts ? std::min(work_done.load() / counted.total, 1.0) : 0.0;
    if (!(share > 0)) {
        return {.stage = stage, .seconds = seconds_since(begun)};
    }
    const double seconds = seconds_since(counted.begun);
    return {.stage = stage, .seconds = seconds, .share = share, .seconds_left = seconds * (1 - share) / share};
}

void warn_of_hours(const HeartbeatState& state) {
    {
        Work& counted = work();
        const std::scoped_lock lock(counted.mutex);
        if (counted.warned || !counted.under_way || !(state.share > 0) || state.seconds_left < long_wait) {
            return;
        }
        counted.warned = true;
    }
    spdlog::warn("about {} are left at this speed. Fewer rays (trace.rays), pixels or positions take less; what is "
                 "stored when a stack is interrupted is kept, and the same command continues it",
                 duration_text(state.seconds_left));
}

void tell(const HeartbeatState& state) {
    Teller& chosen = teller();
    const std::scoped_lock lock(chosen.mutex);
    if (chosen.tell) {
        chosen.tell(state);
    } else if (logs_json()) {
        LogFields fields = {{"stage", state.stage}, {"seconds", state.seconds}};
        if (state.share > 0) {
            fields.insert(fields.end(), {{"share", state.share}, {"seconds_left", state.seconds_left}});
        }
        if (spdlog::should_log(spdlog::level::info)) {
            log_event("at work", fields);
        }
    } else {
        spdlog::info(state.text());
    }
}

} // namespace

CountedWork::CountedWork(double total) {
    Work& counted = work();
    const std::scoped_lock lock(counted.mutex);
    counts_ = !counted.under_way && total > 0;
    if (counts_) {
        counted.under_way = true;
        counted.total = total;
        counted.begun = Clock::now();
        counted.warned = false;
        work_done = 0;
    }
}

CountedWork::~CountedWork() {
    if (counts_) {
        Work& counted = work();
        const std::scoped_lock lock(counted.mutex);
        counted.under_way = false;
    }
}

void advance_work(double done) {
    work_done.fetch_add(done * share_of_parts.load(std::memory_order_relaxed), std::memory_order_relaxed);
}

void leave_out_work(double done) {
    Work& counted = work();
    const std::scoped_lock lock(counted.mutex);
    counted.total -= done;
    if (work_done.load() == 0) { // the time until now tells nothing of the speed
        counted.begun = Clock::now();
    }
}

PartOfWork::PartOfWork(double share) : before_(share_of_parts.load()) {
    share_of_parts = share * before_;
}

PartOfWork::~PartOfWork() {
    share_of_parts = before_;
}

std::string HeartbeatState::text() const {
    return share > 0 ? fmt::format("{}: {:.2g} % done in {}, about {} left", stage, 100 * share, duration_text(seconds),
                                   duration_text(seconds_left))
                     : fmt::format("{}: at work for {}", stage, duration_text(seconds));
}

void note_that_something_was_said() {
    last_said = Clock::now().time_since_epoch().count();
}

void tell_heartbeats_by(std::function<void(const HeartbeatState&)> new_teller) {
    Teller& chosen = teller();
    const std::scoped_lock lock(chosen.mutex);
    chosen.tell = std::move(new_teller);
}

Heartbeat::Heartbeat(std::chrono::milliseconds interval) {
    note_that_something_was_said();
    thread_ = std::thread([this, interval] { listen(interval); });
}

Heartbeat::~Heartbeat() {
    {
        const std::scoped_lock lock(mutex_);
        end_ = true;
    }
    ended_.notify_one();
    thread_.join();
}

void Heartbeat::listen(std::chrono::milliseconds interval) {
    std::unique_lock lock(mutex_);
    Clock::time_point next_look = Clock::now() + interval;
    while (!end_) {
        const Clock::time_point next(Clock::duration(last_said.load()) + interval);
        const Clock::time_point now = Clock::now();
        if (now < next && now < next_look) {
            ended_.wait_until(lock, std::min(next, next_look));
            continue;
        }
        const HeartbeatState state = state_now();
        if (now >= next) {
            note_that_something_was_said(); // a quiet teller would not postpone the next one
            tell(state);
        }
        warn_of_hours(state);
        next_look = now + interval;
    }
}

} // namespace vkfv
