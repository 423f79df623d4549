#include "app/commands.hpp"

#include "core/files/file.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "optics/prescriptions/prescription_writer.hpp"
#include "optics/prescriptions/reversal.hpp"
#include "optics/prescriptions/zmx.hpp"
#include "optics/train/first_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

struct ImportOptions {
    std::vector<std::filesystem::path> glass_catalogs;
    std::optional<int> configuration;
    bool reverse = false;
};

} // namespace

Command import_command() {
    const Option catalogs = {.name = "--glass-catalog",
                             .value = "FILE.agf",
                             .description = "Glasses besides the built-in ones; may be repeated. A lens's own order of "
                                            "catalogues (GCAT) decides on a name that several have",
                             .target = into(&ImportOptions::glass_catalogs),
                             .file = true};
    const Option configuration = {.name = "--configuration",
                                  .value = "N",
                                  .description = "Which of several configurations, from 1; without it the active one",
                                  .target = into(&ImportOptions::configuration),
                                  .range = {1, 1000}};
    const Option reverse = {.name = "--reverse",
                            .value = "",
                            .description =
                                "Turn the lens round: an objective that is written from infinity towards its "
                                "focus must run from the specimen to the back",
                            .target = into(&ImportOptions::reverse)};
    return {.name = "import",
            .summary =
                "Write a Zemax lens as a prescription, to --out or standard output, and its focal lengths to the "
                "log. Objectives must run from the specimen to the back: --reverse turns others round",
            .operands = {{"LENS.zmx", "Lens of Zemax, sequential", into(&CommandOptions::file)}},
            .options = {out_option("The prescription"), json_option(), catalogs, configuration, reverse},
            .run = run_import,
            .example = "vkfv import lens.zmx --out lens.toml"};
}

namespace {

// Focal lengths in mm, as designers state them: the effective one in air, and the distance from the last vertex to the
// focal point in the medium behind the lens. They are infinite for an afocal lens.
struct FocalLengths {
    double effective = 0;
    double back = 0;
};

// Paraxial optics ignore the tilts and decentres of coordinate breaks, but count the distance along the axis.
FocalLengths focal_lengths(const optics::Prescription& lens, double wavelength_um) {
    optics::RayTransfer transfer;
    double index = lens.medium_before.index(wavelength_um);
    double distance = 0;
    for (const auto& surface : lens.surfaces) {
        for (const auto& change : surface.breaks) {
            distance += change.thickness;
        }
        const double index_after = surface.medium_after.index(wavelength_um);
        const double power = surface.ideal_power.value_or((index_after - index) * surface.curvature);
        transfer = transfer.then(optics::free_space(distance, index)).then({.c = -power});
        index = index_after;
        distance = surface.thickness;
    }
    return {.effective = optics::focal_length(transfer), .back = index * optics::back_focal_distance(transfer)};
}

} // namespace

void run_import(const CommandOptions& options) {
    auto glasses = optics::GlassCatalog::builtin();
    const auto& own = options.of<ImportOptions>();
    for (const auto& catalog : own.glass_catalogs) {
        glasses.add(catalog);
    }
    auto lens = optics::read_zmx(options.file, glasses, own.configuration);
    auto& prescription = lens.prescription;
    if (own.reverse) {
        prescription = optics::turned_round(prescription);
    }
    const auto focal = focal_lengths(prescription, lens.primary_wavelength_um);
    spdlog::info("{}: {} surfaces, wavelengths {} um, of which {} is the primary one", prescription.title,
                 prescription.surfaces.size(), fmt::join(lens.wavelengths_um, ", "), lens.primary_wavelength_um);
    if (std::isfinite(focal.effective)) {
        spdlog::info("effective focal length {:.9g} mm, back focal length {:.9g} mm at {} um", focal.effective,
                     focal.back, lens.primary_wavelength_um);
    } else {
        spdlog::info("afocal at {} um", lens.primary_wavelength_um);
    }

    if (lens.from_infinity && !own.reverse && std::isfinite(focal.effective) && focal.back > 0) {
        spdlog::warn(
            "{}: the lens is written from infinity towards its focus, as tube lenses are. An objective begins at "
            "the specimen: import it with --reverse",
            prescription.title);
    }

    const std::string text = optics::prescription_text(prescription);
    if (options.out) {
        write_file(*options.out, text);
    }
    if (options.json) {
        nlohmann::ordered_json report;
        report["name"] = prescription.name;
        report["title"] = prescription.title;
        report["surfaces"] = prescription.surfaces.size();
        report["wavelengths_um"] = lens.wavelengths_um;
        report["primary_wavelength_um"] = lens.primary_wavelength_um;
        report["efl_mm"] = focal.effective; // null: afocal
        report["bfl_mm"] = focal.back;
        print_text(json_text(report) + "\n");
    } else if (!options.out) {
        print_text(text);
    }
}

} // namespace vkfv::app
