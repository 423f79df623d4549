#include "bench/bench_parts.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace vkfv::bench {

namespace {

// The standard output of a program that ended well; its standard error is inherited.
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

Json beside_peer(const BenchScene& scene) {
    const std::uint64_t rays = std::min(scene.rays(), std::uint64_t{10'000'000});
    const auto tracer = scene.tracer_of(scene.configuration().trace, scene.rays());
    scene.warm_up(*tracer);
    std::vector<double> seconds, processor, ratio, processor_ratio;
    Json told;
    for (int run = 0; run < scene.options().runs; ++run) {
        spdlog::info("peer, run {} of {}", run + 1, scene.options().runs);
        told = run_peer(scene.options().peer, scene.options().file, scene.options().overrides,
                        {"--rays", fmt::format("{}", rays), "--seed", fmt::format("{}", run + 1)});
        seconds.push_back(told["seconds"][0].get<double>());
        processor.push_back(told["processor_seconds"][0].get<double>());
        const auto start = std::clock();
        const auto image = tracer->expose(in_focus, static_cast<std::uint32_t>(run));
        const double ours_per_its = static_cast<double>(image.rays) / static_cast<double>(rays);
        processor_ratio.push_back(ours_per_its * processor.back() /
                                  (static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC));
        ratio.push_back(ours_per_its * seconds.back() / image.seconds);
    }
    return {{"threads", told["threads"]},
            {"packet", told["packet"]},
            {"block", told["block"]},
            {"rays", rays},
            {"seconds", median(seconds)},
            {"spread", spread(seconds)},
            {"rays_per_second", static_cast<double>(rays) / median(seconds)},
            {"processor_seconds", median(processor)},
            {"ratio", median(ratio)},
            {"ratio_spread", spread(ratio)},
            {"processor_ratio", median(processor_ratio)}};
}

} // namespace vkfv::bench
