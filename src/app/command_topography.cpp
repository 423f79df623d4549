#include "app/commands.hpp"
#include "app/evaluation.hpp"

#include "scan/store.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <numeric>
#include <random>

namespace vkfv::app {

namespace {

// The images' numbers, in their order or in a random one: Fisher and Yates's shuffle, by the bits of the
// generator alone, so that a seed means the same order everywhere.
std::vector<int> order_of_images(std::size_t count, const std::optional<std::uint64_t>& shuffle) {
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    if (shuffle) {
        std::mt19937_64 random(*shuffle);
        for (std::size_t last = count; last > 1; --last) {
            std::swap(order[last - 1], order[random() % last]);
        }
    }
    return order;
}

} // namespace

void run_topography(const CommandOptions& options) {
    // stack.toml is a configuration; --set topography.window_px=9 and its like evaluate otherwise.
    const auto& folder = options.file;
    const auto configuration = load_configuration(folder / "stack.toml", options.overrides, Needs::stack);
    const auto positions = configuration.scan->positions();
    const auto specimen = specimen::make(*configuration.specimen);
    const auto instrument = assemble_instrument(configuration, specimen, positions);
    const auto order = order_of_images(positions.size(), options.shuffle);
    const auto evaluation = evaluate(configuration, instrument, specimen, [&](int place) {
        const int image = order[static_cast<std::size_t>(place)];
        return scan::read_frame(folder, image, positions[static_cast<std::size_t>(image)]);
    });
    if (options.shuffle && !options.out) {
        // A control is no result of the stack.
        fmt::print("{}images shuffled, nothing written\n", summary(evaluation));
        return;
    }
    const auto destination = options.out.value_or(folder);
    std::filesystem::create_directories(destination);
    auto more = nlohmann::ordered_json::object();
    if (options.shuffle) {
        more["shuffle_seed"] = *options.shuffle;
    }
    write_evaluation(destination, evaluation, more);
    fmt::print("{}results in {}\n", summary(evaluation), destination.string());
}

} // namespace vkfv::app
