#include "app/commands.hpp"
#include "app/evaluation.hpp"

#include "scan/store.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace vkfv::app {

void run_topography(const CommandOptions& options) {
    // stack.toml is a configuration; --set topography.window_px=9 and its like evaluate otherwise.
    const auto& folder = options.file;
    const auto configuration = load_configuration(folder / "stack.toml", options.overrides, Needs::stack);
    const auto positions = configuration.scan->positions();
    const auto specimen = specimen::make(*configuration.specimen);
    const auto instrument = assemble_instrument(configuration, specimen, positions);
    const auto evaluation = evaluate(configuration, instrument, specimen, [&](int image) {
        return scan::read_frame(folder, image, positions[static_cast<std::size_t>(image)]);
    });
    const auto destination = options.out.value_or(folder);
    std::filesystem::create_directories(destination);
    write_evaluation(destination, evaluation, nlohmann::ordered_json::object());
    fmt::print("{}results in {}\n", summary(evaluation), destination.string());
}

} // namespace vkfv::app
