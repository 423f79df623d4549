#include "app/commands.hpp"
#include "core/files/file.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/progress.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/evaluation/evaluation_files.hpp"
#include "measurement/stack/stack.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <optional>
#include <string>

namespace vkfv::app {

namespace {

struct StackOptions {
    std::optional<scan::Shard> shard;
};

// Reads "2/8", the second of eight shards.
void take_shard(CommandOptions& options, const std::string& text) {
    int number = 0, count = 0;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, number);
    const bool parted = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
    const auto second = parted ? std::from_chars(first.ptr + 1, end, count) : first;
    if (!parted || second.ec != std::errc() || second.ptr != end || number < 1 || number > count ||
        count > scan::most_positions) {
        refuse_argument("--shard " + text,
                        fmt::format("I/N with I from 1 to N, and N at most {}", scan::most_positions),
                        "Write for example --shard 2/8 for the second of eight.");
    }
    options.of<StackOptions>().shard = scan::Shard{number - 1, count};
}

} // namespace

Command stack_command() {
    const Option shard = {.name = "--shard",
                          .value = "I/N",
                          .description =
                              "Of N shards of the stack, trace the images of number I alone; merge evaluates",
                          .target = Take<std::string>(take_shard)};
    return {.name = "stack",
            .summary =
                "Trace a focus stack, reconstruct it and compare it with the truth; continues an interrupted one",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together({configuration_options(), {out_option("Output folder"), json_option(), shard}}),
            .run = run_stack,
            .example = "vkfv stack assets/stacks/demo.toml --out demo"};
}

void run_stack(const CommandOptions& options) {
    auto progress = Progress::on_standard_error(options.quiet);
    const auto configuration = measurement::load_stack(options.file, options.overrides);
    const auto shard = options.of<StackOptions>().shard;
    if (shard) {
        const auto traced = measurement::trace_shard(configuration, *shard, progress);
        print_text(options.json ? json_text(measurement::shard_json(traced)) + "\n" : measurement::summary(traced));
        tell_results(traced.folder);
        return;
    }
    const auto stack = measurement::measure_stack(configuration, progress);
    print_text(options.json ? read_file(stack.folder / measurement::results_name) : measurement::summary(stack));
    tell_results(stack.folder);
}

} // namespace vkfv::app
