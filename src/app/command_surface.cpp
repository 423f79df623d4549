#include "app/commands.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/surface/surface_measurement.hpp"

#include "core/mathematics/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

struct SurfaceOptions {
    std::optional<double> unit;               // mm per unit of an image's value
    std::optional<surface::ProfileLine> line; // none: the middle row
    surface::ProfileSetting setting;
    std::optional<dimensions::Sought> sought;
    measurement::AskedRatios asked;
};

void take_ratio_height(CommandOptions& options, double um) {
    if (!std::isfinite(um)) {
        refuse_argument(fmt::format("--smr_um {}", um), "a height over the mean height, in um", "Correct it.");
    }
    options.of<SurfaceOptions>().asked.height = um / um_per_mm;
}

void take_ratio(CommandOptions& options, double percent) {
    if (!(percent >= 0 && percent <= 100)) {
        refuse_argument(fmt::format("--smc_percent {}", percent), "a material ratio from 0 to 100", "Correct it.");
    }
    options.of<SurfaceOptions>().asked.ratio = percent / 100;
}

void take_profile_filter(CommandOptions& options, double um) {
    auto& setting = options.of<SurfaceOptions>().setting;
    if (!(std::isfinite(um) && um >= 0)) {
        refuse_argument(fmt::format("--profile_filter_um {}", um), "a positive length, or 0 for no filter",
                        "Correct it, or leave it out for a fifth of the profile.");
    }
    if (setting.kind != surface::ProfileSetting::Kind::fifth) {
        refuse_argument("--profile_filter_um with --profile_setting", "one of both", "Leave one out.");
    }
    setting = {.kind = surface::ProfileSetting::Kind::nesting_index, .nesting_index = um / um_per_mm};
}

void take_profile_setting(CommandOptions& options, const std::string& name) {
    auto& setting = options.of<SurfaceOptions>().setting;
    if (name == "fifth") {
        return;
    }
    if (setting.kind != surface::ProfileSetting::Kind::fifth) {
        refuse_argument("--profile_setting with --profile_filter_um", "one of both", "Leave one out.");
    }
    if (name == "by-Ra") {
        setting.kind = surface::ProfileSetting::Kind::by_ra;
    }
    for (std::size_t k = 0; k < surface::setting_classes.size(); ++k) {
        if (name == surface::setting_classes[k].name) {
            setting = {.kind = surface::ProfileSetting::Kind::by_class, .setting_class = k};
        }
    }
}

void take_profile(CommandOptions& options, const std::string& text) {
    if (text.empty()) {
        return;
    }
    std::array<double, 4> ends{};
    const char *at = text.data(), *end = text.data() + text.size();
    for (std::size_t k = 0; k < ends.size(); ++k) {
        const auto [after, error] = std::from_chars(at, end, ends[k]);
        const bool last = k + 1 == ends.size();
        if (error != std::errc() || !std::isfinite(ends[k]) || (last ? after != end : after == end || *after != ',')) {
            refuse_argument("--profile " + text, "four numbers X0,Y0,X1,Y1 in um",
                            "Write for example --profile 0,50,100,50.");
        }
        ends[k] /= um_per_mm;
        at = after + 1;
    }
    options.of<SurfaceOptions>().line = surface::ProfileLine{ends[0], ends[1], ends[2], ends[3]};
}

void take_sought(CommandOptions& options, const std::string& name) {
    const auto& names = dimensions::sought_names;
    options.of<SurfaceOptions>().sought =
        static_cast<dimensions::Sought>(std::ranges::find(names, name) - names.begin());
}

} // namespace

Command surface_command() {
    const Option unit = {.name = "--unit_um,--unit-um",
                         .value = "UM",
                         .description = "Height of a value of one, of an image, array or table",
                         .target = in_mm(&SurfaceOptions::unit)};
    const Option profile = {.name = "--profile",
                            .value = "X0,Y0,X1,Y1",
                            .description = "Ends of the profile in um",
                            .target = Take<std::string>(take_profile),
                            .fallback = "the middle row"};
    const Option profile_filter = {
        .name = "--profile_filter_um,--profile-filter-um",
        .value = "UM",
        .description = "Nesting index of the profile's own Gaussian L-filter, after those of the surface; 0: none",
        .target = Take<double>(take_profile_filter),
        .fallback = "a fifth of the profile"};
    const Option profile_setting = {
        .name = "--profile_setting,--profile-setting",
        .value = "NAME",
        .description = "Filters and evaluation length of the profile by the setting classes of ISO 21920-3, nesting "
                       "indices of 0.08, 0.25, 0.8, 2.5 and 8 mm, by-Ra or named",
        .target = Take<std::string>(take_profile_setting),
        .fallback = "fifth",
        .choices = {"fifth", "by-Ra", "Sc1", "Sc2", "Sc3", "Sc4", "Sc5"}};
    const Option ratio_height = {.name = "--smr_um,--smr-um",
                                 .value = "C",
                                 .description =
                                     "Also the material ratios Smr(c) and Rmr(c) at this height over the mean height",
                                 .target = Take<double>(take_ratio_height)};
    const Option ratio = {.name = "--smc_percent,--smc-percent",
                          .value = "MR",
                          .description =
                              "Also the heights Smc(mr) and Rmc(mr), over the mean height, of this material ratio",
                          .target = Take<double>(take_ratio)};
    const Option sought = {.name = "--dimensions",
                           .value = "NAME",
                           .description =
                               "Dimensions of a standard, wherever it lies: step height, groove depth and width, "
                               "amplitude and period, pitch and depth, pitches and angle, radius and form "
                               "deviation, flatness; of the heights as they were read",
                           .target = Take<std::string>(take_sought),
                           .choices = {dimensions::sought_names.begin(), dimensions::sought_names.end()}};
    return {.name = "surface",
            .summary = "A surface file (X3P, SUR, SDF, AL3D, GWY, GSF, PLU, OPD, DAT, NMS, NPY, CSV, XYZ, TIFF, EXR): "
                       "form removed and filtered, its ISO 25178-2 "
                       "parameters; with --out also written, in another format if so named",
            .operands = {{"FILE", "Surface", into(&CommandOptions::file)}},
            .options =
                together({{out_option("A .x3p, .sur, .sdf, .gwy, .gsf, .csv, .npy, .tif or .ply file"), json_option()},
                          band_options(),
                          {pitch_option(), unit, profile, profile_filter, profile_setting, ratio_height, ratio, sought,
                           accept_checksum_option()}}),
            .run = run_surface,
            .example = "vkfv surface measured.x3p --form polynomial-2 --s_filter_um 5 --out treated.sur"};
}

void run_surface(const CommandOptions& options) {
    const auto own = options.of<SurfaceOptions>();
    const auto figures =
        measurement::measure_surface({.file = options.file,
                                      .scale = {.pitch = options.of<PixelPitch>().value, .unit = own.unit},
                                      .accept_checksum = options.of<AcceptChecksum>().value,
                                      .band = options.of<surface::Band>(),
                                      .line = own.line,
                                      .setting = own.setting,
                                      .sought = own.sought,
                                      .asked = own.asked,
                                      .out = options.out});
    print_text(options.json ? json_text(measurement::surface_json(figures, options.file)) + "\n"
                            : measurement::surface_text(figures));
}

} // namespace vkfv::app
