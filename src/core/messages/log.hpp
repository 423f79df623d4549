// The program's output on standard error: lines for people, or one JSON object a line for programs.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace vkfv {

// Opens the program's log, as lines for people.
void open_log();

// Colours of the log for people. Automatic: on a terminal that has them, unless the environment's NO_COLOR is set to
// anything (no-color.org).
enum class LogColours { automatic, always, never };
void colour_log(LogColours colours);

// Switches to JSON: each line is an object with "time" (ISO 8601, UTC) and "level" or "event": messages of the log with
// "text", and the events of core/messages/progress.hpp. Interruptions are lines of JSON too, without a time, which a
// signal handler cannot format.
void log_as_json();
bool logs_json();

// Collects the log's messages, of all threads, during the object's life; they are also output as usual.
class MessagesHeard {
  public:
    struct Message {
        int level; // spdlog's level
        std::string text;
    };
    // Construction and destruction must not run while another thread writes to the log.
    MessagesHeard();
    ~MessagesHeard();
    MessagesHeard(const MessagesHeard&) = delete;
    MessagesHeard& operator=(const MessagesHeard&) = delete;
    MessagesHeard(MessagesHeard&&) = delete;
    MessagesHeard& operator=(MessagesHeard&&) = delete;

    std::vector<Message> messages() const;

  private:
    struct Ear;
    std::shared_ptr<Ear> ear_;
};

using LogValue = std::variant<std::int64_t, double, std::string>;
using LogFields = std::vector<std::pair<std::string, LogValue>>;

// A line of JSON without its line end; values that are not finite become null.
std::string json_line(std::string_view kind, std::string_view name, const LogFields& fields);

// Outputs a line with "event" on standard error if the log is JSON.
void log_event(std::string_view name, const LogFields& fields);

// A text as a JSON string with its quotes.
std::string json_quoted(std::string_view text);

// Outputs the message with which a program ends, and its exit code.
void log_failure(const std::string& message, int exit_code);

} // namespace vkfv
