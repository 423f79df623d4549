#include "bench/bench.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace vkfv::bench {

namespace {

// Standard output of a program that ended well; its standard error goes where ours does.
std::string output_of(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (auto& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) {
        throw RunError(fmt::format("no pipe to {}: {}", words[0], std::strerror(errno)));
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    pid_t process = 0;
    const int failure = posix_spawn(&process, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::string output;
    if (failure == 0) {
        std::array<char, 4096> chunk{};
        ssize_t count = 0;
        while ((count = read(ends[0], chunk.data(), chunk.size())) > 0 || (count < 0 && errno == EINTR)) {
            output.append(chunk.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        }
    }
    close(ends[0]);
    if (failure != 0) {
        throw RunError(fmt::format("{} does not start: {}", words[0], std::strerror(failure)));
    }
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        throw RunError(fmt::format("{} failed", words[0]));
    }
    return output;
}

} // namespace

Json run_peer(const std::filesystem::path& program, const std::filesystem::path& configuration,
              const std::vector<TomlOverride>& overrides, const std::vector<std::string>& arguments) {
    std::vector<std::string> words = {program.string(), configuration.string(), "--json"};
    for (const auto& override : overrides) {
        words.insert(words.end(), {"--set", override.key + "=" + override.value});
    }
    words.insert(words.end(), arguments.begin(), arguments.end());
    const auto report = Json::parse(output_of(words), nullptr, false);
    if (report.is_discarded()) {
        throw RunError(fmt::format("{} gives no JSON", program.string()));
    }
    return report;
}

} // namespace vkfv::bench
