// A stack killed with SIGKILL again and again ends in the same bytes as one that ran through. The victim is
// this very program, started anew with another main job, so that no thread of the test shares its fate.
#include "fake_stack.hpp"

#include <gtest/gtest.h>

#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <csignal>
#include <random>

extern char** environ;

namespace fs = std::filesystem;
using namespace vkfv::scan::test;

namespace {

constexpr int images = 32;
constexpr int kills = 10;
constexpr const char* victim_flag = "--run-fake-stack";

// A file beside the folder: it says that the victim is past the start of its libraries.
fs::path sign_of_life(const fs::path& folder) {
    return folder.string() + ".alive";
}

int run_victim(const char* folder) {
    write_bytes(sign_of_life(folder), "");
    run(folder, FakeTracer(1, std::chrono::milliseconds(4)), describe(images));
    return 0;
}

pid_t start_victim(const fs::path& folder) {
    std::string program = fs::read_symlink("/proc/self/exe").string();
    std::string flag = victim_flag;
    std::string argument = folder.string();
    std::array<char*, 4> arguments{program.data(), flag.data(), argument.data(), nullptr};
    pid_t process = 0;
    if (posix_spawn(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) {
        throw std::runtime_error("the victim cannot be started");
    }
    return process;
}

int stored_images(const fs::path& folder) {
    int count = 0;
    for (int image = 0; image < images; ++image) {
        count += fs::exists(folder / vkfv::scan::image_path(image)) ? 1 : 0;
    }
    return count;
}

TEST(Kill, AKilledStackEndsInTheSameBytes) {
    const FreshFolder whole("through");
    const FreshFolder folder("killed");
    run(whole.path(), FakeTracer(), describe(images));

    std::mt19937 generator(20);
    std::uniform_int_distribution<int> delay_us(0, 10000); // an image takes about five milliseconds
    int kills_between = 0;                                 // with some images stored and some not
    for (int run = 0; run <= kills; ++run) {
        const int before = stored_images(folder.path());
        fs::remove(sign_of_life(folder.path()));
        const pid_t victim = start_victim(folder.path());
        const bool to_be_killed = run < kills;
        // Half of the kills fall into the opening of the folder, half after a new image.
        const auto it_is_time = [&] {
            return run % 2 == 0 ? fs::exists(sign_of_life(folder.path())) : stored_images(folder.path()) > before;
        };
        int status = 0;
        pid_t ended = 0; // the victim's once it has been waited for
        while (to_be_killed && ended == 0 && !it_is_time()) {
            std::this_thread::sleep_for(std::chrono::microseconds(300));
            ended = waitpid(victim, &status, WNOHANG);
        }
        if (to_be_killed && ended == 0) {
            std::this_thread::sleep_for(std::chrono::microseconds(delay_us(generator)));
            kill(victim, SIGKILL);
        }
        if (ended == 0) {
            waitpid(victim, &status, 0);
        }
        if (!to_be_killed) {
            ASSERT_TRUE(WIFEXITED(status));
            ASSERT_EQ(WEXITSTATUS(status), 0);
        }
        const int stored = stored_images(folder.path());
        kills_between += to_be_killed && stored > 0 && stored < images ? 1 : 0;
    }
    fs::remove(sign_of_life(folder.path()));
    // The first kills cannot find a finished stack: they let through a handful of images each.
    EXPECT_GE(kills_between, 2);
    EXPECT_EQ(stored_images(folder.path()), images);
    EXPECT_EQ(differing_files(result_of(folder.path()), result_of(whole.path())), "");

    // The wrong twin has one image of another seed, which does not pass for the same.
    const FreshFolder other("seed");
    run(other.path(), FakeTracer(2), describe(images));
    fs::copy_file(other.path() / "images/z_0007.tif", folder.path() / "images/z_0007.tif",
                  fs::copy_options::overwrite_existing);
    EXPECT_EQ(differing_files(result_of(folder.path()), result_of(whole.path())), "images/z_0007.tif ");
}

} // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::string(argv[1]) == victim_flag) {
        return run_victim(argv[2]);
    }
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
