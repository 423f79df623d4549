#include "core/messages/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

namespace vkfv {

namespace {

using Clock = std::chrono::steady_clock;

struct Stage {
    std::string name;
    Clock::duration time{};
};

struct Stages {
    std::mutex mutex; // guards the variables below
    std::vector<Stage> all;
    std::size_t now = 0;
    Clock::time_point since{};
    std::thread::id thread; // that enters stages

    void leave() {
        const auto time = Clock::now();
        if (!all.empty()) {
            all[now].time += time - since;
        }
        since = time;
    }
};

Stages& stages() {
    static Stages instance;
    return instance;
}

double seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

} // namespace

void enter_stage(std::string_view name) {
    Stages& known = stages();
    const std::scoped_lock lock(known.mutex);
    if (known.all.empty()) {
        known.thread = std::this_thread::get_id();
    } else if (known.thread != std::this_thread::get_id()) {
        return;
    }
    known.leave();
    const auto found = std::ranges::find(known.all, name, &Stage::name);
    known.now = static_cast<std::size_t>(found - known.all.begin());
    if (found == known.all.end()) {
        known.all.push_back({std::string(name), {}});
    }
}

std::pair<std::string, Clock::time_point> stage_now() {
    Stages& known = stages();
    const std::scoped_lock lock(known.mutex);
    return {known.all.empty() ? std::string() : known.all[known.now].name, known.since};
}

std::string stage_table() {
    Stages& known = stages();
    const std::scoped_lock lock(known.mutex);
    known.leave();
    Clock::duration sum{};
    for (const Stage& stage : known.all) {
        sum += stage.time;
    }
    std::string text = fmt::format("{:<40}{:>9}{:>9}\n", "where the time went", "s", "share");
    const auto line = [&](const std::string& name, Clock::duration time) {
        text += fmt::format("{:<40}{:>9.3f}{:>8.1f} %\n", name, seconds(time),
                            sum.count() > 0 ? 100 * seconds(time) / seconds(sum) : 0.0);
    };
    for (const Stage& stage : known.all) {
        line(stage.name, stage.time);
    }
    line("wall clock", sum);
    return text;
}

} // namespace vkfv
