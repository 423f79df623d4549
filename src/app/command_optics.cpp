#include "app/commands.hpp"
#include "core/messages/json_text.hpp"
#include "core/messages/safe_text.hpp"
#include "measurement/instrument/wave_figures.hpp"
#include "measurement/instrument/wave_report.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/wave_limits.hpp"

#include "core/files/result_folder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace vkfv::app {

namespace {

struct OpticsOptions {
    std::optional<double> reach; // mm above and below best focus
};

} // namespace

Command optics_command() {
    const Option reach = {.name = "--z_range_um,--z-range-um",
                          .value = "UM",
                          .description = "How far above and below best focus",
                          .target = in_mm(&OpticsOptions::reach),
                          .fallback = "two depths of field"};
    return {.name = "optics",
            .summary = "Draw what waves make of a point on the axis, at the edge and in the corner of the field: "
                       "transfer function and point spread through focus, wavefront with its Zernike coefficients; "
                       "needs no device",
            .operands = {{"C.toml", "Configuration", into(&CommandOptions::file)}},
            .options = together({configuration_options(), {out_option("Output folder (default: C-optics)"), reach}}),
            .run = run_optics,
            .example = "vkfv optics assets/stacks/demo.toml --out optics"};
}

void run_optics(const CommandOptions& options) {
    const auto own = options.of<OpticsOptions>();
    if (own.reach && !(std::isfinite(*own.reach) && *own.reach > 0)) {
        refuse_argument(fmt::format("--z_range_um {}", *own.reach * um_per_mm), "a positive length",
                        "Correct it, or leave it out for two depths of field.");
    }
    const auto configuration = load_configuration(options.file, options.overrides, Needs::instrument);
    const auto instrument = measurement::assemble_for_figures(configuration);
    const std::string name = options.file.stem().string();
    ResultFolder results(options.out.value_or(name + "-optics"));
    const auto figures =
        measurement::wave_figures(instrument, own.reach.value_or(2 * instrument.first_order.depth_of_field));
    results.write("transfer.svg", measurement::transfer_picture(figures, name + ": transfer function"));
    results.write("transfer.csv", measurement::transfer_table(figures));
    results.write("point_spread.svg", measurement::spread_picture(figures, name + ": point spread"));
    results.write("point_spread.csv", measurement::spread_table(figures));
    results.write("encircled.csv", measurement::encircled_table(figures));
    results.write("wavefront.svg", measurement::wavefront_picture(figures, name + ": wavefront at z = 0"));
    results.write("wavefront.csv", measurement::wavefront_table(figures));
    results.write("zernike.csv", measurement::zernike_table(figures));
    auto json = measurement::wave_json(figures);
    std::string text = measurement::summary(figures);
    if (const auto& waves = configuration.trace.waves) {
        const auto limits = measurement::worst_of(measurement::limits_of_lights(*waves, instrument));
        json["images"] = measurement::json_of(limits);
        text += measurement::summary(limits);
    }
    results.write("optics.json", json_text(json) + "\n");
    results.write_checksums();
    print_text(text);
}

} // namespace vkfv::app
