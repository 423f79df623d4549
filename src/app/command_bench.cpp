#include "app/commands.hpp"
#include "bench/bench.hpp"
#include "core/result_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

namespace vkfv::app {

Command bench_command() {
    auto parts = bench::bench_parts;
    parts.emplace_back("all");
    const auto take_parts = [](CommandOptions& options, const std::vector<std::string>& names) {
        options.bench_parts = std::ranges::find(names, "all") != names.end() ? bench::bench_parts : names;
    };
    const std::vector<Option> of_bench = {
        {.name = "--runs",
         .value = "N",
         .description = "Runs whose median counts",
         .target = &CommandOptions::runs,
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
         .target = &CommandOptions::quick},
        {.name = "--peer",
         .value = "PROGRAM",
         .description = "The program vkfv_bench_peer, to compare with",
         .target = Take<std::string>([](CommandOptions& options, const std::string& path) { options.peer = path; }),
         .file = true},
        {.name = "--commit",
         .value = "TEXT",
         .description = "What the report says was measured",
         .target = Take<std::string>([](CommandOptions& options, const std::string& text) { options.commit = text; })}};
    return {.name = "bench",
            .summary = "Measure rays/s of a configuration's chain",
            .operands = {{"C.toml", "Configuration", &CommandOptions::file}},
            .options = together(
                {configuration_options(), {out_option("Folder of bench.json and bench.svg"), json_option()}, of_bench}),
            .run = run_bench,
            .example = "vkfv bench assets/stacks/demo.toml"};
}

using bench::Json;

namespace {

// Rates by their thousands: "3.12 G".
std::string with_prefix(double value) {
    const char* prefixes[] = {"", " k", " M", " G", " T"};
    int thousands = 0;
    while (value >= 1000 && thousands < 4) {
        value /= 1000;
        ++thousands;
    }
    return fmt::format("{:.3g}{}", value, prefixes[thousands]);
}

double number(const Json& of, const char* key) {
    return of.at(key).get<double>();
}

std::string text(const Json& of, const char* key) {
    return of.at(key).get<std::string>();
}

void print_timing(const std::string& what, const Json& timing) {
    fmt::print("  {:<34} {:>8} rays/s, {:>10.4g} s per 1e9 rays, {:>8} ray-surfaces/s, spread {:.1f} %\n", what,
               with_prefix(number(timing, "rays_per_second")), number(timing, "seconds_per_1e9_rays"),
               with_prefix(number(timing, "ray_surfaces_per_second")), 100 * number(timing, "spread"));
}

void print_stages(const Json& stages) {
    fmt::print("{}\n"
               "  rays/s                 {:.4g}  (runs of {:.3g} rays, spread {:.1f} %)\n"
               "  seconds per 1e9 rays   {:.4g}\n"
               "  surfaces per ray       {:.2f} launched, {:.2f} detected; {}ray-surfaces/s\n"
               "  share of the time     ",
               text(stages, "traversal"), number(stages, "rays_per_second"), number(stages, "rays"),
               100 * number(stages, "spread"), number(stages, "seconds_per_1e9_rays"),
               number(stages, "surfaces_per_ray"), number(stages, "surfaces_per_detected_ray"),
               with_prefix(number(stages, "ray_surfaces_per_second")) + " ");
    const char* comma = "";
    for (const auto& [name, share] : stages.at("shares").items()) {
        fmt::print("{} {} {:.1f} %", comma, name, 100 * share.get<double>());
        comma = ",";
    }
    fmt::print("\n");
}

void print_report(const Json& report) {
    const auto commit = text(report, "commit");
    fmt::print("{}{}, {}; {} ({}, {}); {:.4g} of the source's flux is aimed at, medians of {} runs\n",
               text(report, "program"), commit.empty() ? "" : " " + commit, text(report, "date"),
               text(report, "device"), text(report, "driver"), text(report, "device_type"),
               number(report, "aimed_share"), report.at("runs").get<int>());
    const auto each = [&](const Json& of, const char* list, auto&& print) {
        if (of.contains(list)) {
            fmt::print("{}\n", list);
            for (const auto& entry : of.at(list)) {
                print(entry);
            }
        }
    };
    each(report, "validation", [](const Json& check) {
        fmt::print("  {}: total {:+.2f} standard errors, chi-square {:.0f} of {} blocks, p = {:.3g}: {}\n",
                   text(check, "what"), number(check, "total_z"), number(check, "chi_square"),
                   check.at("degrees").get<int>(), number(check, "p"), check.at("agrees").get<bool>() ? "good" : "BAD");
    });
    if (report.contains("stages")) {
        fmt::print("stages: ");
        print_stages(report.at("stages"));
    }
    if (report.contains("whole")) {
        fmt::print("whole: {}\n", text(report, "traversal"));
        const auto& whole = report.at("whole");
        print_timing(fmt::format("{:.3g} rays", number(whole, "rays")), whole);
        fmt::print("  {:.3f} % detected; wall clock {:.4g} s a run, of which the device {:.4g} s\n",
                   100 * number(whole, "detected_share"), number(whole, "wall_seconds"), number(whole, "seconds"));
    }
    each(report, "forms", [](const Json& entry) {
        print_timing(fmt::format("{}, g = {:.1f}, {} bounce{}", text(entry, "geometry"), number(entry, "g"),
                                 entry.at("max_bounces").get<int>(), entry.at("max_bounces").get<int>() > 1 ? "s" : ""),
                     entry);
    });
    each(report, "traversals", [](const Json& entry) { print_timing(text(entry, "name"), entry); });
    each(report, "hits", [](const Json& entry) {
        fmt::print("  {:<10} {:<10} {:>8} hits/s at NA {:.1f}, {:.0f} % met, spread {:.1f} %\n",
                   text(entry, "traversal"), text(entry, "order"), with_prefix(number(entry, "hits_per_second")),
                   number(entry, "numerical_aperture"), 100 * number(entry, "share_met"),
                   100 * number(entry, "spread"));
    });
    each(report, "estimators", [](const Json& entry) {
        print_timing(text(entry, "name"), entry);
        fmt::print("  {:<34} variance {:.4g} W^2 from {} seeds, efficiency relative to forward {:.4g}\n", "",
                   number(entry, "variance"), entry.at("seeds").get<int>(), number(entry, "relative_efficiency"));
    });
    if (report.contains("scaling")) {
        const auto& scaling = report.at("scaling");
        each(scaling, "rays",
             [](const Json& entry) { print_timing(fmt::format("{:.3g} rays", number(entry, "rays")), entry); });
        each(scaling, "triangles", [](const Json& entry) {
            print_timing(fmt::format("{:.3g} triangles, {}", number(entry, "triangles"), text(entry, "traversal")),
                         entry);
        });
        each(scaling, "surfaces", [](const Json& entry) {
            print_timing(fmt::format("{}, {} splitter, {} surfaces", text(entry, "objective"), text(entry, "splitter"),
                                     entry.at("surfaces").get<int>()),
                         entry);
        });
        each(scaling, "pixels", [](const Json& entry) {
            print_timing(fmt::format("{0} x {0} pixels", entry.at("pixels_along_a_side").get<int>()), entry);
        });
    }
    if (report.contains("peer")) {
        const auto& peer = report.at("peer");
        fmt::print("peer (Embree, lenses in double, {} threads, packets of {}, blocks of {})\n"
                   "  {} rays/s; vkfv is {:.2f} times as fast by the clock (spread {:.1f} %), {:.2f} by processor "
                   "time\n",
                   peer.at("threads").get<int>(), peer.at("packet").get<int>(), peer.at("block").get<int>(),
                   with_prefix(number(peer, "rays_per_second")), number(peer, "ratio"),
                   100 * number(peer, "ratio_spread"), number(peer, "processor_ratio"));
    }
}

} // namespace

void run_bench(const CommandOptions& options) {
    std::optional<ResultFolder> results;
    if (options.out) {
        results.emplace(*options.out);
    }
    const auto write_files = [&](const Json& so_far) {
        if (results) {
            results->write("bench.json", so_far.dump(2) + "\n");
            results->write("bench.svg", bench::bench_picture(so_far));
            results->write_checksums();
        }
    };
    const Json report = bench::measure_bench({.file = options.file,
                                              .overrides = options.overrides,
                                              .runs = options.runs,
                                              .parts = options.bench_parts,
                                              .quick = options.quick,
                                              .peer = options.peer,
                                              .commit = options.commit},
                                             write_files);
    write_files(report);
    if (options.json) {
        fmt::print("{}\n", report.dump(2));
    } else {
        print_report(report);
    }
}

} // namespace vkfv::app
