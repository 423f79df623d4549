// The values that sweeps of stacks tell are what the files of their stacks hold.
#include "core/files/file.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "measurement/sweep/sweep.hpp"
#include "measurement/sweep/sweep_rows.hpp"
#include "scan/store.hpp"
#include "surface_files/surface_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

namespace vkfv::measurement {
namespace {

namespace fs = std::filesystem;

class SweepOfStacks : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(folder_);
        const auto whole = read_file(fs::path(VKFV_SOURCE_DIR) / "assets/stacks/noise_of_heights.toml");
        write_file(folder_ / "c.toml", whole.substr(0, whole.find("[[sweep.parameter]]")) +
                                           "[[sweep.parameter]]\nkey = \"trace.estimator\"\nvalues = [\"backward\"]\n");
    }
    void TearDown() override { fs::remove_all(folder_); }
    static void TearDownTestSuite() { fs::remove_all(shared_); }

    // The stacks are small, of 11 images without waves, and each combination has two repeats.
    std::vector<TomlOverride> overrides(const std::string& surfaces, const fs::path& out) const {
        return {{"trace.rays", "1e5", ""},
                {"detector.pixels", "16", ""},
                {"specimen.size_mm", "0.14", ""},
                {"scan.z_step_um", "2.7", ""},
                {"topography.smoothing_steps", "0.7", ""},
                {"diffraction.model", "\"none\"", ""},
                {"sweep.repeats", "2", ""},
                {"output.directory", toml_quoted((folder_ / out).string()), ""},
                {"output.surfaces", surfaces, ""}};
    }
    // `traced` counts the images that were traced.
    SweepResult run(const std::string& surfaces, int& traced, const fs::path& out = "out") const {
        Progress progress(std::cerr, Progress::Style::quiet);
        traced = 0;
        return run_sweep(folder_ / "c.toml", overrides(surfaces, out), progress,
                         [&](const StackResult& stack) { traced += stack.traced.traced; });
    }
    struct Measured {
        SweepResult result;
        int traced = 0;
    };
    // A sweep that several tests look at, measured by the first of them: they leave its folder as it is.
    const Measured& shared() const {
        static const Measured measured = [this] {
            int traced = 0;
            auto result = run("[\"tiff\"]", traced, shared_ / "out");
            return Measured{.result = std::move(result), .traced = traced};
        }();
        return measured;
    }

    fs::path folder_ = fs::temp_directory_path() / ("vkfv-sweep-of-stacks-" + std::to_string(getpid()));
    inline static const fs::path shared_ =
        fs::temp_directory_path() / ("vkfv-shared-sweep-of-stacks-" + std::to_string(getpid()));
};

TEST_F(SweepOfStacks, FiguresAreThoseOfItsFiles) {
    const auto& result = shared().result;
    EXPECT_EQ(shared().traced, 2 * 11);
    ASSERT_EQ(result.rows.size(), 1u);
    const auto& figures = result.rows.front().figures;
    const auto stack = [&](int repeat) {
        return result.folder / ("estimator=backward/repeat_00" + std::to_string(repeat));
    };
    double rms = 0;
    for (const int repeat : {0, 1}) {
        const auto results = nlohmann::json::parse(read_file(stack(repeat) / "results.json"));
        rms += results.at("rms_deviation_um").get<double>();
    }
    EXPECT_EQ(figures.at("rms deviation / um").get<double>(), rms / 2);

    // The variance of two values is half the square of their difference.
    const auto a = surface::read_surface(stack(0) / "topography.tif").map.height.values;
    const auto b = surface::read_surface(stack(1) / "topography.tif").map.height.values;
    double variance = 0, points = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (std::isfinite(a[k]) && std::isfinite(b[k])) {
            variance += 0.5 * (a[k] - b[k]) * (a[k] - b[k]);
            points += 1;
        }
    }
    ASSERT_GT(points, 100);
    const double noise = figures.at("height noise / um").get<double>();
    EXPECT_GT(noise, 0);
    // Sums of squares of heights of 5 um lose 2e-16 * 25 um^2 of a variance of at least 1e-4 um^2.
    EXPECT_NEAR(noise / (std::sqrt(variance / points) * um_per_mm), 1, 1e-9);
}

