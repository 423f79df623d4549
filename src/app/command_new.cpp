#include "app/commands.hpp"
#include "core/files/file.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/beginning/first_configuration.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace vkfv::app {

namespace {

struct NewOptions {
    std::string objective, camera, light, led, specimen; // empty: ask, or take the usual one
    std::optional<double> tube_length, working_distance, parfocal_length;
};

struct Question {
    std::string NewOptions::*answer;
    const char* option;
    const char* value;
    const char* asks; // sentence without its full stop
    const char* usual;
};

const Question questions[] = {
    {&NewOptions::objective, "--objective", "MxNA",
     "Magnification and numerical aperture, 20x/0.45 or telecentric:2x/0.1, or a name of vkfv list objectives",
     "20x/0.45"},
    {&NewOptions::camera, "--camera", "NAME",
     "A name of vkfv list cameras, 2448x2048@3.45um, or optical format and pixels, 2/3:2448x2048", "IMX250"},
    {&NewOptions::light, "--light", "KIND",
     "coaxial, ring, or a ring by its diameters and its height or elevation, ring:40-60mm@15mm, ring:40-60mm@30deg",
     "coaxial"},
    {&NewOptions::led, "--led", "COLOUR", "A colour of vkfv list leds, 460nm, or peak and width, 460nm/25nm", "green"},
    {&NewOptions::specimen, "--specimen", "KIND",
     "plane, step:10um, sphere:1mm, sinusoid:2um/50um, or the file of a measured surface", "step:10um"}};

Option length_option(std::string name, std::string description, std::optional<double> NewOptions::*length) {
    return {.name = std::move(name), .value = "MM", .description = std::move(description), .target = into(length)};
}

// Asks for each figure that no option gives, if a person sits at a terminal. An empty answer takes the usual one.
void ask(NewOptions& own) {
    const bool at_terminal = isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1;
    for (const Question& question : questions) {
        std::string& answer = own.*question.answer;
        if (answer.empty() && at_terminal) {
            fmt::print(stderr, "{}\n  {} [{}]: ", question.asks, question.option, question.usual);
            std::getline(std::cin, answer);
        }
        if (answer.empty()) {
            answer = question.usual;
        }
    }
}

void require_length(const char* option, const std::optional<double>& length, bool takes) {
    if (length && !(*length > 0 && *length < 1e6)) {
        refuse_argument(fmt::format("{} {}", option, *length), "a length in mm above 0", "Correct it.");
    }
    if (length && !takes) {
        refuse_argument(fmt::format("{} with this --objective", option),
                        "an ideal objective, 20x/0.45; --working_distance_mm of a telecentric one too",
                        fmt::format("Leave {} out.", option));
    }
}

void run_new(const CommandOptions& options) {
    auto own = options.of<NewOptions>();
    ask(own);
    measurement::DataSheets sheets{.objective = measurement::parse_objective(own.objective),
                                   .camera = measurement::parse_camera(own.camera),
                                   .light = measurement::parse_light(own.light),
                                   .led = measurement::parse_led(own.led),
                                   .specimen = measurement::parse_specimen(own.specimen)};
    using Kind = measurement::SheetObjective::Kind;
    const Kind kind = sheets.objective.kind;
    require_length("--tube_length_mm", own.tube_length, kind == Kind::ideal);
    require_length("--working_distance_mm", own.working_distance, kind != Kind::prescription);
    require_length("--parfocal_length_mm", own.parfocal_length, kind == Kind::ideal);
    sheets.objective.tube_length = own.tube_length.value_or(sheets.objective.tube_length);
    sheets.objective.working_distance = own.working_distance;
    sheets.objective.parfocal_length = own.parfocal_length;
    const std::string name = options.out ? options.out->filename().string() : "my.toml";
    const std::string text = measurement::first_configuration(sheets, name);
    if (!options.out) {
        print_text(text);
        return;
    }
    if (std::filesystem::exists(*options.out)) {
        refuse_argument(fmt::format("--out {}, which exists", options.out->string()), "the name of a new file",
                        "Choose another name, or remove the file.");
    }
    write_file(*options.out, text);
    spdlog::info("{} is written. Its first lines say what to try with it.", options.out->string());
}

} // namespace

Command new_command() {
    std::vector<Option> options;
    for (const Question& question : questions) {
        options.push_back({.name = question.option,
                           .value = question.value,
                           .description = question.asks,
                           .target = into(question.answer),
                           .fallback = question.usual});
    }
    options.push_back(length_option("--tube_length_mm,--tube-length-mm",
                                    "Focal length of the tube lens that the magnification is stated for; 200 unless "
                                    "given",
                                    &NewOptions::tube_length));
    options.push_back(length_option("--working_distance_mm,--working-distance-mm",
                                    "From the plane of focus to the objective's front", &NewOptions::working_distance));
    options.push_back(length_option("--parfocal_length_mm,--parfocal-length-mm",
                                    "From the plane of focus to the objective's shoulder",
                                    &NewOptions::parfocal_length));
    options.push_back(out_option("The configuration; without it, standard output"));
    return {.name = "new",
            .summary = "Write a configuration to begin with, from what data sheets say of objective, camera and light; "
                       "at a terminal it asks for what is not given",
            .options = std::move(options),
            .run = run_new,
            .example = "vkfv new --objective 20x/0.45 --camera IMX250 --light ring --specimen step:10um > my.toml",
            .about_vkfv = false,
            .also_option = false}; // its --camera differs from `vkfv --camera`
}

} // namespace vkfv::app
