// vkfv --bench as a user calls it.
#include "app/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace vkfv;

TEST(Bench, reports_what_it_measured_as_json_and_picture) {
    const auto folder = test::fresh_folder("bench");
    test::write_file(folder / "c.toml", test::small_configuration);
    const auto result = test::run_program({"--bench", "c.toml", "--quick", "--runs", "2", "--bench-parts",
                                           "validation,stages,whole", "--commit", "abc", "--json", "--out", "out"},
                                          folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto report = nlohmann::json::parse(result.standard_output);
    EXPECT_EQ(report, nlohmann::json::parse(test::read_file(folder / "out" / "bench.json")));
    EXPECT_EQ(report["commit"], "abc");
    // Quadtree against bvh, ray query and backward paths, and the twin that must be found apart.
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

TEST(Bench, refuses_parts_that_there_are_not_and_a_peer_that_fails) {
    const auto folder = test::fresh_folder("bench_refused");
    test::write_file(folder / "c.toml", test::small_configuration);
    EXPECT_EQ(test::run_program({"--bench", "c.toml", "--bench-parts", "nonsense"}, folder).exit_code, 2);
    const auto failed = test::run_program(
        {"--bench", "c.toml", "--quick", "--bench-parts", "validation", "--peer", "/bin/false"}, folder);
    EXPECT_EQ(failed.exit_code, 4);
    EXPECT_NE(failed.standard_error.find("/bin/false failed"), std::string::npos) << failed.standard_error;
}
