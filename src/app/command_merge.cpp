#include "app/commands.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/stack/stack.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <vector>

namespace vkfv::app {

namespace {

struct MergeOptions {
    std::vector<std::filesystem::path> folders; // the merged stack's folder, then those of shards
};

} // namespace

Command merge_command() {
    return {.name = "merge",
            .summary = "Put the shards of a stack together and evaluate it, as one run would; needs no device",
            .operands = {{.name = "OUT [SHARD...]",
                          .description = "Folder of the whole stack, and those of shards that are elsewhere",
                          .target = into(&MergeOptions::folders),
                          .least = 1}},
            .run = run_merge,
            .example = "vkfv merge out shard-1 shard-2"};
}

void run_merge(const CommandOptions& options) {
    const auto folders = options.of<MergeOptions>().folders;
    print_text(measurement::summary(measurement::merge_stack(folders.front(), {folders.begin() + 1, folders.end()})));
}

} // namespace vkfv::app
