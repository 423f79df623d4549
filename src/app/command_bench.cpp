#include "app/commands.hpp"
#include "bench/bench.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

namespace vkfv::app {

namespace {

struct BenchOptions {
    int runs = 5;
    std::vector<std::string> parts = {"stages"};
    bool quick = false;
    std::filesystem::path peer; // path of the program vkfv_bench_peer
    std::string commit;
};

} // namespace

Command bench_command() {
    auto parts = bench::bench_parts;
    parts.emplace_back("all");
    const auto take_parts = [](CommandOptions& options, const std::vector<std::string>& names) {
        options.of<BenchOptions>().parts = std::ranges::find(names, "all") != names.end() ? bench::bench_parts : names;
    };
    const std::vector<Option> of_bench = {{.name = "--runs",
                                           .value = "N",
                                           .description = "Runs whose median counts",
                                           .target = into(&BenchOptions::runs),
                                           .fallback = "5",
                                           .range = {1, 1000}},
                                          {.name = "--bench-parts",
                                           .value = "LIST",
                                           .description = "What to measure, parted by commas",
                                           .target = Take<std::vector<std::string>>(take_parts),
                                           .fallback = "stages",
                                           .choices = parts,
                                           .list = true},
                                          {.name = "--quick",
                                           .value = "",
                                           .description = "Shorter runs and fewer sizes",
                                           .target = into(&BenchOptions::quick)},
                                          {.name = "--peer",
                                           .value = "PROGRAM",
                                           .description = "The program vkfv_bench_peer, to compare with",
                                           .target = into(&BenchOptions::peer),
                                           .file = true},
                                          {.name = "--commit",
                                           .value = "TEXT",
                                           .description = "What the report says was measured",
                                           .target = into(&BenchOptions::commit)}};
    return {.name = "bench",
            .summary = "Measure rays/s of a configuration's chain",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together(
                {configuration_options(), {out_option("Folder of bench.json and bench.svg"), json_option()}, of_bench}),
            .run = run_bench,
            .example = "vkfv bench assets/stacks/demo.toml"};
}

using bench::Json;

void run_bench(const CommandOptions& options) {
    const auto own = options.of<BenchOptions>();
    std::optional<ResultFolder> results;
    if (options.out) {
        results.emplace(*options.out);
    }
    const auto write_files = [&](const bench::Json& so_far) {
        if (results) {
            results->write("bench.json", json_text(so_far) + "\n");
            results->write("bench.svg", bench::bench_picture(so_far));
            results->write_checksums();
        }
    };
    const bench::Json report = bench::measure_bench({.file = options.file,
                                                     .overrides = options.overrides,
                                                     .runs = own.runs,
                                                     .parts = own.parts,
                                                     .quick = own.quick,
                                                     .peer = own.peer,
                                                     .commit = own.commit},
                                                    write_files);
    write_files(report);
    print_text(options.json ? json_text(report) + "\n" : bench::bench_text(report));
}

} // namespace vkfv::app
