// The table [trace]: its keys and its reader.
#include "configuration/ranges.hpp"
#include "configuration/tables.hpp"
#include "optics/instrument/turning.hpp"

namespace vkfv {

namespace {

using trace::Estimator;
using trace::Traversal;

constexpr std::int64_t most_rays = 1'000'000'000'000; // an hour for an image on the fastest device
constexpr std::int64_t most_bounces = 64;             // a Lambertian pit keeps 1e-3 of its light after ten

const IntegerKey rays("rays", 1, most_rays, 10'000'000, "Rays launched per image; 1e9 is an integer too.");
const IntegerKey seed("seed", 0, largest_seed, 1, "Seed of all random numbers of the trace.");
const IntegerKey max_bounces("max_bounces", 1, most_bounces, 2, "Most meetings of a path with the specimen.");
const ChoiceKey<bool> mode("mode",
                           {{false, "sequential", "light meets the surfaces in their order"},
                            {true, "nonsequential", "light finds its own way, and interfaces split it: ghosts"}},
                           false, "How light goes through the instrument.");
enum class WantedEstimator { automatic, forward, backward };
const ChoiceKey<WantedEstimator> estimator(
    "estimator",
    {{WantedEstimator::automatic, "auto",
      "backward where light can be traced so, else forward; results name the one taken"},
     {WantedEstimator::forward, "forward", "from the source to the detector"},
     {WantedEstimator::backward, "backward", "from the detector to the source: less noise for the same rays"}},
    WantedEstimator::automatic, "Which end paths start from.");
const ChoiceKey<bool>
    emission("emission",
             {{true, "directed",
               "only into directions that can pass the illuminator, and with max_bounces = 1 can reach the detector"},
              {false, "analog", "into the half space"}},
             true, "Where the source sends rays; what is not aimed at is in the ledger.");
const ChoiceKey<bool> scattering("scattering",
                                 {{false, "analog", "by the material's lobe alone"},
                                  {true, "directed", "every bounce also aims at the pupil, with weights"}},
                                 false, "Where the specimen sends rays.");
const ChoiceKey<Traversal> traversal = without_influence(
    ChoiceKey<Traversal>("traversal",
                         {{Traversal::automatic, "auto", "the fastest that the device has"},
                          {Traversal::ray_query, "ray-query", "VK_KHR_ray_query"},
                          {Traversal::quadtree, "quadtree", "a pyramid of a height field, or of a mesh that is one"},
                          {Traversal::bvh, "bvh", "a bounding volume hierarchy"}},
                         Traversal::automatic, "How rays find the specimen."));
const IntegerKey batch =
    without_influence(IntegerKey("batch", 0, most_rays, 0, "Rays in flight at once; 0: what suits the device."));
const TextKey device =
    without_influence(TextKey("device", Default::in_words("the best"),
                              "Index or part of the name of a Vulkan device; \"0,1\": both at a time; \"all\" that "
                              "are like the best; \"host\": the CPU reference in double precision."));

} // namespace

const KeyTable& trace_keys() {
    static const KeyTable table{
        .path = "trace",
        .presence = KeyTable::Presence::optional,
        .meaning = "How light is traced.",
        .subject = "a trace",
        .kind = "",
        .keys = {&rays, &seed, &max_bounces, &mode, &estimator, &emission, &scattering, &traversal, &batch, &device}};
    return table;
}

void read_trace(const TomlTable& root, Configuration& configuration) {
    const TomlTable table = root.table_or_empty("trace");
    const Section section(table, trace_keys(), configuration);
    auto& trace = configuration.trace;
    trace.rays = static_cast<std::uint64_t>(section.integer(rays));
    trace.seed = static_cast<std::uint32_t>(section.integer(seed));
    if (auto& camera = configuration.camera) {        // the camera's fixed patterns do not depend on trace.seed
        constexpr std::uint32_t golden = 0x9E3779B9u; // keeps sums of small seeds apart
        camera->noise_seed = camera->seed + golden * configuration.noise_seed.value_or(trace.seed);
    }
    trace.max_bounces = static_cast<int>(section.integer(max_bounces));
    trace.nonsequential = section.choice(mode);
    if (!trace.nonsequential && !configuration.instrument.meshes.empty()) {
        section.fail(mode, "\"nonsequential\" with [[mesh_element]], which light in a given sequence does not meet",
                     "Set mode = \"nonsequential\", or remove the mesh elements.");
    }
    // The order of the lines is part of a stack's identity, so `scattering`, which decides here too, is read below.
    const auto word = table.optional_choice(estimator.name, estimator.choice_names());
    const auto wanted = word ? estimator.value_of(*word) : estimator.value.value();
    configuration.estimator_is_chosen = wanted == WantedEstimator::automatic;
    const bool directed = table.optional_choice(scattering.name, scattering.choice_names()) == scattering.name_of(true);
    const bool turns = configuration.estimator_is_chosen
                           ? !trace.nonsequential && !directed && optics::can_turn_round(configuration.instrument)
                           : wanted == WantedEstimator::backward;
    trace.estimator = turns ? Estimator::backward : Estimator::forward;
    section.record(estimator,
                   toml_quoted(estimator.name_of(turns ? WantedEstimator::backward : WantedEstimator::forward)));
    if (trace.estimator == Estimator::backward) {
        configuration.instrument.turned = true;
        if (trace.nonsequential) {
            section.fail(estimator, "\"forward\" with mode = \"nonsequential\"",
                         "Choose estimator = \"forward\", or mode = \"sequential\".");
        }
    }
    configuration.instrument.directed_emission = section.choice(emission);
    configuration.instrument.single_scatter =
        trace.max_bounces == 1 && trace.estimator == Estimator::forward && !trace.nonsequential;
    trace.directed_scatter = section.choice(scattering);
    if (trace.directed_scatter && trace.nonsequential) {
        section.fail(scattering, "\"analog\" with mode = \"nonsequential\", whose light finds the pupil by itself",
                     "Choose scattering = \"analog\", or mode = \"sequential\".");
    }
    if (trace.directed_scatter && trace.estimator == Estimator::backward) {
        section.fail(scattering, "\"analog\" with estimator = \"backward\", which starts from the pupil",
                     "Choose scattering = \"analog\", or estimator = \"forward\".");
    }
    trace.traversal = section.choice(traversal);
    if (trace.nonsequential && trace.traversal == Traversal::quadtree) {
        section.fail(traversal, "a traversal that knows the instrument's elements too",
                     "Use \"auto\", \"bvh\" or \"ray-query\" with mode = \"nonsequential\".");
    }
    trace.batch = static_cast<std::uint64_t>(section.integer(batch));
    if (const auto selector = table.optional_string(device.name)) {
        trace.device = *selector;
        // Only the first device is recorded. The number of devices at work belongs to the run, and the results are
        // those of one device.
        if (*selector != "all") {
            section.record_reference(device, selector->substr(0, selector->find(',')));
        }
    }
}

} // namespace vkfv
