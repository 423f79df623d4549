// Several devices at a time, shards and their merge give the bytes of one run; logs and forecasts tell a scheduler what
// it needs.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

using Words = std::vector<std::string>;

// The bytes of every file except for those that hold times and locks.
std::map<std::string, std::string> result_bytes(const fs::path& folder) {
    std::map<std::string, std::string> bytes;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (entry.is_regular_file() && !name.starts_with("timings") && !name.starts_with(".lock")) {
            bytes[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
        }
    }
    return bytes;
}

void expect_same_results(const fs::path& one, const fs::path& other) {
    const auto bytes = result_bytes(one), others = result_bytes(other);
    for (const auto& [name, content] : bytes) {
        EXPECT_TRUE(others.contains(name) && others.at(name) == content) << name;
    }
    EXPECT_EQ(bytes.size(), others.size());
}

class Cluster : public testing::Test {
  protected:
    Cluster() : folder_(fresh_folder("work")) {
        write_file(folder_ / "c.toml", replaced(small_configuration, "rays = 2000", "rays = 200000"));
    }

    // Tests that kill a stack, or forecast it, need one that takes some time; all others are sooner done with ideal
    // lenses.
    void take_ideal_lenses() const {
        write_file(folder_ / "c.toml", replaced(ideal_configuration(), "rays = 2000", "rays = 200000"));
    }

    // Results show the last part of their folder's name, so that part is "out" for all of them.
    ProgramResult stack(const std::string& out, Words further = {}) const {
        Words words = {"stack", "c.toml", "--out", out + "/out"};
        words.insert(words.end(), further.begin(), further.end());
        return run_program(words, folder_);
    }
    fs::path out(const std::string& name) const { return folder_ / name / "out"; }

    fs::path folder_;
};

TEST_F(Cluster, SeveralDevicesGiveTheBytesOfOne) {
    take_ideal_lenses();
    for (Words further : {Words{}, Words{"--estimator", "backward"}, Words{"--set", "diffraction.model=none"}}) {
        further.insert(further.end(), {"--rays", "20000"});
        fs::remove_all(folder_ / "one");
        fs::remove_all(folder_ / "two");
        Words one = further, two = further;
        one.insert(one.end(), {"--device", "0"});
        two.insert(two.end(), {"--device", "0,0"});
        ASSERT_EQ(stack("one", one).exit_code, 0);
        const auto by_two = stack("two", two);
        ASSERT_EQ(by_two.exit_code, 0) << by_two.standard_error;
        EXPECT_THAT(by_two.standard_error, HasSubstr("2 devices at a time"));
        expect_same_results(out("one"), out("two"));
    }
    const auto refused = stack("three", {"--device", "0,nobody"});
    EXPECT_EQ(refused.exit_code, 3);
    EXPECT_THAT(refused.standard_error, HasSubstr("No Vulkan device matches \"nobody\""));
}

TEST_F(Cluster, ShardsMergeToTheBytesOfOneRun) {
    take_ideal_lenses();
    for (Words further : {Words{}, Words{"--set", "diffraction.model=airy", "--estimator", "backward"}}) {
        further.insert(further.end(), {"--rays", "20000"});
        for (const char* name : {"one", "shared", "apart-1", "apart-2", "merged"}) {
            fs::remove_all(folder_ / name);
        }
        ASSERT_EQ(stack("one", further).exit_code, 0);
        for (const auto& [shard, apart] : {std::pair{"1/2", "apart-1"}, {"2/2", "apart-2"}}) {
            Words words = further;
            words.insert(words.end(), {"--shard", shard});
            EXPECT_THAT(stack("shared", words).standard_output, HasSubstr("images traced"));
            ASSERT_EQ(stack(apart, words).exit_code, 0);
            EXPECT_FALSE(fs::exists(out(apart) / "results.json"));
        }
        EXPECT_EQ(run_program({"merge", out("shared")}, folder_).exit_code, 0);
        expect_same_results(out("one"), out("shared"));
        const auto merged = run_program({"merge", out("merged"), out("apart-1"), out("apart-2")}, folder_);
        EXPECT_EQ(merged.exit_code, 0) << merged.standard_error;
        expect_same_results(out("one"), out("merged"));
        EXPECT_EQ(run_program({"verify", out("merged")}, folder_).exit_code, 0);
    }
}

