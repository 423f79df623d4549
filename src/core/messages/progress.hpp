// The progress of a run of many images: one line that is renewed on a terminal, plain lines elsewhere.
#pragma once

#include "core/messages/heartbeat.hpp"
#include "core/messages/log.hpp"

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <iosfwd>
#include <mutex>
#include <optional>
#include <string>

namespace vkfv {

// Reports one job at a time: begin, advance after each image, end. During a job, heartbeats are output in the same
// style; a quiet one leaves them to the log, so that it serves one of several jobs at once.
class Progress {
  public:
    enum class Style {
        quiet, // no output
        lines, // a line at most every two seconds, and one at the end, for log files
        json,  // core/messages/log.hpp: a line at the beginning, for each image and at the end
        bar,   // a line of at most 79 characters, renewed at most ten times a second, for terminals
    };
    using Clock = std::function<std::chrono::steady_clock::time_point()>;

    // The stream must outlive the object.
    Progress(std::ostream& stream, Style style, Clock clock = std::chrono::steady_clock::now);
    // Reports on standard error: as JSON if the log is JSON, as a bar on a terminal, else as lines.
    static Progress on_standard_error(bool quiet);
    ~Progress(); // ends an open bar's line, so that an error message starts on its own

    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Starts a job. `done` of `total` images exist already; they count neither in the rate nor in the time left.
    void begin(int total, int done);
    // Reports one more image, for which `rays` were launched. fields: further members of its JSON line.
    void advance(std::uint64_t rays, const LogFields& fields = {});
    // Reports the time of the job. Does nothing for a job without any advance().
    void end();
    // Outputs a heartbeat: the images done, the share of all work done, and the time left.
    void beat(const HeartbeatState& state);

  private:
    struct Mark {
        std::chrono::steady_clock::time_point time;
        std::uint64_t rays;
        int images;
    };

    void leave_heartbeats_to_the_log();
    double rays_per_second() const; // over the window
    double seconds_left() const;
    std::string figures() const; // for example "8.1 Mray/s  1:07 left"
    void tell(const char* event, const LogFields& fields);
    void show(const std::string& text, bool last);

    std::mutex mutex_; // guards the members below
    std::ostream* stream_;
    Style style_;
    Clock clock_;
    int total_ = 0;
    int done_ = 0;
    bool line_open_ = false;
    std::deque<Mark> window_; // marks over which the rate is taken, oldest first
    std::chrono::steady_clock::time_point started_{};
    std::optional<std::chrono::steady_clock::time_point> shown_; // time of the last output
    std::uint64_t rays_ = 0;
};

// A duration such as "0:07", "1:07", "2:03:04": hours only if there are any; rounded up to whole seconds.
std::string duration_text(double seconds);

// A rate such as "8.1 Mray/s": prefixes by powers of a thousand, at least two significant digits. Negative or
// non-finite: "- ray/s".
std::string ray_rate_text(double rays_per_second);

} // namespace vkfv
