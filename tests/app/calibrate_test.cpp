// vkfv calibrate measures standards in place of the specimen, goes on where it ended, and writes a certificate.
#include "app/program.hpp"
#include "core/files/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::vector<std::string> command = {"calibrate", "c.toml", "--small",  "--only", "N_M,alpha_z",
                                          "--out",     "out",    "--device", "host",   "--quiet"};

TEST(Calibrate, WritesACertificateAndGoesOnWhereItEnded) {
    const auto folder = fresh_folder("calibrate");
    write_file(folder / "c.toml", small_configuration);
    const auto first = run_program(command, folder);
    ASSERT_EQ(first.exit_code, 0) << first.standard_error;
    EXPECT_THAT(first.standard_output, HasSubstr("Measurement noise"));
    EXPECT_THAT(first.standard_output, HasSubstr("not traceable"));
    // Five steps of 1 um are too few for a groove: the certificate says so in place of a figure.
    EXPECT_THAT(first.standard_output, HasSubstr("no groove fits into it"));
    const auto certificate = nlohmann::json::parse(read_file(folder / "out/certificate.json"));
    ASSERT_EQ(certificate.at("characteristics").size(), 2u);
    const auto& noise = certificate.at("characteristics").at(0);
    EXPECT_EQ(noise.at("trials").size(), 5u);
    EXPECT_EQ(noise.at("figures").at(0).at("key"), "N_M_at_50_percent_nm");
    EXPECT_TRUE(certificate.at("characteristics").at(1).at("figures").empty());
    EXPECT_EQ(certificate.at("first_seed"), 1);
    const auto digital = read_file(folder / "out/certificate.xml");
    pugi::xml_document document;
    ASSERT_TRUE(document.load_buffer(digital.data(), digital.size()));
    EXPECT_THAT(digital, HasSubstr("not traceable"));
    EXPECT_EQ(document.select_nodes("//dcc:measurementResult").size(), 2u);
    EXPECT_EQ(document.select_nodes("//dcc:result//dcc:quantity").size(), noise.at("figures").size());
    const auto page = read_file(folder / "out/certificate.html");
    EXPECT_THAT(page, HasSubstr("not traceable"));
    EXPECT_THAT(page, HasSubstr("The instrument to scale"));

    // Repetitions without a camera are of other rays.
    const auto image = [&](const std::string& trial) { return folder / "out/N_M" / trial / "images/z_0002.tif"; };
    EXPECT_NE(read_file(image("contrast_50/repeat_00")), read_file(image("contrast_50/repeat_01")));

    // A second run traces only the stack whose folder was removed, and writes the same certificate.
    const auto kept = fs::last_write_time(image("contrast_50/repeat_01"));
    fs::remove_all(folder / "out/N_M/contrast_50/repeat_03");
    const auto bytes = read_file(folder / "out/certificate.json");
    fs::remove(folder / "out/certificate.json");
    const auto again = run_program(command, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_EQ(fs::last_write_time(image("contrast_50/repeat_01")), kept);
    EXPECT_EQ(read_file(folder / "out/certificate.json"), bytes);
    EXPECT_EQ(read_file(folder / "out/certificate.xml"), digital);
    EXPECT_EQ(run_program({"verify", "out"}, folder).exit_code, 0);
    EXPECT_EQ(run_program({"verify", "out/N_M/contrast_50/repeat_03"}, folder).exit_code, 0);

    // Standards that were begun with another instrument are not mixed with this one's.
    auto other = command;
    other.insert(other.end(), {"--set", "objective.prescription=20x_0.41"});
    const auto refused = run_program(other, folder);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.standard_error, HasSubstr("objective.prescription_digest"));
}

} // namespace
} // namespace vkfv::test
