#include "app/commands.hpp"

#include "core/messages/log.hpp"

namespace vkfv::app {

std::vector<Command> commands() {
    return {stack_command(),   merge_command(),      image_command(),   sweep_command(),      calibrate_command(),
            budget_command(),  capability_command(), fit_command(),     topography_command(), compare_command(),
            surface_command(), verify_command(),     check_command(),   trace_rays_command(), layout_command(),
            optics_command(),  camera_command(),     devices_command(), bench_command(),      import_command(),
            new_command(),     list_command(),       keys_command(),    explain_command(),    template_command(),
            help_command(),    completion_command(), man_command()};
}

std::vector<TomlOverride> overrides_with_folder(const CommandOptions& options, const std::string& ending) {
    auto overrides = options.overrides;
    if (!options.out) {
        overrides.push_back({"output.directory", toml_quoted(options.file.stem().string() + ending), "command line"});
    }
    return overrides;
}

void tell_results(const std::filesystem::path& folder) {
    log_event("results", {{"folder", std::filesystem::absolute(folder).lexically_normal().string()}});
}

} // namespace vkfv::app
