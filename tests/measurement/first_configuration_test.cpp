// The text that `vkfv new` writes is taken back, its instrument is the one asked for, and its scan, texture and window
// suit it.
#include "measurement/beginning/first_configuration.hpp"

#include "configuration/configuration.hpp"
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "measurement/scene/assembly.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

namespace vkfv::measurement {
namespace {

DataSheets sheets(const char* objective, const char* camera, const char* light, const char* led,
                  const std::string& specimen) {
    return {.objective = parse_objective(objective),
            .camera = parse_camera(camera),
            .light = parse_light(light),
            .led = parse_led(led),
            .specimen = parse_specimen(specimen)};
}

const std::string measured = VKFV_SOURCE_DIR "/assets/specimens/letter_F.x3p";

TEST(FirstConfiguration, IsShortAndItsInstrumentIsTheOneAskedFor) {
    const DataSheets all[] = {sheets("20x/0.45", "IMX250", "ring", "green", "step:10um"),
                              sheets("50x/0.8", "IMX250", "coaxial", "460nm", measured),
                              sheets("telecentric:2x/0.1", "IMX548", "coaxial", "red", "sphere:1mm"),
                              sheets("10x_0.28", "2448x2048@3.45um", "ring:40-60mm@15mm", "white", "plane"),
                              sheets("5x/0.15", "2/3:2448x2048", "coaxial", "590nm/14nm", "sinusoid:2um/50um")};
    for (const DataSheets& given : all) {
        SCOPED_TRACE(given.objective.text);
        const std::string text = first_configuration(given, "my.toml");
        const auto lines = std::ranges::count(text, '\n');
        EXPECT_LE(lines, 48);
        const auto configuration = read_configuration(TomlTable::parse(text, "my.toml"));
        const auto instrument = assemble_instrument(configuration);
        const auto& first = instrument.first_order;
        EXPECT_NEAR(-first.magnification, given.objective.magnification, 0.01 * given.objective.magnification);
        EXPECT_NEAR(first.numerical_aperture, given.objective.numerical_aperture,
                    0.02 * given.objective.numerical_aperture);
        EXPECT_NEAR(first.pixel_pitch * um_per_mm, given.camera.pixel_um / given.objective.magnification,
                    0.01 * given.camera.pixel_um / given.objective.magnification);
        if (given.objective.kind != SheetObjective::Kind::prescription) { // glasses are not known at all wavelengths
            EXPECT_EQ(sentences_of(instrument.warnings), std::vector<std::string>());
        }
        // The scan reaches two depths of field and more beyond the specimen's height, and has at least three images
        // within one.
        const auto& scan = configuration.scan.value();
        EXPECT_LT(scan.positions().front(), -2 * first.depth_of_field);
        EXPECT_GT(scan.positions().back(), 2 * first.depth_of_field);
        EXPECT_LT(scan.z_step, first.depth_of_field / 3);
    }
}

TEST(FirstConfiguration, KeepsWhatDataSheetsStateOfTheObjective) {
    auto given = sheets("20x/0.45", "IMX250", "coaxial", "green", "step:10um");
    given.objective.tube_length = 180;
    given.objective.working_distance = 3.1;
    given.objective.parfocal_length = 45;
    const auto first =
        assemble_instrument(read_configuration(TomlTable::parse(first_configuration(given, "my.toml"), "my.toml")))
            .first_order;
    EXPECT_NEAR(first.efl_objective, 9, 1e-9);
    EXPECT_NEAR(first.working_distance, 3.1, 1e-9);
}

TEST(FirstConfiguration, RefusesWhatItCannotRead) {
    const auto message = [](auto parse) -> std::string {
        try {
            parse();
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    using testing::HasSubstr;
    EXPECT_THAT(message([] { parse_objective("20x"); }), HasSubstr("--objective"));
    EXPECT_THAT(message([] { parse_objective("20x/1.4"); }), HasSubstr("below 1"));
    EXPECT_THAT(message([] { parse_objective("10x_0.29"); }), HasSubstr("Did you mean 10x_0.28?"));
    EXPECT_THAT(message([] { parse_camera("IMX25"); }), HasSubstr("Did you mean IMX250?"));
    EXPECT_THAT(message([] { parse_camera("2448x2048"); }), HasSubstr("2448x2048@3.45um"));
    EXPECT_THAT(message([] { parse_light("ring:60-40mm@15mm"); }), HasSubstr("--light"));
    EXPECT_THAT(message([] { parse_light("ring:40-60mm@95deg"); }), HasSubstr("--light"));
    EXPECT_THAT(message([] { parse_led("460"); }), HasSubstr("--led"));
    EXPECT_THAT(message([] { parse_led("460nm/500nm"); }), HasSubstr("--led"));
    EXPECT_THAT(message([] { parse_specimen("step:10"); }), HasSubstr("step:10um"));
    EXPECT_THAT(message([] { parse_specimen("no_such_file.x3p"); }), HasSubstr("--specimen"));
    EXPECT_THAT(
        message([] { first_configuration(sheets("0.5x/0.02", "IMX250", "coaxial", "green", measured), "my.toml"); }),
        HasSubstr("larger magnification"));
}

} // namespace
} // namespace vkfv::measurement
