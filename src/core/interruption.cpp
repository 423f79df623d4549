#include "core/interruption.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstring>

namespace vkfv {

namespace {

struct Sentence {
    std::array<char, 500> text;
    std::size_t bytes;
};

// A handler may read one while the other is written; a third change during its few microseconds would only garble the
// text.
std::array<Sentence, 2> sentences{};
std::atomic<std::size_t> at_hand{0};
static_assert(std::atomic<std::size_t>::is_always_lock_free, "a signal handler may not wait");

// Calls nothing but what POSIX allows in a handler.
void say(const char* text, std::size_t bytes) {
    while (bytes > 0) {
        const ssize_t written = ::write(STDERR_FILENO, text, bytes);
        if (written <= 0) {
            return;
        }
        text += written;
        bytes -= static_cast<std::size_t>(written);
    }
}

extern "C" void on_interruption(int signal) {
    const char* name = signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
    const Sentence& sentence = sentences[at_hand.load()];
    say("\nvkfv: ended by ", 16);
    say(name, std::strlen(name));
    say(". ", 2);
    say(sentence.text.data(), sentence.bytes);
    say("\n", 1);
    ::raise(signal); // its handler is the default again
}

} // namespace

void explain_interruptions() {
    say_when_interrupted("Give the same command again.");
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) {
            continue;
        }
        struct sigaction action {};
        action.sa_handler = on_interruption;
        action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_NODEFER;
        ::sigaction(signal, &action, nullptr);
    }
}

void say_when_interrupted(std::string_view sentence) {
    const std::size_t next = 1 - at_hand.load();
    Sentence& into = sentences[next];
    into.bytes = std::min(sentence.size(), into.text.size());
    std::copy_n(sentence.begin(), into.bytes, into.text.begin());
    at_hand.store(next);
}

} // namespace vkfv
