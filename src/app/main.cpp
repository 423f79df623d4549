// The command line; the only main(). Every failure ends here, as a message on standard error and an exit
// code.
#include "app/commands.hpp"
#include "bench/bench.hpp"

#include "core/interruption.hpp"
#include "core/result_folder.hpp"
#include "core/units.hpp"
#include "vulkan/device.hpp"
#include "vulkan/failure.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <new>

namespace {

using vkfv::InputError;

enum ExitCode { done = 0, wrong_input = 2, no_device = 3, run_failed = 4, in_use = 5 };

struct Arguments {
    std::string stack, image, sweep, check, bench, topography, surface, verify, import_lens;
    std::vector<std::string> trace_rays, layout, compare;
    bool align = false;
    bool devices = false;
    double z_um = 0;
    std::optional<double> z_step_um, pitch_um, z_start_um, unit_um;
    std::string form = "plane", filter = "gaussian", profile;
    double s_filter_um = 0, l_filter_um = 0;
    std::string precision = "double";
    bool apertures = true;
    bool json = false, quiet = false;
    int runs = 5;
    std::optional<std::uint64_t> shuffle;
    bool quick = false;
    std::string out, device, traversal, estimator, rays, seed, peer, commit;
    std::vector<std::string> bench_parts = {"stages"};
    std::vector<std::string> settings, glass_catalogs;
};

[[noreturn]] void refuse(std::string found, std::string expected, std::string remedy) {
    vkfv::SourceLocation where;
    where.file = "command line";
    throw InputError({.where = where,
                      .key = "",
                      .found = std::move(found),
                      .expected = std::move(expected),
                      .remedy = std::move(remedy)});
}

void declare(CLI::App& app, Arguments& given) {
    app.set_version_flag("--version", std::string("vkfv ") + VKFV_VERSION);
    app.allow_extras(); // what is left over is refused below, with a suggestion
    const auto on_off = CLI::CheckedTransformer(std::map<std::string, bool>{{"on", true}, {"off", false}});

    const char* commands = "Commands (one of these)";
    app.add_option("--stack", given.stack,
                   "Trace a focus stack, reconstruct it and compare it with the truth; "
                   "continues an interrupted one")
        ->type_name("C.toml")
        ->group(commands);
    app.add_option("--image", given.image, "Trace one exposure, at --z")->type_name("C.toml")->group(commands);
    app.add_option("--sweep", given.sweep,
                   "Images or stacks for every combination of the parameters in [sweep]; continues an interrupted one")
        ->type_name("C.toml")
        ->group(commands);
    app.add_option("--topography", given.topography,
                   "Evaluate an existing stack: of vkfv, or images in a folder or a TIFF file")
        ->type_name("STACK")
        ->group(commands);
    app.add_option("--compare", given.compare,
                   "Height maps (any format that vkfv reads) against the truth: shift, deviation, transfer, ISO "
                   "25178-2 parameters; several "
                   "measurements of one field also give systematic and random part")
        ->expected(2, CLI::detail::expected_max_vector_size)
        ->option_text("MEASURED... TRUTH")
        ->group(commands);
    app.add_option("--surface", given.surface,
                   "A surface file (X3P, SUR, SDF, AL3D, TIFF, EXR): form removed and filtered, its ISO 25178-2 "
                   "parameters; with "
                   "--out also written, in another format if so named")
        ->type_name("FILE")
        ->group(commands);
    app.add_option("--verify", given.verify,
                   "Check that the files of a stack, a sweep or other results are whole and those that were written")
        ->type_name("FOLDER")
        ->group(commands);
    app.add_option("--check", given.check, "Validate and print first-order data; needs no device")
        ->type_name("C.toml")
        ->group(commands);
    app.add_option("--trace-rays", given.trace_rays,
                   "Trace given rays (x_mm,y_mm,z_mm,l,m,n) from the specimen to the detector; CSV on "
                   "standard output")
        ->expected(2)
        ->option_text("C.toml IN.csv")
        ->group(commands);
    app.add_option("--layout", given.layout,
                   "Draw the instrument to scale, with traced rays of illumination and imaging; needs no device")
        ->expected(2)
        ->option_text("C.toml OUT.svg")
        ->group(commands);
    app.add_flag("--devices", given.devices, "List devices, what each lacks and which would be used")->group(commands);
    app.add_option("--bench", given.bench, "Measure rays/s of a configuration's chain")
        ->type_name("C.toml")
        ->group(commands);

    app.add_option("--import", given.import_lens,
                   "Write a Zemax lens as a prescription, to --out or standard output, and its focal lengths to "
                   "the log. Objectives must run from the specimen to the back: turn others round in Zemax")
        ->type_name("LENS.zmx")
        ->group(commands);

    const char* common = "Instead of the configuration's values";
    app.add_option("--out", given.out,
                   "Output folder (--bench: of bench.json and bench.svg); for --image also a .tif file, for "
                   "--import the prescription, for --surface a .x3p, .sur, .sdf, .tif or .ply file")
        ->type_name("PATH")
        ->group(common);
    app.add_option("--device", given.device, "Index or part of a name; \"host\": the reference in double")
        ->type_name("DEVICE")
        ->group(common);
    app.add_option("--traversal", given.traversal, "auto, ray-query, quadtree or bvh")
        ->type_name("NAME")
        ->group(common);
    app.add_option("--estimator", given.estimator, "forward or backward")->type_name("NAME")->group(common);
    app.add_option("--rays", given.rays, "Rays launched per image, 1e7 or 10000000")->type_name("N")->group(common);
    app.add_option("--seed", given.seed, "Seed of the trace")->type_name("N")->group(common);
    app.add_option("--set", given.settings, "Any key of the configuration, e.g. --set specimen.material.g=0.65")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all()
        ->group(common);

    const char* specific = "For some commands";
    app.add_option("--z", given.z_um, "Height of the focal plane over best focus, um (--image)")
        ->type_name("UM")
        ->group(specific);
    // Options are dashed; those with a unit are spelled like the keys that carry it, and dashed too.
    app.add_option("--z_step_um,--z-step-um", given.z_step_um,
                   "Step from image to image of a stack without stack.toml; negative: they descend (--topography)")
        ->type_name("UM")
        ->group(specific);
    app.add_option("--pitch_um,--pitch-um", given.pitch_um,
                   "Distance of its pixels on the specimen (--topography; --surface of an image)")
        ->type_name("UM")
        ->group(specific);
    app.add_option("--z_start_um,--z-start-um", given.z_start_um,
                   "Height of its first image, 0 unless given (--topography)")
        ->type_name("UM")
        ->group(specific);
    app.add_option("--unit_um,--unit-um", given.unit_um, "Height of a pixel's value of one (--surface of an image)")
        ->type_name("UM")
        ->group(specific);
    app.add_option(
           "--form", given.form,
           "Removed first: none, plane (unless given), polynomial-1 to polynomial-20, sphere (--surface, --compare)")
        ->type_name("NAME")
        ->group(specific);
    app.add_option("--s_filter_um,--s-filter-um", given.s_filter_um,
                   "Nesting index of the S-filter: shorter waves are removed (--surface, --compare)")
        ->type_name("UM")
        ->group(specific);
    app.add_option("--l_filter_um,--l-filter-um", given.l_filter_um,
                   "Nesting index of the L-filter: longer waves are removed (--surface, --compare)")
        ->type_name("UM")
        ->group(specific);
    app.add_option("--filter", given.filter, "Which S-filter and L-filter (--surface, --compare)")
        ->check(CLI::IsMember({"gaussian", "spline"}))
        ->option_text("gaussian|spline")
        ->group(specific);
    app.add_option("--profile", given.profile, "Ends of the profile in um, the middle row unless given (--surface)")
        ->type_name("X0,Y0,X1,Y1")
        ->group(specific);
    app.add_option("--precision", given.precision, "double: on the host; float: on the device (--trace-rays)")
        ->check(CLI::IsMember({"double", "float"}))
        ->option_text("double|float")
        ->group(specific);
    app.add_option("--apertures", given.apertures, "off: nothing is vignetted (--trace-rays)")
        ->transform(on_off)
        ->option_text("on|off")
        ->group(specific);
    app.add_option("--runs", given.runs, "Runs whose median counts (--bench)")
        ->check(CLI::Range(1, 1000))
        ->option_text("N")
        ->group(specific);
    auto parts = vkfv::bench::bench_parts;
    parts.emplace_back("all");
    app.add_option("--bench-parts", given.bench_parts,
                   fmt::format("What to measure (--bench): {}; stages unless given", fmt::join(parts, ", ")))
        ->delimiter(',')
        ->check(CLI::IsMember(parts))
        ->option_text("LIST")
        ->group(specific);
    app.add_flag("--quick", given.quick, "Shorter runs and fewer sizes (--bench)")->group(specific);
    app.add_option("--peer", given.peer, "The program vkfv_bench_peer, to compare with (--bench)")
        ->type_name("PROGRAM")
        ->group(specific);
    app.add_option("--commit", given.commit, "What the report says was measured (--bench)")
        ->type_name("TEXT")
        ->group(specific);
    app.add_option("--shuffle", given.shuffle,
                   "Take the images in a random order: a control, which must find nothing (--topography)")
        ->type_name("SEED")
        ->group(specific);
    app.add_flag("--align", given.align, "Remove the lateral shift that was found (--compare)")->group(specific);
    app.add_option("--glass-catalog", given.glass_catalogs,
                   "Glasses besides the built-in ones; may be repeated (--import)")
        ->type_name("FILE.agf")
        ->expected(1)
        ->take_all()
        ->group(specific);
    app.add_flag("--json", given.json,
                 "Machine-readable output (--check, --compare, --surface, --devices, --bench, --import)")
        ->group(specific);
    app.add_flag("--quiet", given.quiet, "Only warnings and errors, no progress");

    app.footer("\nExamples\n"
               "  vkfv --stack assets/stacks/demo.toml --out demo\n"
               "  vkfv --check assets/stacks/demo.toml --json\n"
               "  vkfv --image assets/stacks/demo.toml --z -3.2 --rays 1e8\n"
               "  vkfv --topography images.tif --z_step_um 0.5 --pitch_um 0.9 --out measured\n"
               "  vkfv --surface measured.x3p --form polynomial-2 --s_filter_um 5 --out treated.sur\n"
               "\nExit codes: 0 done, 2 the input is wrong, 3 no usable device, 4 the run failed and can be "
               "resumed, 5 another run is writing there; 130, 143, 129 ended by SIGINT, SIGTERM, SIGHUP.");
}

// What CLI11 left over: an unknown option most likely meant the nearest known one.
void refuse_leftovers(const CLI::App& app) {
    const auto leftovers = app.remaining();
    if (leftovers.empty()) {
        return;
    }
    std::vector<std::string> known;
    for (const auto* option : app.get_options()) {
        known.push_back(option->get_name());
    }
    const auto meant = vkfv::nearest_word(leftovers.front(), known);
    refuse(leftovers.front(), "a known option",
           meant ? fmt::format("Did you mean {}? vkfv --help lists all.", *meant) : "vkfv --help lists all.");
}

vkfv::surface::Band band_from(const Arguments& given) {
    const auto form = vkfv::surface::parse_form(given.form);
    if (!form) {
        refuse("--form " + given.form, "none, plane, polynomial-1 to polynomial-20 or sphere",
               "Name one of these, or leave it out for a plane.");
    }
    for (const double um : {given.s_filter_um, given.l_filter_um}) {
        if (!(std::isfinite(um) && um >= 0)) {
            refuse(fmt::format("a nesting index of {} um", um), "a positive length, or 0 for no filter",
                   "Correct --s_filter_um or --l_filter_um.");
        }
    }
    if (given.l_filter_um > 0 && given.l_filter_um <= given.s_filter_um) {
        refuse(fmt::format("--s_filter_um {} with --l_filter_um {}", given.s_filter_um, given.l_filter_um),
               "an L-filter longer than the S-filter", "Exchange them, or leave one out.");
    }
    return {.s_filter = given.s_filter_um / vkfv::um_per_mm,
            .l_filter = given.l_filter_um / vkfv::um_per_mm,
            .spline = given.filter == "spline",
            .form = *form};
}

std::optional<vkfv::surface::ProfileLine> profile_line_from(const std::string& text) {
    if (text.empty()) {
        return std::nullopt;
    }
    std::array<double, 4> ends{};
    const char *at = text.data(), *end = text.data() + text.size();
    for (std::size_t k = 0; k < ends.size(); ++k) {
        const auto [after, error] = std::from_chars(at, end, ends[k]);
        const bool last = k + 1 == ends.size();
        if (error != std::errc() || !std::isfinite(ends[k]) || (last ? after != end : after == end || *after != ',')) {
            refuse("--profile " + text, "four numbers X0,Y0,X1,Y1 in um", "Write for example --profile 0,50,100,50.");
        }
        ends[k] /= vkfv::um_per_mm;
        at = after + 1;
    }
    return vkfv::surface::ProfileLine{ends[0], ends[1], ends[2], ends[3]};
}

vkfv::app::CommandOptions options_from(const Arguments& given) {
    vkfv::app::CommandOptions options;
    options.quiet = given.quiet;
    options.json = given.json;
    options.focal_height = given.z_um / vkfv::um_per_mm;
    options.float_precision = given.precision == "float";
    options.apertures = given.apertures;
    options.runs = given.runs;
    options.bench_parts = given.bench_parts;
    if (std::ranges::find(given.bench_parts, "all") != given.bench_parts.end()) {
        options.bench_parts = vkfv::bench::bench_parts;
    }
    options.quick = given.quick;
    options.peer = given.peer;
    options.commit = given.commit;
    options.shuffle = given.shuffle;
    options.compared_files.assign(given.compare.begin(), given.compare.end());
    options.align = given.align;
    const auto in_mm = [](const std::optional<double>& um) {
        return um ? std::optional(*um / vkfv::um_per_mm) : std::nullopt;
    };
    options.z_step = in_mm(given.z_step_um);
    options.pitch = in_mm(given.pitch_um);
    options.z_start = in_mm(given.z_start_um);
    options.unit = in_mm(given.unit_um);
    options.band = band_from(given);
    options.profile_line = profile_line_from(given.profile);
    options.glass_catalogs.assign(given.glass_catalogs.begin(), given.glass_catalogs.end());
    const auto override_with = [&](const std::string& option, const std::string& key, const std::string& value) {
        if (!value.empty()) {
            options.overrides.push_back({key, value, option});
        }
    };
    const auto quoted = [](const std::string& text) { return text.empty() ? text : vkfv::toml_quoted(text); };
    for (const auto& setting : given.settings) {
        const auto equals = setting.find('=');
        if (equals == std::string::npos) {
            refuse("--set " + setting, "KEY=VALUE", "Write for example --set trace.rays=1e8.");
        }
        options.overrides.push_back({setting.substr(0, equals), setting.substr(equals + 1), "--set"});
    }
    override_with("--rays", "trace.rays", given.rays);
    override_with("--seed", "trace.seed", given.seed);
    override_with("--traversal", "trace.traversal", quoted(given.traversal));
    override_with("--estimator", "trace.estimator", quoted(given.estimator));
    override_with("--device", "trace.device", quoted(given.device));
    if (!given.out.empty()) {
        options.out = given.out;
        override_with("--out", "output.directory", quoted(given.out));
    }
    return options;
}

// What would be without effect, or mean another thing than was meant.
void refuse_strays(const CLI::App& app, const std::string& command) {
    struct Owned {
        const char* option;
        std::vector<std::string> commands;
    };
    const std::vector<std::string> configured = {"--stack", "--image",      "--sweep",  "--topography",
                                                 "--check", "--trace-rays", "--layout", "--bench"};
    const std::vector<Owned> table = {
        {"--set", configured},
        {"--rays", configured},
        {"--seed", configured},
        {"--estimator", configured},
        {"--traversal", configured},
        {"--device", configured},
        {"--json", {"--check", "--compare", "--surface", "--devices", "--bench", "--import"}},
        {"--out", {"--stack", "--image", "--sweep", "--topography", "--compare", "--surface", "--bench", "--import"}},
        {"--z_step_um", {"--topography"}},
        {"--z_start_um", {"--topography"}},
        {"--pitch_um", {"--topography", "--surface"}},
        {"--unit_um", {"--surface"}},
        {"--profile", {"--surface"}},
        {"--form", {"--surface", "--compare"}},
        {"--filter", {"--surface", "--compare"}},
        {"--s_filter_um", {"--surface", "--compare"}},
        {"--l_filter_um", {"--surface", "--compare"}},
        {"--align", {"--compare"}},
        {"--shuffle", {"--topography"}},
        {"--precision", {"--trace-rays"}},
        {"--apertures", {"--trace-rays"}},
        {"--runs", {"--bench"}},
        {"--bench-parts", {"--bench"}},
        {"--quick", {"--bench"}},
        {"--peer", {"--bench"}},
        {"--commit", {"--bench"}},
        {"--glass-catalog", {"--import"}},
    };
    for (const auto& [option, commands] : table) {
        if (app.count(option) > 0 && std::ranges::find(commands, command) == commands.end()) {
            refuse(fmt::format("{} with {}", option, command), fmt::format("{}", fmt::join(commands, " or ")),
                   fmt::format("Leave {} out.", option));
        }
    }
}

void run(const CLI::App& app, const Arguments& given) {
    refuse_leftovers(app);
    auto options = options_from(given);
    struct Command {
        const char* option;
        std::filesystem::path file;
        void (*run)(const vkfv::app::CommandOptions&);
    };
    if (!given.trace_rays.empty()) {
        options.rays_file = given.trace_rays.back();
    }
    if (!given.layout.empty()) {
        options.picture_file = given.layout.back();
    }
    const std::vector<Command> commands = {
        {"--stack", given.stack, vkfv::app::run_stack},
        {"--image", given.image, vkfv::app::run_image},
        {"--sweep", given.sweep, vkfv::app::run_sweep},
        {"--topography", given.topography, vkfv::app::run_topography},
        {"--compare", "", vkfv::app::run_compare},
        {"--surface", given.surface, vkfv::app::run_surface},
        {"--verify", given.verify, vkfv::app::run_verify},
        {"--check", given.check, vkfv::app::run_check},
        {"--trace-rays", given.trace_rays.empty() ? "" : given.trace_rays.front(), vkfv::app::run_trace_rays},
        {"--layout", given.layout.empty() ? "" : given.layout.front(), vkfv::app::run_layout},
        {"--devices", "", vkfv::app::run_devices},
        {"--bench", given.bench, vkfv::app::run_bench},
        {"--import", given.import_lens, vkfv::app::run_import},
    };
    const Command* chosen = nullptr;
    for (const auto& command : commands) {
        if (app.count(command.option) == 0) {
            continue;
        }
        if (chosen) {
            refuse(fmt::format("{} and {}", chosen->option, command.option), "one command", "Run one after the other.");
        }
        chosen = &command;
    }
    if (!chosen) {
        refuse("no command",
               "one of --stack, --image, --sweep, --topography, --compare, --surface, --verify, --check, --trace-rays, "
               "--layout, --devices, --bench, --import",
               "vkfv --help tells what they do.");
    }
    if ((app.count("--z") > 0) != (chosen->run == vkfv::app::run_image)) {
        refuse(app.count("--z") > 0 ? "--z" : "--image without --z", "--z with --image, and only with it",
               "Give --z UM, the height of the focal plane over best focus, to --image.");
    }
    refuse_strays(app, chosen->option);
    options.file = chosen->file;
    chosen->run(options);
}

int report(const char* message, ExitCode code) {
    fmt::print(stderr, "vkfv: {}\n", message);
    return code;
}

int report_lost_output() {
    return report("standard output cannot be written to. Free space where it leads, and run the same command again",
                  run_failed);
}

// What a command says is part of what it was asked for.
bool standard_output_is_whole() {
    std::cout.flush();
    return std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

} // namespace

int main(int argument_count, char** argument_values) {
    vkfv::explain_interruptions();
    const vkfv::vulkan::DriverScope drivers;
    Arguments given;
    CLI::App app("vkfv: a virtual focus-variation microscope. It traces light through real lens prescriptions to a "
                 "specimen and back to a detector, position by position, and measures the topography from the images.",
                 "vkfv");
    try {
        declare(app, given);
        app.parse(argument_count, argument_values);
        spdlog::set_default_logger(spdlog::stderr_color_mt("vkfv"));
        spdlog::set_pattern("%^%l%$: %v");
        spdlog::set_level(given.quiet ? spdlog::level::warn : spdlog::level::info);
        run(app, given);
        return standard_output_is_whole() ? done : report_lost_output();
    } catch (const CLI::Success& request) { // --help, --version
        const int code = app.exit(request);
        return standard_output_is_whole() ? code : report_lost_output();
    } catch (const CLI::ParseError& error) {
        return report(fmt::format("command line: {}. vkfv --help lists all options.", error.what()).c_str(),
                      wrong_input);
    } catch (const InputError& error) {
        return report(error.what(), wrong_input);
    } catch (const vkfv::DeviceError& error) {
        return report(error.what(), no_device);
    } catch (const vkfv::FolderInUse& error) {
        return report(error.what(), in_use);
    } catch (const vkfv::RunError& error) {
        return report(error.what(), run_failed);
    } catch (const vk::SystemError& failure) {
        return report(vkfv::vulkan::run_error_of(failure).what(), run_failed);
    } catch (const std::filesystem::filesystem_error& error) {
        return report(fmt::format("{}. Check the path, its permissions and the free space, and run the same command "
                                  "again.",
                                  error.what())
                          .c_str(),
                      run_failed);
    } catch (const std::bad_alloc&) {
        return report("the host has not enough memory. Choose fewer pixels, fewer positions or a coarser specimen.",
                      run_failed);
    } catch (const std::exception& error) {
        if (std::ferror(stdout) != 0) { // fmt says so by an exception of its own
            return report_lost_output();
        }
        return report(fmt::format("unexpected failure: {}. Please report it with the command line and the "
                                  "configuration.",
                                  error.what())
                          .c_str(),
                      run_failed);
    }
}
