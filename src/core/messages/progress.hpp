// How far a run of many images has come: one line that renews itself on a terminal, plain lines elsewhere.
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

// Reports one job at a time: begin, advance after each image, end. While a job goes on, heartbeats are told in the same
// way.
class Progress {
  public:
    enum class Style {
        quiet, // nothing at all
        lines, // a line at most every two seconds, and one at the end: for log files
        json,  // core/messages/log.hpp: a line at the beginning, for each image and at the end
        bar,   // one line of at most 79 characters, renewed at most ten times a second: for terminals
    };
    using Clock = std::function<std::chrono::steady_clock::time_point()>;

    // The stream must outlive the object.
    Progress(std::ostream& stream, Style style, Clock clock = std::chrono::steady_clock::now);
    // Standard error: JSON if the log is, a bar if it is a terminal, lines otherwise.
    static Progress on_standard_error(bool quiet);
    ~Progress(); // leaves an open bar's line, so that an error message starts on its own

    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // `done` of `total` images exist before the job starts; they enter neither rate nor time left.
    void begin(int total, int done);
    // One more image is done; `rays` were launched for it. fields: what JSON tells of it besides.
    void advance(std::uint64_t rays, const LogFields& fields = {});
    // Reports the time the job took. Does nothing for a job without a single advance.
    void end();
    // The images done, how much of the work of all is, and the time left.
    void beat(const HeartbeatState& state);

  private:
    struct Mark {
        std::chrono::steady_clock::time_point time;
        std::uint64_t rays;
        int images;
    };

    double rays_per_second() const; // over the window
    double seconds_left() const;
    std::string figures() const; // "8.1 Mray/s  1:07 left"
    void tell(const char* event, const LogFields& fields);
    void show(const std::string& text, bool last);

    std::mutex mutex_; // of all that follows
    std::ostream* stream_;
    Style style_;
    Clock clock_;
    int total_ = 0;
    int done_ = 0;
    bool line_open_ = false;
    std::deque<Mark> window_; // oldest first; the marks that the rate is taken over
    std::chrono::steady_clock::time_point started_{};
    std::optional<std::chrono::steady_clock::time_point> shown_; // when something was last written
    std::uint64_t rays_ = 0;
};

// "0:07", "1:07", "2:03:04": hours only where there are any; rounded up to whole seconds.
std::string duration_text(double seconds);

// "8.1 Mray/s": three steps of a thousand, two significant digits or more. Negative or non-finite: "- ray/s".
std::string ray_rate_text(double rays_per_second);

} // namespace vkfv
