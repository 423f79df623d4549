// What a program says on standard error: lines for people, or a JSON object a line for programs that watch it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace vkfv {

// Opens the program's log, for people at first.
void open_log();

// Colours of the log for people. Automatic: on a terminal that has them, unless the environment's NO_COLOR is set to
// anything (no-color.org).
enum class LogColours { automatic, always, never };
void colour_log(LogColours colours);

// From now on each line is an object with "time" (ISO 8601, UTC) and "level" or "event": messages of the log with
// "text", and what core/messages/progress.hpp tells. Interruptions too, without a time, which a signal handler cannot
// tell.
void log_as_json();
bool logs_json();

// The log's messages since this was made, in whatever thread, beside where they go else.
class MessagesHeard {
  public:
    struct Message {
        int level; // spdlog's
        std::string text;
    };
    // While no other thread writes to the log; likewise where it ends.
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

// A line of JSON without its end; values that are not finite become null.
std::string json_line(std::string_view kind, std::string_view name, const LogFields& fields);

// Where the log is JSON, a line with "event" on standard error.
void log_event(std::string_view name, const LogFields& fields);

// A text as JSON has it, quotes included.
std::string json_quoted(std::string_view text);

// The message that a program ends with, with its exit code.
void log_failure(const std::string& message, int exit_code);

} // namespace vkfv
