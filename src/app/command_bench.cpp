#include "app/commands.hpp"
#include "bench/bench.hpp"
#include "core/result_folder.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

namespace vkfv::app {

void run_bench(const CommandOptions& options) {
    std::optional<ResultFolder> results;
    if (options.out) {
        results.emplace(*options.out);
    }
    const auto write_files = [&](const bench::Json& so_far) {
        if (results) {
            results->write("bench.json", so_far.dump(2) + "\n");
            results->write("bench.svg", bench::bench_picture(so_far));
            results->write_checksums();
        }
    };
    const bench::Json report = bench::measure_bench({.file = options.file,
                                                     .overrides = options.overrides,
                                                     .runs = options.runs,
                                                     .parts = options.bench_parts,
                                                     .quick = options.quick,
                                                     .peer = options.peer,
                                                     .commit = options.commit},
                                                    write_files);
    write_files(report);
    fmt::print("{}", options.json ? report.dump(2) + "\n" : bench::bench_text(report));
}

} // namespace vkfv::app
