#include "core/messages/progress.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

namespace vkfv {

namespace {

using namespace std::chrono_literals;

constexpr auto bar_interval = 100ms;
constexpr auto line_interval = 2s;
// The window of the rate: long enough to smooth the scheduling of a shared machine, short enough to follow a change of
// load.
constexpr auto rate_window = 30s;
constexpr int line_width = 79; // 80 characters would wrap on a terminal of 80 columns
constexpr int gauge_width = 24;

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

} // namespace

std::string duration_text(double seconds) {
    const auto whole = static_cast<long long>(std::ceil(std::max(seconds, 0.0)));
    const long long hours = whole / 3600;
    const long long minutes = whole / 60 % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                     : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string ray_rate_text(double rays_per_second) {
    if (!std::isfinite(rays_per_second) || rays_per_second < 0) {
        return "- ray/s";
    }
    constexpr std::array prefixes{"", "k", "M", "G"};
    std::size_t step = 0;
    // The limit is below 1000, as 999.95 would print as 1000.0.
    while (rays_per_second >= 999.95 && step + 1 < prefixes.size()) {
        rays_per_second /= 1000;
        ++step;
    }
    return fmt::format("{:.1f} {}ray/s", rays_per_second, prefixes[step]);
}

Progress::Progress(std::ostream& stream, Style style, Clock clock)
    : stream_(&stream), style_(style), clock_(std::move(clock)) {}

Progress Progress::on_standard_error(bool quiet) {
    const Style loud = logs_json() ? Style::json : isatty(STDERR_FILENO) == 1 ? Style::bar : Style::lines;
    return Progress(std::cerr, quiet ? Style::quiet : loud);
}

Progress::~Progress() {
    leave_heartbeats_to_the_log();
    if (line_open_) {
        *stream_ << '\n' << std::flush;
    }
}

void Progress::leave_heartbeats_to_the_log() {
    if (style_ != Style::quiet) {
        tell_heartbeats_by({});
    }
}

void Progress::begin(int total, int done) {
    if (style_ != Style::quiet) {
        tell_heartbeats_by([this](const HeartbeatState& state) { beat(state); });
    }
    const std::scoped_lock lock(mutex_);
    total_ = total;
    done_ = done;
    rays_ = 0;
    started_ = clock_();
    window_ = {{started_, 0, done}};
    shown_.reset();
    if (style_ == Style::json) {
        tell("begin", {{"images", std::int64_t{total}}, {"stored", std::int64_t{done}}});
    } else if (style_ == Style::bar && done < total) {
        show("", false);
    } else if (style_ == Style::lines && done > 0) {
        *stream_ << fmt::format("images {}/{} stored before\n", done, total) << std::flush;
    }
}

void Progress::advance(std::uint64_t rays, const LogFields& fields) {
    const std::scoped_lock lock(mutex_);
    ++done_;
    rays_ += rays;
    const auto now = clock_();
    window_.push_back({now, rays_, done_});
    while (window_.size() > 2 && now - window_.front().time > rate_window) {
        window_.pop_front();
    }
    if (style_ == Style::json) {
        LogFields all = fields;
        all.insert(all.end(), {{"done", std::int64_t{done_}},
                               {"images", std::int64_t{total_}},
                               {"rays_per_s", rays_per_second()},
                               {"seconds_left", seconds_left()}});
        tell("image", all);
        return;
    }
    const auto interval = style_ == Style::bar ? std::chrono::steady_clock::duration(bar_interval)
                                               : std::chrono::steady_clock::duration(line_interval);
    // The last image is reported by end(), with the whole run's figures.
    if (done_ < total_ && (!shown_ || now - *shown_ >= interval)) {
        show(figures(), false);
    }
}

void Progress::end() {
    leave_heartbeats_to_the_log();
    const std::scoped_lock lock(mutex_);
    if (rays_ == 0 && window_.size() <= 1) {
        return;
    }
    const double elapsed = seconds_between(started_, clock_());
    if (style_ == Style::json) {
        tell("end", {{"done", std::int64_t{done_}},
                     {"images", std::int64_t{total_}},
                     {"rays_per_s", static_cast<double>(rays_) / elapsed},
                     {"seconds", elapsed}});
        return;
    }
    show(fmt::format("{}  {} in all", ray_rate_text(static_cast<double>(rays_) / elapsed), duration_text(elapsed)),
         true);
    window_.clear();
    rays_ = 0;
}

void Progress::beat(const HeartbeatState& state) {
    const std::scoped_lock lock(mutex_);
    if (style_ == Style::json) {
        tell("at work", {{"done", std::int64_t{done_}},
                         {"images", std::int64_t{total_}},
                         {"seconds", state.seconds},
                         {"share", state.share},
                         {"seconds_left", state.seconds_left}});
    } else {
        show(state.share > 0
                 ? fmt::format("{:.2g} % of the work  {} left", 100 * state.share, duration_text(state.seconds_left))
                 : fmt::format("at work for {}", duration_text(state.seconds)),
             false);
    }
}

double Progress::rays_per_second() const {
    return static_cast<double>(window_.back().rays - window_.front().rays) /
           seconds_between(window_.front().time, window_.back().time);
}

double Progress::seconds_left() const {
    const Mark& first = window_.front();
    const Mark& last = window_.back();
    return (total_ - done_) * seconds_between(first.time, last.time) / (last.images - first.images);
}

std::string Progress::figures() const {
    return fmt::format("{}  {} left", ray_rate_text(rays_per_second()), duration_text(seconds_left()));
}

void Progress::tell(const char* event, const LogFields& fields) {
    note_that_something_was_said();
    *stream_ << json_line("event", event, fields) + "\n" << std::flush;
}

void Progress::show(const std::string& text, bool last) {
    if (style_ == Style::quiet) {
        return;
    }
    shown_ = clock_();
    note_that_something_was_said();
    std::string line = fmt::format("images {}/{}", done_, total_);
    if (!text.empty()) {
        line += "  " + text;
    }
    if (style_ == Style::lines) {
        *stream_ << line << '\n' << std::flush;
        return;
    }
    const int filled = total_ > 0 ? gauge_width * done_ / total_ : gauge_width;
    line = fmt::format("[{:.<{}}] {}", std::string(filled, '#'), gauge_width, line);
    // The line is padded to the full width, which overwrites the rest of a longer one without control sequences.
    *stream_ << fmt::format("\r{:<{}.{}}", line, line_width, line_width) << (last ? "\n" : "") << std::flush;
    line_open_ = !last;
}

} // namespace vkfv
