#include "core/messages/interruption.hpp"

#include "core/messages/log.hpp"
#include "core/messages/safe_text.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <string>
#include <string_view>

namespace vkfv {

namespace {

constexpr std::size_t most_bytes = 500;

struct Sentence {
    std::array<char, 6 * most_bytes + 2> text; // a byte takes up to six when it is escaped
    std::size_t bytes;
};

// Two buffers: a handler may read one while the other is written. A third change during its few microseconds would only
// garble the text.
std::array<Sentence, 2> sentences{};
std::atomic<std::size_t> at_hand{0};
std::atomic<bool> as_json{false};
static_assert(std::atomic<std::size_t>::is_always_lock_free, "a signal handler may not wait");

// Writes to standard error with functions that POSIX allows in a signal handler.
void say(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
        if (written <= 0) {
            return;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

constexpr std::string_view first_sentence = "Give the same command again.";

// A signal by which a user, a scheduler or a limit ends a program.
struct Signal {
    int number;
    std::string_view name;
};
constexpr std::array signals = {
    Signal{SIGINT, "SIGINT"},       Signal{SIGTERM, "SIGTERM"}, Signal{SIGHUP, "SIGHUP"},   Signal{SIGQUIT, "SIGQUIT"},
    Signal{SIGXCPU, "SIGXCPU"},     Signal{SIGUSR1, "SIGUSR1"}, Signal{SIGUSR2, "SIGUSR2"}, Signal{SIGALRM, "SIGALRM"},
    Signal{SIGVTALRM, "SIGVTALRM"}, Signal{SIGPROF, "SIGPROF"}, Signal{SIGPOLL, "SIGPOLL"}, Signal{SIGPWR, "SIGPWR"},
    Signal{SIGSTKFLT, "SIGSTKFLT"}};

// Signals that a fault of the program raises, or of a driver in it.
constexpr std::array faults = {Signal{SIGSEGV, "SIGSEGV"}, Signal{SIGBUS, "SIGBUS"},   Signal{SIGFPE, "SIGFPE"},
                               Signal{SIGILL, "SIGILL"},   Signal{SIGABRT, "SIGABRT"}, Signal{SIGSYS, "SIGSYS"},
                               Signal{SIGTRAP, "SIGTRAP"}};

// The stack of the handlers, for a fault that has used up the main thread's own.
constexpr std::size_t handler_stack_bytes = 1 << 16;
alignas(16) std::array<char, handler_stack_bytes> handler_stack;

std::string_view name_of(int signal) {
    const auto known = std::ranges::find(signals, signal, &Signal::number);
    const auto fault = std::ranges::find(faults, signal, &Signal::number);
    return known != signals.end() ? known->name : fault != faults.end() ? fault->name : "a signal";
}

extern "C" void on_fault(int signal) {
    say(as_json ? "{\"level\":\"error\",\"signal\":\"" : "\nvkfv: ended by ");
    say(name_of(signal));
    say(as_json ? "\",\"text\":\"" : ". ");
    say("This is a fault of the program, or of the device's driver: report it with the command line and the "
        "configuration. What a stack has stored is kept.");
    say(as_json ? "\"}\n" : "\n");
    ::raise(signal); // the handler has been reset to the default
}

extern "C" void on_interruption(int signal) {
    const std::string_view name = name_of(signal);
    const Sentence& sentence = sentences[at_hand.load()];
    say(as_json ? "{\"level\":\"error\",\"signal\":\"" : "\nvkfv: ended by ");
    say(name);
    say(as_json ? "\",\"text\":" : ". ");
    say({sentence.text.data(), sentence.bytes});
    say(as_json ? "}\n" : "\n");
    ::raise(signal); // the handler has been reset to the default
}

} // namespace

void explain_interruptions() {
    say_when_interrupted(first_sentence);
    // With SIGXFSZ ignored, a write beyond a file size limit fails with EFBIG, and is reported as other failed writes
    // are.
    std::signal(SIGXFSZ, SIG_IGN);
    for (const auto& [signal, name] : signals) {
        struct sigaction before {};
        if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) {
            continue;
        }
        struct sigaction action {};
        action.sa_handler = on_interruption;
        action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_NODEFER;
        ::sigaction(signal, &action, nullptr);
    }
    for (const auto& [signal, name] : faults) {
        struct sigaction before {};
        if (::sigaction(signal, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) {
            continue; // a sanitizer has its own words, and its own stack for them
        }
        if (signal == SIGSEGV) {
            const stack_t stack = {.ss_sp = handler_stack.data(), .ss_flags = 0, .ss_size = handler_stack.size()};
            ::sigaltstack(&stack, nullptr);
        }
        struct sigaction action {};
        action.sa_handler = on_fault;
        action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_NODEFER | SA_ONSTACK;
        ::sigaction(signal, &action, nullptr);
    }
}

void interruptions_as_json() {
    as_json = true;
    say_when_interrupted(first_sentence);
}

void say_when_interrupted(std::string_view sentence) {
    sentence = sentence.substr(0, most_bytes);
    const std::string quoted = as_json ? json_quoted(sentence) : safe_line(sentence);
    const std::size_t next = 1 - at_hand.load();
    Sentence& into = sentences[next];
    into.bytes = std::min(quoted.size(), into.text.size());
    std::copy_n(quoted.begin(), into.bytes, into.text.begin());
    at_hand.store(next);
}

} // namespace vkfv
