// A script sees the exit code of a run, and a person the words on standard error that say what to do.
#include "app/program.hpp"
#include "core/files/result_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const std::string without_waves = "[diffraction]\nmodel = \"none\"\n";

TEST(ExitCode, OfAFolderInUseIsFive) {
    const auto folder = fresh_folder("in_use");
    write_file(folder / "c.toml", ideal_configuration() + without_waves);
    ASSERT_EQ(run_program({"--stack", "c.toml", "--quiet"}, folder).exit_code, 0);
    const ResultFolder holder(folder / "out");
    for (const auto& command : {std::vector<std::string>{"--stack", "c.toml"},
                                {"--topography", "out"},
                                {"--compare", "out/truth.tif", "out/truth.tif", "--form", "none", "--out", "out"}}) {
        const auto result = run_program(command, folder);
        EXPECT_EQ(result.exit_code, 5) << command.front() << result.standard_error;
        EXPECT_THAT(result.standard_error, AllOf(HasSubstr("another vkfv is writing"), HasSubstr("--out")));
    }
}

TEST(ExitCode, OfAPlaceThatCannotBeWrittenToIsFour) {
    const auto folder = fresh_folder("unwritable");
    write_file(folder / "c.toml", ideal_configuration());
    write_file(folder / "file", "");
    // A path below a file cannot be made, as anywhere that the system refuses; root may write into read-only folders.
    for (const auto& command : {std::vector<std::string>{"--stack", "c.toml", "--out", "file/out"},
                                {"--image", "c.toml", "--z", "0", "--out", "file/a.tif"},
                                {"--layout", "c.toml", "file/a.svg"}}) {
        const auto result = run_program(command, folder);
        EXPECT_EQ(result.exit_code, 4) << command.front() << result.standard_error;
        EXPECT_THAT(result.standard_error, AllOf(HasSubstr("file"), HasSubstr("permissions")));
    }
}

TEST(ExitCode, OfAnOutputThatIsLostIsFour) {
    const auto folder = fresh_folder("full");
    write_file(folder / "c.toml", ideal_configuration());
    for (const char* arguments : {"--check c.toml --json", "--devices", "--check c.toml", "--help"}) {
        const int status = std::system(
            fmt::format("cd '{}' && '{}' {} >/dev/full 2>error", folder.string(), program(), arguments).c_str());
        EXPECT_EQ(WEXITSTATUS(status), 4) << arguments;
        EXPECT_THAT(read_file(folder / "error"), HasSubstr("standard output cannot be written"));
    }
}

TEST(ExitCode, OfAnInterruptedStackIsTheSignals) {
    for (const auto& [signal, name] : {std::pair{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}) {
        const auto folder = fresh_folder(name);
        // After the first image the others take seconds, in which a busy machine lets this process come to its signal.
        write_file(folder / "c.toml", replaced(small_configuration, "rays = 2000", "rays = 3000000"));
        const pid_t child = fork();
        if (child == 0) {
            if (chdir(folder.c_str()) == 0 && freopen("error", "w", stderr) != nullptr) {
                execl(program().c_str(), "vkfv", "--stack", "c.toml", "--quiet", nullptr);
            }
            _exit(127);
        }
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (!fs::exists(folder / "out/images/z_0000.tif") && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        kill(child, signal);
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status));
        EXPECT_EQ(WTERMSIG(status), signal);
        EXPECT_THAT(read_file(folder / "error"),
                    AllOf(HasSubstr(fmt::format("ended by {}", name)), HasSubstr("of 5 images are stored in"),
                          HasSubstr("same command again")));
    }
}

// The reason for which a device was chosen is no part of a stack's identity.
TEST(Identity, IsTheDeviceAndNotTheReasonForIt) {
    const auto folder = fresh_folder("identity");
    write_file(folder / "c.toml", ideal_configuration() + without_waves);
    ASSERT_EQ(run_program({"--stack", "c.toml", "--quiet"}, folder).exit_code, 0);
    const auto again = run_program({"--stack", "c.toml", "--device", "0"}, folder);
    EXPECT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_THAT(again.standard_error, HasSubstr("0 images traced, 5 kept"));
    const std::string stack = read_file(folder / "out/stack.toml");
    for (const char* key :
         {"device", "vendor_id", "device_id", "driver", "traversal", "kernels_digest", "instrument_digest"}) {
        EXPECT_THAT(stack, HasSubstr(fmt::format("\n#: {} = ", key)));
    }
    // A program with other kernels is told by name.
    const auto place = stack.find("#: kernels_digest = \"") + 21;
    std::string other = stack;
    other[place] = other[place] == '0' ? '1' : '0';
    write_file(folder / "out/stack.toml", other);
    const auto refused = run_program({"--stack", "c.toml"}, folder);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.standard_error, HasSubstr("made.kernels_digest: "));
    const auto on_host = run_program({"--stack", "c.toml", "--device", "host"}, folder);
    EXPECT_EQ(on_host.exit_code, 2);
    EXPECT_THAT(on_host.standard_error, HasSubstr("made.device: "));
}

TEST(Results, TellTheRaysOfTheLedger) {
    const auto folder = fresh_folder("rays");
    write_file(folder / "c.toml", ideal_configuration() + without_waves);
    ASSERT_EQ(
        run_program({"--stack", "c.toml", "--quiet", "--estimator", "backward", "--rays", "5000"}, folder).exit_code,
        0);
    const auto results = nlohmann::json::parse(read_file(folder / "out/results.json"));
    // Each of 8 x 8 pixels has 79 paths, rounded up to two lattices of 64.
    EXPECT_EQ(results["rays_per_image"], 8192);
    EXPECT_THAT(read_file(folder / "out/ledger.csv"), HasSubstr("\n0,-2,8192,"));
    for (const char* key : {"evaluation_seconds", "trace_seconds", "rays_per_second", "images_traced"}) {
        EXPECT_FALSE(results.contains(key)) << key;
    }
    EXPECT_THAT(read_file(folder / "out/timings.csv"), AllOf(HasSubstr("\nimage 4,"), HasSubstr("\nevaluation,")));
}

} // namespace
} // namespace vkfv::test
