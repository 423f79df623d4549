// vkfv bench runs as a user calls it, and agrees with its peer.
#include "app/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

using namespace vkfv;

TEST(Bench, ReportsWhatItMeasuredAsJsonAndPicture) {
    const auto folder = test::fresh_folder("bench");
    test::write_file(folder / "c.toml", test::small_configuration);
    const auto result = test::run_program({"--bench", "c.toml", "--quick", "--runs", "2", "--bench-parts",
                                           "validation,stages,whole", "--commit", "abc", "--json", "--out", "out"},
                                          folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto report = nlohmann::json::parse(result.standard_output);
    EXPECT_EQ(report, nlohmann::json::parse(test::read_file(folder / "out" / "bench.json")));
    EXPECT_EQ(report["commit"], "abc");
    // The four checks are quadtree against bvh, ray query and backward paths, and the twin that must be found apart.
    EXPECT_EQ(report["validation"].size(), 4u);
    for (const auto& check : report["validation"]) {
        EXPECT_TRUE(check["agrees"].get<bool>()) << check;
    }
    const auto& whole = report["whole"];
    const double rays = whole["rays"], seconds = whole["seconds"];
    EXPECT_DOUBLE_EQ(whole["rays_per_second"].get<double>(), rays / seconds);
    EXPECT_DOUBLE_EQ(whole["seconds_per_1e9_rays"].get<double>(), 1e9 * seconds / rays);
    EXPECT_GE(whole["wall_seconds"].get<double>(), seconds);
    EXPECT_GT(whole["surfaces_per_ray"].get<double>(), 1);
    double shares = 0;
    for (const auto& [name, share] : report["stages"]["shares"].items()) {
        EXPECT_GE(share.get<double>(), 0) << name;
        shares += share.get<double>();
    }
    EXPECT_GT(shares, 0.5); // 1, but for what other programs do to the clock between the forms that are timed
    const auto picture = test::read_file(folder / "out" / "bench.svg");
    EXPECT_NE(picture.find("illumination"), std::string::npos);
    EXPECT_NE(picture.find("</svg>"), std::string::npos);
}

// The peer traces by Embree and lenses in double: it shares no physics with vkfv, only the instrument that both are
// told of.
TEST(Bench, AgreesWithItsPeerAndTimesIt) {
    const auto folder = test::fresh_folder("bench_peer");
    test::write_file(folder / "c.toml", test::small_configuration);
    const std::string peer = VKFV_BINARY_DIR "/vkfv_bench_peer";
    const std::vector<std::string> words = {"--bench", "c.toml", "--quick",       "--runs",
                                            "1",       "--json", "--out",         "out",
                                            "--peer",  peer,     "--bench-parts", "validation,peer"};
    for (const char* bounces : {"1", "4"}) { // aimed into a rectangle, into a disc
        auto all = words;
        all.insert(all.end(), {"--set", std::string("trace.max_bounces=") + bounces});
        const auto result = test::run_program(all, folder);
        ASSERT_EQ(result.exit_code, 0) << result.standard_error;
        const auto report = nlohmann::json::parse(result.standard_output);
        const auto& last = report["validation"].back();
        EXPECT_EQ(last["what"], "quadtree against the peer");
        EXPECT_TRUE(last["agrees"].get<bool>()) << last;
        EXPECT_GT(report["peer"]["rays_per_second"].get<double>(), 0);
    }
    // The twin must be found apart, and then nothing is timed.
    const auto twin = folder / "twin";
    test::write_file(twin, "#!/bin/sh\nexec " + peer + " \"$@\" --set specimen.material.g=0.6\n");
    std::filesystem::permissions(twin, std::filesystem::perms::owner_all);
    auto apart = words;
    *std::ranges::find(apart, peer) = twin.string();
    const auto result = test::run_program(apart, folder);
    EXPECT_EQ(result.exit_code, 4);
    const auto first = result.standard_error.find("[\n");
    ASSERT_NE(first, std::string::npos) << result.standard_error;
    const auto last = result.standard_error.rfind(']');
    auto checks = nlohmann::json::parse(result.standard_error.substr(first, last - first + 1));
    EXPECT_FALSE(checks.back()["agrees"].get<bool>()) << checks;
    checks.erase(checks.size() - 1);
    for (const auto& check : checks) {
        EXPECT_TRUE(check["agrees"].get<bool>()) << check;
    }
}

TEST(Bench, RefusesPartsThatThereAreNotAndAPeerThatFails) {
    const auto folder = test::fresh_folder("bench_refused");
    test::write_file(folder / "c.toml", test::small_configuration);
    EXPECT_EQ(test::run_program({"--bench", "c.toml", "--bench-parts", "nonsense"}, folder).exit_code, 2);
    const auto failed = test::run_program(
        {"--bench", "c.toml", "--quick", "--bench-parts", "validation", "--peer", "/bin/false"}, folder);
    EXPECT_EQ(failed.exit_code, 4);
    EXPECT_NE(failed.standard_error.find("/bin/false failed"), std::string::npos) << failed.standard_error;
}
