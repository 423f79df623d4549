#include "trace/device/device_scene.hpp"
#include "optics/instrument/train_polynomials.hpp"
#include "trace/device/wave_memory.hpp"
#include "trace/interface/exposure_record.hpp"
#include "trace/structures/outward.hpp"

#include <bit>
#include <cmath>
#include <future>
#include <limits>
#include <utility>

namespace vkfv::trace {

namespace {

template <class Value>
vulkan::Buffer buffer_of(const vulkan::Device& device, const std::vector<Value>& values) {
    vulkan::Buffer buffer(device, values.size() * sizeof(Value));
    buffer.write_values(std::span<const Value>(values));
    return buffer;
}

template <class Record>
auto in_float(const std::vector<Record>& records) {
    std::vector<decltype(to_float(records.front()))> result;
    result.reserve(records.size());
    for (const Record& record : records) {
        result.push_back(to_float(record));
    }
    return result;
}

// The elements and facets in a device's memory. order: of the boxes of boxes_of().
ElementBuffers element_buffers(const vulkan::Device& device, const optics::Room& room,
                               const std::vector<std::uint32_t>& order) {
    const auto surfaces = static_cast<std::uint32_t>(room.surfaces);
    std::vector<std::uint32_t> held;
    held.reserve(order.size());
    for (const std::uint32_t box : order) {
        held.push_back(box < surfaces ? box : kernels::FACET_BIT | (box - surfaces));
    }
    auto facets = in_float(room.facets);
    facets.resize(std::max<std::size_t>(facets.size(), 1)); // a buffer must not be empty
    return {buffer_of(device, in_float(room.elements)), buffer_of(device, held), buffer_of(device, facets)};
}

// True if the forward and backward kernels have the instrument as constants: if it is small enough, and where that pays
// or is asked for.
bool pays_in_constants(const vulkan::Device& device, const optics::Instrument& instrument,
                       const TraceOptions& options) {
    // For a microscope with 38 surfaces a processor compiles such kernels in 5 s at every start, 12 s the first time,
    // and then saves 0.08 us a ray; a GPU compiles them in 1.4 s once, as they are kept (core/files/user_cache.hpp),
    // and saves 25 ps a ray.
    constexpr std::uint64_t rays_that_pay = 100000000;
    const bool pays = !vulkan::is_software(device.report()) || options.rays >= rays_that_pay;
    return instrument.surfaces.size() <= std::size_t{physics::f32::KNOWN_SURFACES} &&
           options.instrument_in_constants.value_or(pays);
}

EmissionBuffers emission_buffers(const vulkan::Device& device, EmissionOrder order) {
    const std::size_t bytes = (order.cells() + 1) * sizeof(std::uint64_t);
    std::vector<glm::uvec2> packed; // the upper 16 of 21 bits, two numbers a word
    packed.reserve(order.cells());
    for (const auto& cell : order.given()) {
        packed.emplace_back((cell.x >> 5) | ((cell.y >> 5) << 16), (cell.z >> 5) | ((cell.w >> 5) << 16));
    }
    vulkan::Buffer given = buffer_of(device, packed);
    return {std::move(order), std::move(given), vulkan::Buffer(device, bytes)};
}

vulkan::Buffer light_points_of(const vulkan::Device& device, const optics::Instrument& instrument) {
    std::vector<float> points = instrument.light_field.value_or(optics::LightField{}).points.values;
    points.resize(std::max<std::size_t>(points.size(), 1)); // a buffer must not be empty
    return buffer_of(device, points);
}

std::unique_ptr<SceneWaves> make_waves(const optics::Instrument& seen, optics::WaveOptions options,
                                       const vulkan::OpenedDevice& opened) {
    optics::PupilFilter filter(seen, options);
    filter.table();
    const auto& device = opened.get();
    options.cells = static_cast<int>(filter.cells().side);
    options.tiles = filter.tiles().across();
    filter.set_parts(seen, waves_on_device(options, seen, device->report()).parts);
    // A device that is the host's own cores is no faster than the host, and the host has doubles.
    const auto by = vulkan::is_software(device->report()) ? MadeBy::host : MadeBy::device;
    return std::make_unique<SceneWaves>(*device, std::move(filter), seen.detector_pixels(), by);
}

} // namespace

std::vector<vulkan::Box> boxes_of(const optics::Room& room) {
    std::vector<vulkan::Box> boxes;
    boxes.reserve(room.surfaces + room.facets.size());
    const auto add = [&](const optics::Room::Box& bounds) {
        vulkan::Box box{glm::vec3(bounds.lower), glm::vec3(bounds.upper)};
        for (int axis = 0; axis < 3; ++axis) {
            box.minimum[axis] = next_below(box.minimum[axis]);
            box.maximum[axis] = next_above(box.maximum[axis]);
        }
        boxes.push_back(box);
    };
    for (std::size_t element = 0; element < room.surfaces; ++element) {
        add(room.bounds(element));
    }
    for (const auto& facet : room.facets) {
        add(optics::bounds_of(facet));
    }
    return boxes;
}

vulkan::OpenedDevice opened_by(const TraceOptions& options) {
    return options.opened.valid() ? options.opened : vulkan::begin_to_open({options.device});
}

DeviceScene make_device_scene(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                              const TraceOptions& options, const optics::Instrument* seen) {
    const vulkan::OpenedDevice opened = opened_by(options);
    std::future<std::unique_ptr<SceneWaves>> made_waves;
    if (seen != nullptr && options.waves && !options.nonsequential) {
        // A thread makes the wave filter while device and specimen are prepared.
        made_waves = std::async(std::launch::async,
                                [seen, &options, opened] { return make_waves(*seen, *options.waves, opened); });
    }
    auto device = opened.get();
    const bool software = vulkan::is_software(device->report());
    const bool specialised = pays_in_constants(*device, instrument, options);
    std::future<std::optional<physics::f64::TrainPolynomials>> polynomials;
    if (specialised && options.illumination_polynomials && options.estimator == Estimator::forward &&
        !options.nonsequential) {
        // A thread fits the polynomials while the specimen is uploaded, which takes longer.
        polynomials = std::async(std::launch::async, [&instrument] {
            const auto fitted = optics::fit_illumination(instrument);
            return fitted ? std::optional(fitted->polynomials) : std::nullopt;
        });
    }
    optics::Room room = options.nonsequential ? optics::furnish(instrument) : optics::Room{};
    Accounts accounts =
        options.nonsequential ? Accounts(instrument, room.names) : Accounts(instrument, options.directed_scatter);
    ChosenTraversal traversal = choose_traversal(device->report(), specimen, options.traversal, options.nonsequential);
    DeviceSpecimen device_specimen(*device, specimen, traversal.traversal, boxes_of(room));

    kernels::Parameters constants{};
    constants.instrument = to_float(instrument.constants);
    constants.specimen = device_specimen.record(options.max_bounces);
    physics::f64::SpecimenRecord host_record = specimen::record(specimen, options.max_bounces);
    host_record.top = constants.specimen.top;

    std::optional<ElementBuffers> elements;
    if (!room.elements.empty()) {
        elements.emplace(element_buffers(*device, room, device_specimen.element_order()));
    }
    std::unique_ptr<SceneWaves> waves;
    if (made_waves.valid()) {
        waves = made_waves.get();
        constants.pupil_cells = to_float(waves->filter().cells());
        const vk::DeviceAddress address = waves->sorted_light().address();
        constants.cell_light = {static_cast<std::uint32_t>(address), static_cast<std::uint32_t>(address >> 32)};
    }
    vulkan::Buffer surfaces = buffer_of(*device, surface_block(instrument));
    vulkan::Buffer spectrum = buffer_of(*device, spectrum_block(instrument));
    vulkan::Buffer light_points = light_points_of(*device, instrument);
    DeviceScene scene{.device = std::move(device),
                      .instrument = instrument,
                      .seed = options.seed,
                      .rays = options.rays,
                      .specialised = specialised,
                      .for_software = options.for_software.value_or(software),
                      .room = std::move(room),
                      .accounts = std::move(accounts),
                      .features = instrument.features |
                                  (options.directed_scatter ? physics::f32::FEATURE_DIRECTED_SCATTER : 0u) |
                                  (waves ? physics::f32::FEATURE_PUPIL_CELLS : 0u) | device_specimen.features(),
                      .illumination = polynomials.valid() ? polynomials.get() : std::nullopt,
                      .traversal = std::move(traversal),
                      .device_specimen = std::move(device_specimen),
                      .constants = constants,
                      .host_record = host_record,
                      .surfaces = std::move(surfaces),
                      .spectrum = std::move(spectrum),
                      .light_points = std::move(light_points),
                      .elements = std::move(elements),
                      .emission = {},
                      .waves = std::move(waves)};
    if (options.estimator == Estimator::forward && !options.nonsequential) {
        scene.order_emission(options.rays);
    }
    return scene;
}

void DeviceScene::order_emission(std::uint64_t paths) {
    const EmissionOrder& order =
        emission.emplace(emission_buffers(*device, EmissionOrder(instrument, paths, seed))).order;
    constants.emission_drawn = order.drawn();
    constants.emission_cells = static_cast<std::uint32_t>(order.cells());
    constants.emission_cells_per_path = static_cast<float>(order.cells_per_path());
}

ExposureMemory DeviceScene::exposure_memory() const {
    ExposureMemory memory{.parameters =
                              vulkan::Buffer(*device, sizeof(kernels::Parameters), vulkan::Buffer::Memory::host),
                          .first_paths = {}};
    if (emission) {
        memory.first_paths.emplace(*device, emission->first_paths.bytes(), vulkan::Buffer::Memory::host);
    }
    return memory;
}

std::vector<ExposureMemory> DeviceScene::exposure_memories() const {
    std::vector<ExposureMemory> memories;
    for (std::size_t slot = 0; slot < exposures_at_a_time(); ++slot) {
        memories.push_back(exposure_memory());
    }
    return memories;
}

void DeviceScene::write_exposure(ExposureMemory& memory, FocalPosition position, std::uint32_t image) const {
    kernels::Parameters parameters = constants;
    parameters.exposure = to_float(make_exposure(instrument, host_record, position, seed, image));
    memory.parameters.write_values(std::span<const kernels::Parameters>(&parameters, 1));
    if (emission) {
        memory.first_paths.value().write_values(std::span<const std::uint64_t>(emission->order.first_paths(image)));
    }
}

void DeviceScene::give_emission_order(vulkan::Commands& commands, const ExposureMemory& memory) const {
    if (emission) {
        commands.copy(memory.first_paths.value(), emission->first_paths, emission->first_paths.bytes());
        commands.barrier();
    }
}

std::vector<const vulkan::Buffer*> DeviceScene::light_buffers() const {
    return waves ? waves->sorted_light().buffers() : std::vector<const vulkan::Buffer*>{};
}

std::optional<optics::PupilFilter> DeviceScene::filter() const {
    return waves ? std::optional(waves->filter()) : std::nullopt;
}

void DeviceScene::require_waves() const {
    if (waves) {
        waves->require();
    }
}

void DeviceScene::clear_sorted_light(vulkan::Commands& commands) const {
    if (waves) {
        waves->clear(commands);
    }
}

void DeviceScene::make_wave_image(ExposureWork& work) const {
    if (waves && waves->on_device()) {
        waves->make_image(work);
    }
}

std::vector<vulkan::Binding> DeviceScene::bindings(const ExposureMemory& memory,
                                                   std::initializer_list<vulkan::Binding> further) const {
    std::vector<vulkan::Binding> all = {{kernels::BINDING_SURFACES, &surfaces},
                                        {kernels::BINDING_PARAMETERS, &memory.parameters},
                                        {kernels::BINDING_SPECTRUM, &spectrum},
                                        {kernels::BINDING_LIGHT_POINTS, &light_points}};
    const auto of_specimen = device_specimen.bindings();
    all.insert(all.end(), of_specimen.begin(), of_specimen.end());
    if (elements) {
        all.push_back({kernels::BINDING_ELEMENTS, &elements->elements});
        all.push_back({kernels::BINDING_ELEMENT_ORDER, &elements->order});
        all.push_back({kernels::BINDING_FACETS, &elements->facets});
    }
    all.insert(all.end(), further.begin(), further.end());
    return all;
}

std::vector<vulkan::BindingDeclaration> DeviceScene::declarations(std::initializer_list<std::uint32_t> further) const {
    using enum vulkan::BindingKind;
    std::vector<vulkan::BindingDeclaration> all = {{kernels::BINDING_SURFACES, uniform_buffer},
                                                   {kernels::BINDING_PARAMETERS, uniform_buffer},
                                                   {kernels::BINDING_SPECTRUM, uniform_buffer},
                                                   {kernels::BINDING_LIGHT_POINTS, storage_buffer}};
    const auto of_specimen = device_specimen.declarations();
    all.insert(all.end(), of_specimen.begin(), of_specimen.end());
    if (elements) {
        all.push_back({kernels::BINDING_ELEMENTS, storage_buffer});
        all.push_back({kernels::BINDING_ELEMENT_ORDER, storage_buffer});
        all.push_back({kernels::BINDING_FACETS, storage_buffer});
    }
    for (const std::uint32_t slot : further) {
        all.push_back({slot, storage_buffer});
    }
    return all;
}

std::vector<vulkan::SpecializationConstant> DeviceScene::kernel_constants() const {
    auto all = device_specimen.constants();
    all.push_back({kernels::CONSTANT_LEDGER_SLOTS, static_cast<std::uint32_t>(accounts.slots())});
    all.push_back({kernels::CONSTANT_FEATURES, features});
    return all;
}

std::vector<vulkan::SpecializationConstant> DeviceScene::specialised_constants(int first, int count) const {
    auto all = kernel_constants();
    const auto add = [&](std::uint32_t id, auto value) { all.push_back({id, std::bit_cast<std::uint32_t>(value)}); };
    add(kernels::CONSTANT_KNOWN_FIRST, first);
    add(kernels::CONSTANT_KNOWN_COUNT, count);
#define VKFV_ADD_OF_INSTRUMENT(id, type, name) add(id, constants.instrument.name);
#define VKFV_ADD_OF_SPECIMEN(id, type, name) add(id, constants.specimen.name);
#define VKFV_ADD_OF_LOBE(id, type, name) add(id, constants.specimen.material.lobe_0.name);
    VKFV_KNOWN_OF_INSTRUMENT(VKFV_ADD_OF_INSTRUMENT)
    VKFV_KNOWN_OF_SPECIMEN(VKFV_ADD_OF_SPECIMEN)
    VKFV_KNOWN_OF_LOBE(VKFV_ADD_OF_LOBE)
    const auto block = surface_block(instrument);
    for (int k = 0; k < count; ++k) {
        const auto& surface = block[static_cast<std::size_t>(first + k)];
        const std::uint32_t id =
            kernels::CONSTANT_KNOWN_SURFACES + kernels::KNOWN_FIELD_CAPACITY * static_cast<std::uint32_t>(k);
#define VKFV_LEAVE(type, name)
#define VKFV_ADD_OF_SURFACE(id, place, type, name) add(id + place, surface.name);
        VKFV_SURFACE_FIELDS(VKFV_LEAVE, VKFV_ADD_OF_SURFACE, id)
    }
    return all;
}

std::vector<vulkan::SpecializationConstant> DeviceScene::illumination_polynomials() const {
    if (!illumination) {
        return {};
    }
    std::vector<vulkan::SpecializationConstant> all;
    const auto add = [&](std::uint32_t id, int value) { all.push_back({id, static_cast<std::uint32_t>(value)}); };
    const auto add_real = [&](std::uint32_t id, double value) {
        all.push_back({id, std::bit_cast<std::uint32_t>(static_cast<float>(value))});
    };
    add(kernels::CONSTANT_POLYNOMIAL_EDGES, illumination->edges);
    add_real(kernels::CONSTANT_POLYNOMIAL_PER_RADIUS, illumination->per_radius);
    add_real(kernels::CONSTANT_POLYNOMIAL_SHIFT, illumination->shift);
    add_real(kernels::CONSTANT_POLYNOMIAL_PER_SINE, illumination->per_sine);
    add_real(kernels::CONSTANT_POLYNOMIAL_PLANE, illumination->plane);
    std::uint32_t id = kernels::CONSTANT_POLYNOMIALS;
    const auto add_polynomial = [&](const physics::f64::Polynomial& polynomial) {
        for (std::uint32_t term = 0; term < physics::f64::POLYNOMIAL_TERMS; ++term) {
            add_real(id + term, polynomial.terms[term]);
        }
        add(id + kernels::KNOWN_DEGREE, polynomial.degree);
    };
    for (const physics::f64::Polynomial* polynomial :
         {&illumination->place_r, &illumination->place_s, &illumination->direction_r, &illumination->direction_s}) {
        add_polynomial(*polynomial);
        id += kernels::KNOWN_POLYNOMIAL_CAPACITY;
    }
    for (const physics::f64::EdgePolynomial& edge : illumination->edge) {
        add_polynomial(edge.distance_squared);
        add(id + kernels::KNOWN_EDGE_SURFACE, edge.surface);
        add_real(id + kernels::KNOWN_EDGE_INSIDE_BELOW, edge.inside_below);
        add_real(id + kernels::KNOWN_EDGE_ENDS_FROM, edge.ends_from);
        add_real(id + kernels::KNOWN_EDGE_ENDS_BELOW, edge.ends_below);
        id += kernels::KNOWN_POLYNOMIAL_CAPACITY;
    }
    return all;
}

std::span<const std::uint32_t> DeviceScene::variant(const KernelVariants& kernel) const {
    return traversal.traversal == Traversal::ray_query ? kernel.ray_query
           : traversal.traversal == Traversal::bvh     ? kernel.bvh
           : for_software                              ? kernel.software
                                                       : kernel.quadtree;
}

TracerIdentity DeviceScene::identity() const {
    return device_identity(device->report(), traversal_name(traversal.traversal), instrument,
                           LightSorting::of(filter()));
}

} // namespace vkfv::trace