// Shards of several sources, and of pixels with gaps between them, merge to the bits of the whole stack too.
TEST_F(Cluster, ShardsOfSeveralSourcesAndPixelsWithGapsMergeToo) {
    auto text = replaced(ideal_configuration(), "[source]\n", "[[source]]\n");
    text = replaced(text, "wavelength_um = 0.5876\n",
                    "wavelength_um = 0.5876\n[[source]]\nkind = \"ring\"\ndistance_mm = 30\nelevation_deg = 45\n"
                    "width_mm = 5\nflux_W = 20\nwavelength_um = 0.5\n");
    write_file(folder_ / "c.toml", replaced(text, "pixels = 8\n", "pixels = 8\nfill_factor = 0.6\n"));
    for (const char* estimator : {"forward", "backward"}) {
        const Words by = {"--device", "host", "--estimator", estimator};
        ASSERT_EQ(stack("one", by).exit_code, 0);
        for (const char* shard : {"1/2", "2/2"}) {
            Words words = by;
            words.insert(words.end(), {"--shard", shard});
            ASSERT_EQ(stack("shared", words).exit_code, 0);
        }
        const auto merged = run_program({"merge", out("shared")}, folder_);
        EXPECT_EQ(merged.exit_code, 0) << merged.standard_error;
        expect_same_results(out("one"), out("shared"));
        fs::remove_all(folder_ / "one");
        fs::remove_all(folder_ / "shared");
    }
}

// The lights of a stack are told apart: another light of any source is another stack.
TEST_F(Cluster, AnotherLightOfAnySourceIsAnotherStack) {
    write_file(folder_ / "c.toml",
               replaced(replaced(ideal_configuration(), "[source]\n", "[[source]]\n"), "wavelength_um = 0.5876\n",
                        "wavelength_um = 0.5876\n[[source]]\nkind = \"ring\"\ndistance_mm = 30\nelevation_deg = 45\n"
                        "width_mm = 5\nwavelength_um = 0.5876\n"));
    ASSERT_EQ(stack("one", {"--device", "host"}).exit_code, 0);
    const auto before = result_bytes(out("one"));
    for (const char* key : {"source.0.flux_W", "source.1.flux_W"}) {
        const auto other = stack("one", {"--device", "host", "--set", std::string(key) + "=2"});
        EXPECT_EQ(other.exit_code, 2) << key;
        EXPECT_THAT(other.standard_error, HasSubstr(".flux_W: 1.0 there, 2.0 here")) << key;
    }
    EXPECT_EQ(result_bytes(out("one")), before);
}

TEST_F(Cluster, MergeNamesWhatIsMissingAndRefusesWhatDoesNotBelong) {
    take_ideal_lenses();
    ASSERT_EQ(stack("first", {"--shard", "1/3", "--quiet"}).exit_code, 0);
    ASSERT_EQ(stack("seed", {"--shard", "2/3", "--seed", "5", "--quiet"}).exit_code, 0);
    const auto missing = run_program({"merge", out("m"), out("first")}, folder_);
    EXPECT_EQ(missing.exit_code, 2);
    EXPECT_THAT(missing.standard_error, HasSubstr("no image 1 to 2, 4"));
    const auto other = run_program({"merge", out("m"), out("first"), out("seed")}, folder_);
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_THAT(other.standard_error, HasSubstr("trace.seed: 5 there, 1 here"));
    // A shard of another program or device is refused by the identity that it left.
    for (const auto& [from, to] :
         {std::pair{"kernels_digest = \"", "kernels_digest = \"0"}, {"device = \"", "device = \"another "}}) {
        ASSERT_EQ(stack("second", {"--shard", "2/3", "--quiet"}).exit_code, 0);
        const auto toml = out("second") / "stack.toml";
        write_file(toml, replaced(read_file(toml), from, to));
        EXPECT_EQ(run_program({"merge", out("m"), out("second"), out("first")}, folder_).exit_code, 2);
        fs::remove_all(folder_ / "second");
    }
    const auto nothing = run_program({"merge", "nowhere"}, folder_);
    EXPECT_EQ(nothing.exit_code, 2);
    EXPECT_THAT(nothing.standard_error, HasSubstr("stack.toml"));
    // A flipped bit of a shard's image is found.
    ASSERT_EQ(stack("second", {"--shard", "2/3", "--quiet"}).exit_code, 0);
    const auto image = out("second") / "images/z_0001.tif";
    std::string bytes = read_file(image);
    bytes[bytes.size() / 2] ^= 1;
    write_file(image, bytes);
    const auto flipped = run_program({"merge", out("n"), out("first"), out("second")}, folder_);
    EXPECT_EQ(flipped.exit_code, 2);
    EXPECT_THAT(flipped.standard_error, HasSubstr("z_0001.tif"));
    for (const char* shard : {"0/3", "4/3", "1", "1/0", "a/b", "1/3x", "-1/3"}) {
        EXPECT_EQ(stack("bad", {"--shard", shard}).exit_code, 2) << shard;
    }
}

