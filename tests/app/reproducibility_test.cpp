// A stack has the same bits however it came about, and an image is the same by either traversal.
#include "app/program.hpp"
#include "images/image_file.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace vkfv::test {
namespace {

const std::filesystem::path source_folder = VKFV_SOURCE_DIR;
const std::string demo = (source_folder / "assets/stacks/demo.toml").string();

// A stack of nine images of the demo's microscope and specimen.
std::vector<std::string> short_stack(const std::string& out, std::vector<std::string> further = {}) {
    std::vector<std::string> arguments = {"--stack",
                                          demo,
                                          "--out",
                                          out,
                                          "--rays",
                                          "30000",
                                          "--quiet",
                                          "--set",
                                          "scan.z_start_um=-8",
                                          "--set",
                                          "scan.z_stop_um=8",
                                          "--set",
                                          "scan.z_step_um=2"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return arguments;
}

// Every file but the timings, by name.
std::map<std::string, std::string> bytes_of(const std::filesystem::path& folder) {
    std::map<std::string, std::string> bytes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file() && !entry.path().filename().string().starts_with("timings")) {
            bytes[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
        }
    }
    return bytes;
}

// The bytes of all files that name neither their folder, as pictures and reports do, nor the batch, as the
// configuration does, and of which no checksum depends on those.
std::map<std::string, std::string> bytes_but_names(const std::filesystem::path& folder) {
    auto bytes = bytes_of(folder);
    for (const char* name : {"topography.svg", "report.html", "stack.toml", ".stack.toml", "checksums.sha256"}) {
        EXPECT_EQ(bytes.erase(name), 1u) << name;
    }
    return bytes;
}

std::size_t images_in(const std::filesystem::path& folder) {
    std::error_code missing;
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "images", missing)) {
        count += entry.path().extension() == ".tif" && entry.path().filename().string().front() != '.' ? 1 : 0;
    }
    return count;
}

// Starts the program and kills it with SIGKILL once `images` are there; returns whether it was still running then.
bool run_and_kill(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                  const std::filesystem::path& stack, std::size_t images) {
    const pid_t child = fork();
    if (child == 0) {
        std::vector<char*> words = {const_cast<char*>("vkfv")};
        for (const auto& argument : arguments) {
            words.push_back(const_cast<char*>(argument.c_str()));
        }
        words.push_back(nullptr);
        if (chdir(folder.c_str()) == 0) {
            execv(program().c_str(), words.data());
        }
        _exit(127);
    }
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    int status = 0;
    while (images_in(stack) < images && waitpid(child, &status, WNOHANG) == 0 &&
           std::chrono::steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const bool running = kill(child, SIGKILL) == 0 && waitpid(child, &status, 0) == child;
    return running && WIFSIGNALED(status);
}

} // namespace

TEST(Reproducibility, AKilledStackEndsInTheSameBytes) {
    const auto folder = fresh_folder("killed");
    ASSERT_EQ(run_program(short_stack("stack"), folder).exit_code, 0);
    const auto whole = bytes_of(folder / "stack");
    std::filesystem::remove_all(folder / "stack");
    EXPECT_TRUE(run_and_kill(short_stack("stack"), folder, folder / "stack", 2));
    EXPECT_TRUE(run_and_kill(short_stack("stack"), folder, folder / "stack", 5));
    EXPECT_LT(images_in(folder / "stack"), 9u); // it was cut off
    ASSERT_EQ(run_program(short_stack("stack"), folder).exit_code, 0);
    EXPECT_EQ(bytes_of(folder / "stack"), whole);
    EXPECT_TRUE(whole.contains("results.json") && whole.contains("checksums.sha256") && whole.contains("report.html"));
}

TEST(Reproducibility, BytesDoNotDependOnThreadsBatchOrRun) {
    const auto folder = fresh_folder("threads");
    ASSERT_EQ(run_program(short_stack("one"), folder, {{"LP_NUM_THREADS", "1"}}).exit_code, 0);
    ASSERT_EQ(run_program(short_stack("two"), folder, {{"LP_NUM_THREADS", "2"}}).exit_code, 0);
    ASSERT_EQ(run_program(short_stack("batch", {"--set", "trace.batch=7001"}), folder).exit_code, 0);
    ASSERT_EQ(run_program(short_stack("seed", {"--seed", "2"}), folder).exit_code, 0);
    const auto reference = bytes_but_names(folder / "one");
    EXPECT_EQ(bytes_but_names(folder / "two"), reference);
    EXPECT_EQ(bytes_but_names(folder / "batch"), reference);
    EXPECT_NE(bytes_but_names(folder / "seed"), reference); // wrong twin
}

TEST(Reproducibility, EveryRowOfTheLedgerCloses) {
    const auto folder = fresh_folder("ledger");
    ASSERT_EQ(run_program(short_stack("out"), folder).exit_code, 0);
    std::istringstream ledger(read_file(folder / "out/ledger.csv"));
    std::string line;
    std::getline(ledger, line);
    ASSERT_TRUE(line.ends_with("residual_W")) << line;
    int rows = 0;
    while (std::getline(ledger, line)) {
        ++rows;
        EXPECT_LT(std::abs(std::stod(line.substr(line.rfind(',') + 1))), 1e-12)
            << line; // of 1 W emitted, of which about 1e-3 W is traced
    }
    EXPECT_EQ(rows, 9);
}

// By every traversal the demo's paths meet the same facets, so the images differ only where a path's fate hangs on the
// last bit, far below their own noise.
TEST(Reproducibility, TheDemoIsTheSameByEveryTraversal) {
    const auto folder = fresh_folder("traversals");
    const auto image = [&](const std::string& name, const std::vector<std::string>& further) {
        std::vector<std::string> arguments = {"--image", demo,      "--z",   "0", "--rays",
                                              "300000",  "--quiet", "--out", name};
        arguments.insert(arguments.end(), further.begin(), further.end());
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        return images::read_image(folder / name).values;
    };
    const auto quadtree = image("quadtree.tif", {"--traversal", "quadtree"});
    const auto ray_query = image("ray_query.tif", {"--traversal", "ray-query"});
    const auto bvh = image("bvh.tif", {"--traversal", "bvh"});
    const auto other = image("other.tif", {"--traversal", "ray-query", "--seed", "9"});
    double sum = 0, difference = 0, difference_bvh = 0, noise = 0;
    for (std::size_t k = 0; k < quadtree.size(); ++k) {
        sum += quadtree[k];
        difference += std::abs(quadtree[k] - ray_query[k]);
        difference_bvh += std::abs(quadtree[k] - bvh[k]);
        noise += std::abs(quadtree[k] - other[k]);
    }
    EXPECT_GT(sum, 0);
    EXPECT_LT(difference, 2e-3 * sum);
    EXPECT_LT(difference_bvh, 2e-3 * sum);
    EXPECT_GT(noise, 0.1 * sum); // what independent paths differ by: the wrong twin
}

} // namespace vkfv::test
