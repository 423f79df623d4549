#include "bench/bench.hpp"
#include "report/chart.hpp"

#include <fmt/format.h>

namespace vkfv::bench {

namespace {

using report::with_prefix; // for rates

double number(const Json& of, const char* key) {
    return of.at(key).get<double>();
}

std::string text(const Json& of, const char* key) {
    return of.at(key).get<std::string>();
}

std::string timing_text(const std::string& what, const Json& timing) {
    return fmt::format("  {:<34} {:>8} rays/s, {:>10.4g} s per 1e9 rays, {:>8} ray-surfaces/s, spread {:.1f} %\n", what,
                       with_prefix(number(timing, "rays_per_second")), number(timing, "seconds_per_1e9_rays"),
                       with_prefix(number(timing, "ray_surfaces_per_second")), 100 * number(timing, "spread"));
}

std::string stages_text(const Json& stages) {
    std::string result = fmt::format(
        "{}\n"
        "  rays/s                 {:.4g}  (runs of {:.3g} rays, spread {:.1f} %)\n"
        "  seconds per 1e9 rays   {:.4g}\n"
        "  surfaces per ray       {:.2f} launched, {:.2f} detected; {}ray-surfaces/s\n"
        "  share of the time     ",
        text(stages, "traversal"), number(stages, "rays_per_second"), number(stages, "rays"),
        100 * number(stages, "spread"), number(stages, "seconds_per_1e9_rays"), number(stages, "surfaces_per_ray"),
        number(stages, "surfaces_per_detected_ray"), with_prefix(number(stages, "ray_surfaces_per_second")) + " ");
    const char* comma = "";
    for (const auto& [name, share] : stages.at("shares").items()) {
        result += fmt::format("{} {} {:.1f} %", comma, name, 100 * share.get<double>());
        comma = ",";
    }
    return result + "\n";
}

// A heading, and a line or two for each entry of a list, if the list is there.
template <class Line>
std::string list_text(const Json& of, const char* list, const Line& line) {
    std::string result;
    if (of.contains(list)) {
        result += fmt::format("{}\n", list);
        for (const auto& entry : of.at(list)) {
            result += line(entry);
        }
    }
    return result;
}

std::string head_text(const Json& report) {
    const auto commit = text(report, "commit");
    return fmt::format("{}{}, {}; {} ({}, {}); {:.4g} of the source's flux is aimed at, medians of {} runs\n",
                       text(report, "program"), commit.empty() ? "" : " " + commit, text(report, "date"),
                       text(report, "device"), text(report, "driver"), text(report, "device_type"),
                       number(report, "aimed_share"), report.at("runs").get<int>());
}

std::string whole_text(const Json& report) {
    const auto& whole = report.at("whole");
    return fmt::format("whole: {}\n", text(report, "traversal")) +
           timing_text(fmt::format("{:.3g} rays", number(whole, "rays")), whole) +
           fmt::format("  {:.3f} % detected; wall clock {:.4g} s a run, of which the device {:.4g} s\n",
                       100 * number(whole, "detected_share"), number(whole, "wall_seconds"), number(whole, "seconds"));
}

std::string validation_text(const Json& check) {
    return fmt::format("  {}: total {:+.2f} standard errors, chi-square {:.0f} of {} blocks, p = {:.3g}: {}\n",
                       text(check, "what"), number(check, "total_z"), number(check, "chi_square"),
                       check.at("degrees").get<int>(), number(check, "p"),
                       check.at("agrees").get<bool>() ? "good" : "BAD");
}

std::string form_text(const Json& entry) {
    const int bounces = entry.at("max_bounces").get<int>();
    return timing_text(fmt::format("{}, g = {:.1f}, {} bounce{}", text(entry, "geometry"), number(entry, "g"), bounces,
                                   bounces > 1 ? "s" : ""),
                       entry);
}

std::string pipeline_text(const Json& entry) {
    return fmt::format(
        "  {:<10} {} rays, {} met by both, {} by one alone, {} more than 1 nm apart; {} of these not for "
        "rounding; else at most {:.3f} nm apart\n",
        text(entry, "traversal"), entry.at("rays").get<std::uint64_t>(), entry.at("both").get<std::uint64_t>(),
        entry.at("one_alone").get<std::uint64_t>(), entry.at("apart").get<std::uint64_t>(),
        entry.at("unexplained").get<std::uint64_t>(), number(entry, "largest_height_apart_nm"));
}

std::string hits_text(const Json& entry) {
    return fmt::format("  {:<10} {:<10} {:>8} hits/s at NA {:.1f}, {:.0f} % met, spread {:.1f} %\n",
                       text(entry, "traversal"), text(entry, "order"), with_prefix(number(entry, "hits_per_second")),
                       number(entry, "numerical_aperture"), 100 * number(entry, "share_met"),
                       100 * number(entry, "spread"));
}

std::string estimator_text(const Json& entry) {
    return timing_text(text(entry, "name"), entry) +
           fmt::format("  {:<34} variance {:.4g} W^2 from {} seeds, efficiency relative to forward {:.4g}\n", "",
                       number(entry, "variance"), entry.at("seeds").get<int>(), number(entry, "relative_efficiency"));
}

std::string scaling_text(const Json& scaling) {
    return list_text(scaling, "rays",
                     [](const Json& entry) {
                         return timing_text(fmt::format("{:.3g} rays", number(entry, "rays")), entry);
                     }) +
           list_text(scaling, "triangles",
                     [](const Json& entry) {
                         return timing_text(
                             fmt::format("{:.3g} triangles, {}", number(entry, "triangles"), text(entry, "traversal")),
                             entry);
                     }) +
           list_text(scaling, "surfaces",
                     [](const Json& entry) {
                         return timing_text(fmt::format("{}, {} splitter, {} surfaces", text(entry, "objective"),
                                                        text(entry, "splitter"), entry.at("surfaces").get<int>()),
                                            entry);
                     }) +
           list_text(scaling, "pixels", [](const Json& entry) {
               return timing_text(fmt::format("{0} x {0} pixels", entry.at("pixels_along_a_side").get<int>()), entry);
           });
}

std::string peer_text(const Json& peer) {
    return fmt::format(
        "peer (Embree, lenses in double, {} threads, packets of {}, blocks of {})\n"
        "  {} rays/s; vkfv is {:.2f} times as fast by the clock (spread {:.1f} %), {:.2f} by processor time\n",
        peer.at("threads").get<int>(), peer.at("packet").get<int>(), peer.at("block").get<int>(),
        with_prefix(number(peer, "rays_per_second")), number(peer, "ratio"), 100 * number(peer, "ratio_spread"),
        number(peer, "processor_ratio"));
}

} // namespace

std::string bench_text(const Json& report) {
    std::string result = head_text(report) + list_text(report, "validation", validation_text);
    if (report.contains("stages")) {
        result += "stages: " + stages_text(report.at("stages"));
    }
    if (report.contains("whole")) {
        result += whole_text(report);
    }
    result += list_text(report, "forms", form_text);
    result +=
        list_text(report, "traversals", [](const Json& entry) { return timing_text(text(entry, "name"), entry); });
    result += list_text(report, "hits", hits_text);
    result += list_text(report, "pipeline", pipeline_text);
    result += list_text(report, "estimators", estimator_text);
    if (report.contains("scaling")) {
        result += scaling_text(report.at("scaling"));
    }
    if (report.contains("peer")) {
        result += peer_text(report.at("peer"));
    }
    return result;
}

} // namespace vkfv::bench