// Starts the program in a process of its own, which takes signals.
pid_t start(const Words& words, const fs::path& folder) {
    const pid_t child = fork();
    if (child == 0) {
        Words all = words;
        all.insert(all.begin(), program());
        std::vector<char*> arguments;
        for (auto& word : all) {
            arguments.push_back(word.data());
        }
        arguments.push_back(nullptr);
        const bool ready = chdir(folder.c_str()) == 0 && freopen("/dev/null", "w", stdout) != nullptr &&
                           freopen("/dev/null", "w", stderr) != nullptr;
        if (ready) {
            execv(arguments[0], arguments.data());
        }
        _exit(127);
    }
    return child;
}

// Shards of one folder are killed, each on a device that is opened twice: a hundred times with VKFV_EVERY_FAULT in the
// environment, else five times.
TEST_F(Cluster, KilledShardsEndInTheBytesOfOneRun) {
    const int kills = std::getenv("VKFV_EVERY_FAULT") != nullptr ? 100 : 5;
    ASSERT_EQ(stack("one", {"--quiet", "--device", "0"}).exit_code, 0);
    std::mt19937 random(5);
    int unfinished = 0;
    for (int round = 0; round < kills; ++round) {
        std::vector<pid_t> children;
        for (const char* shard : {"1/2", "2/2"}) {
            children.push_back(
                start({"stack", "c.toml", "--out", "killed/out", "--device", "0,0", "--shard", shard}, folder_));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200 + random() % 3000));
        for (const pid_t child : children) {
            int status = 0;
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            unfinished += WIFSIGNALED(status) ? 1 : 0;
            EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
        }
        if (round % 5 == 4) { // a stack that is whole is no victim any more
            fs::remove(out("killed") / "images/z_0001.tif");
            fs::remove(out("killed") / "images/z_0002.tif");
        }
    }
    EXPECT_GT(unfinished, kills / 2);
    for (const char* shard : {"1/2", "2/2"}) {
        const auto last = stack("killed", {"--device", "0,0", "--shard", shard});
        ASSERT_EQ(last.exit_code, 0) << last.standard_error;
    }
    ASSERT_EQ(run_program({"merge", out("killed")}, folder_).exit_code, 0);
    expect_same_results(out("one"), out("killed"));
}

