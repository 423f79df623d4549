#include "bench/bench_parts.hpp"
#include "core/messages/json_text.hpp"
#include "trace/interface/traced_instrument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

namespace vkfv::bench {

const std::vector<std::string> bench_parts = {"validation", "stages",   "whole",      "forms", "traversals",
                                              "hits",       "pipeline", "estimators", "rays",  "triangles",
                                              "surfaces",   "pixels",   "peer"};

namespace {

// A part of the bench that is measured by itself.
struct Part {
    const char* name;
    const char* key; // in the report
    bool scaling;    // true: in its object "scaling"
    Json (*measure)(const BenchScene& scene);
};

constexpr std::array parts_after_whole = {
    Part{"forms", "forms", false, forms},
    Part{"traversals", "traversals", false, traversal_timings},
    Part{"hits", "hits", false, hits},
    Part{"pipeline", "pipeline", false, pipeline},
    Part{"estimators", "estimators", false, estimator_timings},
    Part{"rays", "rays", true, over_rays},
    Part{"triangles", "triangles", true, over_triangles},
    Part{"surfaces", "surfaces", true, over_surfaces},
    Part{"pixels", "pixels", true, over_pixels},
};

std::string now() {
    const std::time_t time = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&time, &utc);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                       utc.tm_hour, utc.tm_min, utc.tm_sec);
}

Json head_of(const BenchScene& scene) {
    Json report;
    report["program"] = "vkfv " VKFV_VERSION;
    report["commit"] = scene.options().commit;
    report["date"] = now();
    report["device"] = scene.device().name;
    report["driver"] = scene.device().driver;
    report["device_type"] = scene.device().type;
    report["configuration"] = scene.options().file.string();
    report["aimed_share"] = trace::as_traced(scene.instrument(), scene.configuration().trace).aimed_share();
    report["runs"] = scene.options().runs;
    return report;
}

} // namespace

Json measure_bench(const BenchOptions& options, const std::function<void(const Json&)>& after_part) {
    const auto wants = [&](const std::string& part) {
        return std::ranges::find(options.parts, part) != options.parts.end();
    };
    BenchScene scene(options);
    Json report = head_of(scene);
    if (wants("validation")) {
        report["validation"] = validation(scene);
        const auto agrees = [](const Json& check) { return check["agrees"].get<bool>(); };
        if (!std::ranges::all_of(report["validation"], agrees)) {
            throw RunError(fmt::format("images of one scene do not agree, and nothing was timed:\n{}",
                                       json_text(report["validation"])));
        }
    }
    if (wants("stages")) {
        report["stages"] = stages(scene);
        after_part(report);
    }
    const bool exposes = std::ranges::any_of(bench_parts, [&](const std::string& part) {
        return part != "validation" && part != "stages" && part != "hits" && part != "pipeline" && wants(part);
    });
    if (exposes) {
        scene.settle_rays();
        report["rays_per_run"] = scene.rays();
    }
    if (wants("whole")) {
        const auto tracer = scene.tracer_of(scene.configuration().trace, scene.rays());
        report["traversal"] = tracer->description();
        report["whole"] = scene.timing(*tracer);
        after_part(report);
    }
    for (const auto& part : parts_after_whole) {
        if (wants(part.name)) {
            (part.scaling ? report["scaling"] : report)[part.key] = part.measure(scene);
            after_part(report);
        }
    }
    if (wants("peer") && !options.peer.empty()) {
        report["peer"] = beside_peer(scene);
    }
    return report;
}

} // namespace vkfv::bench
