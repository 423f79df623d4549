#include "core/messages/log.hpp"

#include "core/messages/heartbeat.hpp"
#include "core/messages/interruption.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"

#include <fmt/chrono.h>
#include <nlohmann/json.hpp>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

namespace vkfv {

namespace {

using Json = nlohmann::ordered_json;

bool lines_as_json = false;

std::string now_text() {
    const auto now = std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
    const auto milliseconds = now.time_since_epoch().count() % 1000;
    return fmt::format("{:%FT%T}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(now)), milliseconds);
}

class JsonFormatter final : public spdlog::formatter {
  public:
    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
        const auto level = spdlog::level::to_string_view(message.level);
        const std::string text = json_line("level", {level.data(), level.size()},
                                           {{"text", std::string(message.payload.data(), message.payload.size())}}) +
                                 "\n";
        line.append(text.data(), text.data() + text.size());
    }
    std::unique_ptr<formatter> clone() const override { return std::make_unique<JsonFormatter>(); }
};

// A flag of spdlog's pattern for the message made safe. The colours around it, which are control characters too, come
// from the sink and are not affected. Further lines of a message are indented, so that a name with an end of line in it
// cannot pass for a message of its own.
class SafeMessage final : public spdlog::custom_flag_formatter {
    static constexpr std::string_view indent = "  ";

  public:
    void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& line) override {
        for (const char character : safe_text({message.payload.data(), message.payload.size()})) {
            line.push_back(character);
            if (character == '\n') {
                line.append(indent.data(), indent.data() + indent.size());
            }
        }
    }
    std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<SafeMessage>(); }
};

// A sink that postpones the next heartbeat by a whole interval after each message of the log.
class HeartbeatDelay final : public spdlog::sinks::base_sink<std::mutex> {
    void sink_it_(const spdlog::details::log_msg&) override { note_that_something_was_said(); }
    void flush_() override {}
};

} // namespace

struct MessagesHeard::Ear final : spdlog::sinks::base_sink<std::mutex> {
    std::vector<Message> messages;

    std::vector<Message> heard() {
        const std::scoped_lock lock(mutex_);
        return messages;
    }

  private:
    void sink_it_(const spdlog::details::log_msg& message) override {
        messages.push_back({static_cast<int>(message.level), {message.payload.data(), message.payload.size()}});
    }
    void flush_() override {}
};

MessagesHeard::MessagesHeard() : ear_(std::make_shared<Ear>()) {
    spdlog::default_logger()->sinks().push_back(ear_);
}

MessagesHeard::~MessagesHeard() {
    std::erase(spdlog::default_logger()->sinks(), ear_);
}

std::vector<MessagesHeard::Message> MessagesHeard::messages() const {
    return ear_->heard();
}

void open_log() {
    spdlog::set_default_logger(spdlog::stderr_color_mt("vkfv"));
    spdlog::default_logger()->sinks().push_back(std::make_shared<HeartbeatDelay>());
    colour_log(LogColours::automatic);
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<SafeMessage>('*').set_pattern("%^%l%$: %*");
    spdlog::set_formatter(std::move(formatter));
}

void colour_log(LogColours colours) {
    const char* const no_colour = std::getenv("NO_COLOR");
    const bool unwanted = no_colour != nullptr && *no_colour != '\0';
    const auto mode = colours == LogColours::always              ? spdlog::color_mode::always
                      : colours == LogColours::never || unwanted ? spdlog::color_mode::never
                                                                 : spdlog::color_mode::automatic;
    for (const auto& sink : spdlog::default_logger()->sinks()) {
        if (auto* coloured = dynamic_cast<spdlog::sinks::stderr_color_sink_mt*>(sink.get())) {
            coloured->set_color_mode(mode);
        }
    }
}

void log_as_json() {
    lines_as_json = true;
    spdlog::set_formatter(std::make_unique<JsonFormatter>());
    interruptions_as_json();
}

bool logs_json() {
    return lines_as_json;
}

std::string json_line(std::string_view kind, std::string_view name, const LogFields& fields) {
    Json line = {{"time", now_text()}, {kind, name}};
    for (const auto& [key, value] : fields) {
        std::visit([&, &key = key](const auto& one) { line[key] = one; }, value);
    }
    return json_text(line, JsonLayout::one_line);
}

void log_event(std::string_view name, const LogFields& fields) {
    if (lines_as_json) {
        note_that_something_was_said();
        std::fputs((json_line("event", name, fields) + "\n").c_str(), stderr);
    }
}

std::string json_quoted(std::string_view text) {
    return json_text(Json(text), JsonLayout::one_line);
}

void log_failure(const std::string& message, int exit_code) {
    if (lines_as_json) {
        std::fputs(
            (json_line("level", "error", {{"text", message}, {"exit_code", std::int64_t{exit_code}}}) + "\n").c_str(),
            stderr);
    } else {
        std::fputs(("vkfv: " + safe_text(message) + "\n").c_str(), stderr);
    }
}

} // namespace vkfv