// Waits until one of the files is there, a minute at most.
bool appears(const std::vector<fs::path>& files) {
    const auto there = [&] {
        return std::ranges::any_of(files, [](const fs::path& file) { return fs::exists(file); });
    };
    for (int k = 0; k < 6000 && !there(); ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return there();
}

TEST_F(Cluster, AKilledExposureGoesOnFromItsCheckpoint) {
    // The rays take a second or more an image on two cores, fifty times the interval between two checkpoints.
    const auto often = [](const char* rays, Words words = {}) {
        words.insert(words.end(), {"--rays", rays, "--set", "output.checkpoint_s=0.02"});
        return words;
    };
    const Words stack_often = often("2000000", {"--set", "scan.z_stop_um=0"}); // three images
    for (const int signal : {SIGKILL, SIGTERM}) {
        Words words = {"stack", "c.toml", "--out", "killed/out"};
        words.insert(words.end(), stack_often.begin(), stack_often.end());
        const pid_t child = start(words, folder_);
        const bool kept = appears({out("killed") / "partial_0000", out("killed") / "partial_0001"});
        int status = 0;
        kill(child, signal);
        waitpid(child, &status, 0);
        EXPECT_TRUE(kept);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    }
    const auto last = stack("killed", stack_often);
    ASSERT_EQ(last.exit_code, 0) << last.standard_error;
    EXPECT_THAT(last.standard_error, HasSubstr("goes on from"));
    ASSERT_EQ(stack("one", stack_often).exit_code, 0);
    expect_same_results(out("one"), out("killed"));

    // A single image goes on from its checkpoint too.
    const Words image = often("3000000", {"image", "c.toml", "--z", "0.3", "--estimator", "backward"});
    const auto to = [&](const char* file) {
        Words words = image;
        words.insert(words.end(), {"--out", file});
        return words;
    };
    const pid_t child = start(to("killed.tif"), folder_);
    EXPECT_TRUE(appears({folder_ / "killed.tif.partial"}));
    int status = 0;
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    EXPECT_FALSE(fs::exists(folder_ / "killed.tif"));
    // Another exposure does not take the checkpoint up.
    Words other = to("killed.tif");
    other.insert(other.end(), {"--seed", "9"});
    EXPECT_THAT(run_program(other, folder_).standard_error, HasSubstr("a checkpoint of another exposure"));
    EXPECT_FALSE(fs::exists(folder_ / "killed.tif.partial"));
    const pid_t again = start(to("killed.tif"), folder_);
    EXPECT_TRUE(appears({folder_ / "killed.tif.partial"}));
    kill(again, SIGKILL);
    waitpid(again, &status, 0);
    const auto finished = run_program(to("killed.tif"), folder_);
    EXPECT_THAT(finished.standard_error, HasSubstr("goes on from"));
    ASSERT_EQ(run_program(to("one.tif"), folder_).exit_code, 0);
    EXPECT_EQ(read_file(folder_ / "killed.tif"), read_file(folder_ / "one.tif"));
    EXPECT_FALSE(fs::exists(folder_ / "killed.tif.partial"));
}

TEST_F(Cluster, TheLogTellsOfEachImageInJson) {
    take_ideal_lenses();
    const auto result = stack("out", {"--log-json"});
    ASSERT_EQ(result.exit_code, 0);
    std::istringstream lines(result.standard_error);
    std::map<std::string, std::vector<json>> events;
    for (std::string line; std::getline(lines, line);) {
        const json event = json::parse(line);
        EXPECT_TRUE(event.contains("time")) << line;
        events[event.contains("event") ? event["event"].get<std::string>() : "message"].push_back(event);
    }
    EXPECT_EQ(events["begin"].size(), 1u);
    EXPECT_EQ(events["end"].size(), 1u);
    EXPECT_GE(events["message"].size(), 1u);
    ASSERT_EQ(events["image"].size(), 5u);
    for (const json& image : events["image"]) {
        EXPECT_EQ(image["z_um"].get<double>(), image["image"].get<int>() - 2);
        EXPECT_EQ(image["rays"], 200000);
        EXPECT_EQ(image["images"], 5);
        EXPECT_EQ(image["device"], 0);
        EXPECT_GT(image["rays_per_s"].get<double>(), 0);
        EXPECT_GT(image["longest_submission_s"].get<double>(), 0);
        const double span = image["device_end_s"].get<double>() - image["device_begin_s"].get<double>();
        EXPECT_GT(image["device_busy_s"].get<double>(), 0);
        EXPECT_LE(image["device_busy_s"].get<double>(), span * (1 + 1e-9));
        EXPECT_GE(image["seconds_left"].get<double>(), 0);
        const double sum = image["detected_W"].get<double>() + image["lost_W"].get<double>();
        EXPECT_NEAR(sum + image["residual_W"].get<double>(), image["emitted_W"].get<double>(), 1e-12);
        EXPECT_GT(image["detected_W"].get<double>(), 0);
    }
    EXPECT_EQ(events["image"].back()["done"], 5);
    // A command that fails ends its log with the error and the exit code.
    const auto failed = stack("out", {"--log-json", "--seed", "9"});
    EXPECT_EQ(failed.exit_code, 2);
    const auto last = failed.standard_error.rfind('{');
    ASSERT_NE(last, std::string::npos);
    const json error = json::parse(failed.standard_error.substr(last));
    EXPECT_EQ(error["exit_code"], 2);
    EXPECT_THAT(error["text"].get<std::string>(), HasSubstr("trace.seed"));
}

TEST_F(Cluster, AForecastTellsWhatTheStackThenTakes) {
    // Without diffraction the noise of an image is that of the number of its rays; waves would spread it over pixels.
    const Words settings = {"--set", "detector.pixels=64", "--rays", "2e6", "--set", "diffraction.model=none"};
    Words check = {"check", "c.toml", "--forecast", "--json", "--out", "f/out"};
    check.insert(check.end(), settings.begin(), settings.end());
    const auto result = run_program(check, folder_);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const json forecast = json::parse(result.standard_output)["forecast"];
    Words tracing = settings;
    tracing.push_back("--log-json");
    const auto traced = stack("f", tracing);
    ASSERT_EQ(traced.exit_code, 0);
    EXPECT_EQ(forecast["images"], 5);
    EXPECT_EQ(forecast["rays_per_image"], 2000000);
    std::istringstream lines(traced.standard_error);
    double seconds = 0, detected_rays = 0, light = 0;
    for (std::string line; std::getline(lines, line);) {
        const json event = json::parse(line);
        if (event.contains("image")) {
            seconds += event["seconds"].get<double>();
            detected_rays += event["detected_rays"].get<double>() / 5 / (64 * 64);
            light += event["detected_W"].get<double>() / 5 / (64 * 64);
        }
    }
    // A machine at other work may take four times as long as forecast.
    EXPECT_GT(forecast["seconds"].get<double>(), seconds / 4);
    EXPECT_LT(forecast["seconds"].get<double>(), seconds * 4);
    EXPECT_NEAR(forecast["detected_rays_per_pixel"].get<double>(), detected_rays, 0.05 * detected_rays);
    EXPECT_NEAR(forecast["light_per_pixel_W"].get<double>(), light, 0.05 * light);
    EXPECT_NEAR(forecast["noise"].get<double>(), 1 / std::sqrt(detected_rays), 0.3 / std::sqrt(detected_rays));
    EXPECT_GT(forecast["device_memory_bytes"].get<double>(), 1e6);
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::recursive_directory_iterator(out("f"))) {
        bytes += entry.is_regular_file() ? entry.file_size() : 0;
    }
    EXPECT_GT(forecast["disk_bytes"].get<double>(), static_cast<double>(bytes));
    EXPECT_TRUE(forecast["fits"].get<bool>());
    const auto text = run_program({"check", "c.toml", "--forecast"}, folder_);
    EXPECT_THAT(text.standard_output, AllOf(HasSubstr("forecast"), HasSubstr("s an image"), HasSubstr("disk")));
    // Plain check opens no device.
    EXPECT_EQ(run_program({"check", "c.toml"}, folder_, {{"VK_DRIVER_FILES", "/nowhere"}}).exit_code, 0);
}

TEST_F(Cluster, WhatCannotFitOnTheDiskIsRefusedFirst) {
    // The detector has so many pixels that 8001 images take more space than there is.
    const auto free = static_cast<double>(fs::space(folder_).available);
    const int pixels = std::max(64, static_cast<int>(std::ceil(std::sqrt(1.1 * free / (8001 * sizeof(float))))));
    const auto result = stack("large", {"--set", "detector.pixels=" + std::to_string(pixels), "--set",
                                        "scan.z_step_um=0.0005", "--set", "diffraction.model=none"});
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_THAT(result.standard_error,
                AllOf(HasSubstr("8001 images and the results take "), HasSubstr("but the disk has ")));
    EXPECT_FALSE(fs::exists(out("large") / "images/z_0000.tif"));
}

} // namespace
} // namespace vkfv::test
