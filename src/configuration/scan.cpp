// The table [scan]: its keys and its reader.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"

#include <fmt/format.h>

namespace vkfv {

namespace {

constexpr std::int64_t fewest_positions = 3; // the peak is a fit through three points

const NumberKey z_start =
    for_example("-12.0", NumberKey("z_start_um", NumberRange::finite(), needed, "Lowest height of the focal plane."));
const NumberKey z_stop =
    for_example("12.0", NumberKey("z_stop_um", NumberRange::finite(), needed, "Highest height of the focal plane."));
const NumberKey z_step =
    for_example("0.8", NumberKey("z_step_um", NumberRange::positive(), needed, "From image to image."));

} // namespace

const KeyTable& scan_keys() {
    static const KeyTable table{.path = "scan",
                                .presence = KeyTable::Presence::optional,
                                .meaning = "Heights of the focal plane of a stack, over best focus on the axis.",
                                .subject = "a scan",
                                .kind = "",
                                .keys = {&z_start, &z_stop, &z_step},
                                .shown = true};
    return table;
}

void read_scan(const TomlTable& root, Configuration& configuration) {
    const Section section(root.table("scan"), scan_keys(), configuration);
    const double start = section.number(z_start);
    const double stop = section.number(z_stop);
    const double step = section.number(z_step);
    if (stop < start) {
        section.fail(z_stop, fmt::format("a number >= z_start_um = {}", start),
                     "Exchange z_start_um and z_stop_um: a scan ascends.");
    }
    const scan::ScanPlan plan{from_um(start), from_um(stop), from_um(step)};
    const double positions = plan.position_count();
    if (positions < static_cast<double>(fewest_positions)) {
        section.fail(z_step,
                     fmt::format("at least {} focal positions from z_start_um = {} to z_stop_um = {}, found {}",
                                 fewest_positions, start, stop, positions),
                     "Choose a smaller z_step_um or a longer scan.");
    }
    if (positions > scan::most_positions) {
        section.fail(z_step, fmt::format("at most {} focal positions, found {}", scan::most_positions, positions),
                     "Choose a larger z_step_um or a shorter scan.");
    }
    configuration.scan = plan;
}

} // namespace vkfv
