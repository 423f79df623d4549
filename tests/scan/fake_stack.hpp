// A stack whose exposures are a formula, for tests of everything around the trace.
#pragma once

#include "scan/plan.hpp"
#include "scan/stack.hpp"
#include "scan/store.hpp"
#include "trace/interface/tracer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>

namespace vkfv::scan::test {

inline constexpr int columns = 5;
inline constexpr int rows = 3;
inline constexpr double pitch = 0.002; // mm
inline constexpr std::uint64_t rays = 1000;

// No two pixels, images, heights or seeds have the same value.
inline double flux(int column, int row, double z, std::uint32_t image, int seed) {
    return 1e-3 * (column + 10 * row + 100 * image) + z + 7.0 * seed;
}

class FakeTracer : public trace::Tracer {
  public:
    explicit FakeTracer(int seed = 1, std::chrono::microseconds duration = {}) : seed_(seed), duration_(duration) {}
    trace::Image expose(trace::FocalPosition position, std::uint32_t image) const override {
        std::this_thread::sleep_for(duration_);
        exposed.push_back(static_cast<int>(image));
        trace::Image exposure;
        exposure.flux = Grid<double>(columns, rows);
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                exposure.flux(column, row) = flux(column, row, position.height, image, seed_);
            }
        }
        exposure.ledger.emitted = 1;
        exposure.ledger.entries = {{"detected", 0.1 + 0.01 * image, 100},
                                   {"vignetted at imaging 3 (10x, back)", 0.9 - 0.01 * image, 900}};
        exposure.rays = rays;
        exposure.detected = 100 + image;
        exposure.seconds = 1e-3;
        return exposure;
    }
    std::string description() const override { return "a formula"; }
    trace::TracerIdentity identity() const override {
        trace::TracerIdentity identity;
        identity.device = "a formula";
        return identity;
    }

    mutable std::vector<int> exposed; // images, in the order they were asked for

  private:
    int seed_;
    std::chrono::microseconds duration_;
};

inline StackDescription describe(int images = 4, int seed = 1) {
    const double step = 0.0008;
    return {.configuration = fmt::format("[trace]\nseed = {}\n\n[topography]\nwindow_px = 7\n", seed),
            .identity = fmt::format("program = \"vkfv 0\"\n\n[trace]\nseed = {}\nrays = 1000\n", seed),
            .digest = fmt::format("{:016x}", seed),
            .positions = ScanPlan{-0.0012, -0.0012 + (images - 1) * step, step}.positions(),
            .columns = columns,
            .rows = rows,
            .pitch = pitch};
}

inline StackSummary run(const std::filesystem::path& folder, const trace::Tracer& tracer,
                        const StackDescription& description, Shard shard = {}) {
    ImageStore store(folder, description, shard);
    std::ostringstream nowhere;
    Progress progress(nowhere, Progress::Style::quiet);
    return run_stack(tracer, store, progress);
}

// A folder's path that does not exist, removed with the object.
class FreshFolder {
  public:
    explicit FreshFolder(const std::string& name)
        : path_(std::filesystem::temp_directory_path() / fmt::format("vkfv_scan_{}_{}", ::getpid(), name)) {
        std::filesystem::remove_all(path_);
    }
    ~FreshFolder() { std::filesystem::remove_all(path_); }
    FreshFolder(const FreshFolder&) = delete;
    FreshFolder& operator=(const FreshFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

// The results that must not depend on interruptions: every file but the timings, by relative path.
inline std::map<std::string, std::string> result_of(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const auto path = std::filesystem::relative(entry.path(), folder);
        if (entry.is_regular_file() && path != "timings.csv") {
            files[path.string()] = bytes_of(entry.path());
        }
    }
    return files;
}

// The names of the files that one result has and the other has not, or has with other bytes.
inline std::string differing_files(const std::map<std::string, std::string>& one,
                                   const std::map<std::string, std::string>& other) {
    std::string names;
    for (const auto& [name, bytes] : one) {
        const auto twin = other.find(name);
        names += twin == other.end() || twin->second != bytes ? name + " " : "";
    }
    for (const auto& [name, bytes] : other) {
        names += one.contains(name) ? "" : name + " ";
    }
    return names;
}

} // namespace vkfv::scan::test