TEST_F(SweepOfStacks, IsTheSameOfImagesThatWereThereAndOfFilesThatCannotBeReadBack) {
    const auto& first = shared().result;
    const auto table = read_file(first.folder / "sweep.csv");
    fs::copy(first.folder, folder_ / "out", fs::copy_options::recursive);
    int traced = 0;
    const auto again = run("[\"ply\"]", traced); // a mesh is for viewers alone
    EXPECT_EQ(traced, 0);
    EXPECT_EQ(again.rows.front().figures, first.rows.front().figures);
    EXPECT_EQ(again.rows.front().picture.values, first.rows.front().picture.values);
    EXPECT_EQ(read_file(again.folder / "sweep.csv"), table);
}

// Two cameras, each of whose stacks is evaluated by two windows, share the light of one stack, which is traced once.
// The folders have the bytes that the stack's own command gives them.
TEST_F(SweepOfStacks, TheSameLightIsTracedOnce) {
    auto text = read_file(folder_ / "c.toml");
    text = text.substr(0, text.find("[[sweep.parameter]]")) +
           "[[sweep.parameter]]\nkey = \"camera.saturation\"\nvalues = [0.4, 0.6]\n"
           "[[sweep.parameter]]\nkey = \"topography.window_px\"\nvalues = [5, 7]\n";
    write_file(folder_ / "c.toml", text);
    const std::vector<TomlOverride> camera = {{"camera.preset", "\"IMX250\"", ""},
                                              {"camera.exposure", "\"stack\"", ""},
                                              {"scan.z_step_um", "5.4", ""},
                                              {"sweep.repeats", "1", ""}};
    constexpr int images = 6;
    const auto with = [&](const fs::path& out, std::vector<TomlOverride> more) {
        auto all = overrides("[\"tiff\"]", out);
        all.insert(all.end(), camera.begin(), camera.end());
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    Progress progress(std::cerr, Progress::Style::quiet);
    std::vector<int> traced;
    const auto sweep = [&] {
        traced.clear();
        return run_sweep(folder_ / "c.toml", with("out", {}), progress,
                         [&](const StackResult& stack) { traced.push_back(stack.traced.traced); });
    };
    const auto result = sweep();
    EXPECT_EQ(traced, (std::vector<int>{images, 0, 0, 0}));

    const auto folder_of = [&](const std::string& saturation, const std::string& window) {
        return result.folder / ("saturation=" + saturation + ",window_px=" + window);
    };
    for (const auto& [saturation, window] : {std::pair("0.4", "5"), std::pair("0.6", "7")}) {
        const auto alone = with(std::string("alone_") + window,
                                {{"camera.saturation", saturation, ""}, {"topography.window_px", window, ""}});
        const auto stack = measure_stack(load_configuration(folder_ / "c.toml", alone), progress);
        std::vector<fs::path> files = {"topography.tif", "height_uncertainty.tif", "ledger.csv"};
        for (int image = 0; image < images; ++image) {
            files.push_back(scan::image_path(image));
        }
        for (const fs::path& file : files) {
            EXPECT_EQ(read_file(folder_of(saturation, window) / file), read_file(stack.folder / file)) << file;
        }
    }
    const fs::path lost = scan::image_path(3);
    EXPECT_NE(read_file(folder_of("0.4", "5") / lost), read_file(folder_of("0.6", "5") / lost));

    // An image that is lost in both folders of the second camera is traced again in one, and taken from there.
    const auto bytes = read_file(folder_of("0.6", "5") / lost);
    fs::remove(folder_of("0.6", "5") / lost);
    fs::remove(folder_of("0.6", "7") / lost);
    sweep();
    EXPECT_EQ(traced, (std::vector<int>{0, 0, 1, 0}));
    EXPECT_EQ(read_file(folder_of("0.6", "7") / lost), bytes);
}

// Stacks that are measured at once have the files of stacks measured one after the other. The first and the last share
// their light, and so are never measured at once.
TEST_F(SweepOfStacks, FilesDoNotDependOnTheNumberOfLanes) {
    const auto swept = [&](const std::string& out) {
        std::vector<std::vector<Configuration>> rows;
        for (const auto& [seed, pitch] : {std::pair{"1", "8.0"}, std::pair{"2", "8.0"}, std::pair{"1", "8.1"}}) {
            auto own = overrides("[\"tiff\"]", fs::path(out) / std::to_string(rows.size()));
            own.push_back({"trace.seed", seed, ""});
            own.push_back({"trace.rays", "4e3", ""});
            own.push_back({"detector.assumed_pitch_um", pitch, ""});
            own.push_back({"trace.estimator", "\"backward\"", ""});
            rows.push_back({load_stack(folder_ / "c.toml", own)});
        }
        return rows;
    };
    Progress progress(std::cerr, Progress::Style::quiet);
    for (const int lanes : {1, 2}) {
        std::vector<std::size_t> begun;
        std::atomic<int> at_once = 0;
        const auto alone = [&](const auto& told) {
            EXPECT_EQ(at_once++, 0); // calls never overlap
            told();
            --at_once;
        };
        std::size_t after_stacks = 0, after_rows = 0;
        SweptStacks(swept(std::to_string(lanes)))
            .measure(progress, lanes,
                     {.begins = [&](std::size_t row) { alone([&] { begun.push_back(row); }); },
                      .after_stack =
                          [&](std::size_t, const StackResult&) {
                              alone([&] {
                                  std::this_thread::sleep_for(std::chrono::milliseconds(20)); // an overlap would show
                                  ++after_stacks;
                              });
                          },
                      .after_row = [&](std::size_t, SweepRow&&) { alone([&] { ++after_rows; }); }});
        EXPECT_EQ(after_stacks, 3u);
        EXPECT_EQ(after_rows, 3u);
        ASSERT_EQ(begun.size(), 3u);
        EXPECT_LT(std::ranges::find(begun, 0u), std::ranges::find(begun, 2u));
    }
    for (const char* row : {"0", "1", "2"}) {
        for (const char* file : {"topography.tif", "images/z_0003.tif"}) {
            EXPECT_EQ(read_file(folder_ / "1" / row / file), read_file(folder_ / "2" / row / file)) << row << file;
        }
    }
    EXPECT_NE(read_file(folder_ / "1/0/topography.tif"), read_file(folder_ / "1/1/topography.tif"));
}

// The first row throws long before the light of the others is traced, which one lane measures one after the other: most
// of them never begin.
TEST_F(SweepOfStacks, EndsWithTheFirstExceptionOfAListener) {
    constexpr std::size_t others = 6;
    std::vector<std::vector<Configuration>> rows;
    rows.reserve(1 + others);
    for (std::size_t row = 0; row <= others; ++row) {
        auto own = overrides("[\"tiff\"]", fs::path("ends") / std::to_string(row));
        own.push_back({"trace.seed", row == 0 ? "1" : "2", ""});
        own.push_back({"trace.rays", row == 0 ? "4e3" : "1e5", ""});
        own.push_back({"detector.assumed_pitch_um", fmt::format("8.{}", row), ""});
        own.push_back({"trace.estimator", "\"backward\"", ""});
        rows.push_back({load_stack(folder_ / "c.toml", own)});
    }
    Progress progress(std::cerr, Progress::Style::quiet);
    std::size_t begun = 0;
    EXPECT_THROW(SweptStacks(std::move(rows))
                     .measure(progress, 2,
                              {.begins = [&](std::size_t) { ++begun; },
                               .after_stack =
                                   [](std::size_t row, const StackResult&) {
                                       if (row == 0) {
                                           throw RunError("enough");
                                       }
                                   },
                               .after_row = {}}),
                 RunError);
    EXPECT_GE(begun, 1u);
    EXPECT_LT(begun, 1 + others);
}

} // namespace
} // namespace vkfv::measurement
