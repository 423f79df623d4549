// The records as the shaders see them are the records as the host writes them, field by field.
#include "trace/interface/device_records.hpp"
#include "vulkan/kernel.hpp"

#include "spirv/probe_records.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

using namespace vkfv;
using namespace vkfv::physics::f32;

namespace {

// Writes 1, 2, 3, ... into the fields of records.
class Filler {
  public:
    void fill(float& field) { field = next(); }
    void fill(std::int32_t& field) { field = static_cast<std::int32_t>(next()); }
    void fill(std::uint32_t& field) { field = static_cast<std::uint32_t>(next()); }
    void fill(glm::vec3& field) {
        fill(field.x);
        fill(field.y);
        fill(field.z);
    }

#define VKFV_FILL(type, name) fill(record.name);
#define VKFV_FILL_KNOWN(k, place, type, name) fill(record.name);
#define VKFV_FILL_ARRAY(type, name, size)                                                                              \
    for (type & field : record.name) {                                                                                 \
        fill(field);                                                                                                   \
    }
    void fill(Dispersion& record) {
        VKFV_DISPERSION_FIELDS(VKFV_FILL)
    }
    void fill(Surface& record) {
        VKFV_SURFACE_FIELDS(VKFV_FILL, VKFV_FILL_KNOWN, 0)
    }
    void fill(SpectralBin& record) {
        VKFV_SPECTRAL_BIN_FIELDS(VKFV_FILL)
    }
    void fill(RingLight& record) {
        VKFV_RING_LIGHT_FIELDS(VKFV_FILL)
    }
    void fill(Element& record) {
        VKFV_ELEMENT_FIELDS(VKFV_FILL)
    }
    void fill(Facet& record) {
        VKFV_FACET_FIELDS(VKFV_FILL)
    }
    void fill(Pattern& record) {
        VKFV_PATTERN_FIELDS(VKFV_FILL)
    }
    void fill(LightField& record) {
        VKFV_LIGHT_FIELD_FIELDS(VKFV_FILL)
    }
    void fill(Instrument& record) {
        VKFV_INSTRUMENT_FIELDS(VKFV_FILL)
    }
    void fill(Lobe& record) {
        VKFV_LOBE_FIELDS(VKFV_FILL, VKFV_FILL_ARRAY)
    }
    void fill(Material& record) {
        VKFV_MATERIAL_FIELDS(VKFV_FILL)
    }
    void fill(SpecimenRecord& record) {
        VKFV_SPECIMEN_RECORD_FIELDS(VKFV_FILL)
    }
    void fill(Exposure& record) {
        VKFV_EXPOSURE_FIELDS(VKFV_FILL)
    }
    void fill(PupilCells& record) {
        VKFV_PUPIL_CELLS_FIELDS(VKFV_FILL)
    }
    void fill(Survivor& record){VKFV_SURVIVOR_FIELDS(VKFV_FILL)}

    std::vector<float> written;

  private:
    float next() {
        written.push_back(static_cast<float>(written.size() + 1));
        return written.back();
    }
};

template <class Value>
vulkan::Buffer buffer_of(const vulkan::Device& device, std::span<const Value> values) {
    vulkan::Buffer buffer(device, values.size_bytes());
    buffer.write_values(values);
    return buffer;
}

} // namespace

TEST(Records, TheDeviceSeesEveryFieldWhereTheHostWroteIt) {
    const vulkan::Device device;
    std::vector<Surface> surfaces(SURFACE_CAPACITY);
    std::vector<SpectralBin> bins(SPECTRUM_CAPACITY);
    std::vector<Survivor> survivors(3);
    std::vector<Element> elements(3);
    std::vector<Facet> facets(3);
    kernels::Parameters parameters{};
    Filler filler; // in the order of the probe
    filler.fill(surfaces[2]);
    filler.fill(parameters.instrument);
    filler.fill(parameters.specimen);
    filler.fill(parameters.exposure);
    filler.fill(parameters.pupil_cells);
    filler.fill(parameters.cell_light.x);
    filler.fill(parameters.cell_light.y);
    for (int word = 0; word < 4; ++word) {
        filler.fill(parameters.emission_drawn[word]);
    }
    filler.fill(parameters.emission_cells);
    filler.fill(parameters.emission_cells_per_path);
    filler.fill(bins[2]);
    filler.fill(survivors[2]);
    filler.fill(elements[2]);
    filler.fill(facets[2]);
    const std::vector<float>& expected = filler.written;
    EXPECT_EQ(expected.size() * sizeof(float), sizeof(Surface) + sizeof(kernels::Parameters) + sizeof(SpectralBin) +
                                                   sizeof(Survivor) + sizeof(Element) + sizeof(Facet));

    const vulkan::Buffer surface_buffer = buffer_of<Surface>(device, surfaces);
    const vulkan::Buffer parameter_buffer = buffer_of<kernels::Parameters>(device, std::span(&parameters, 1));
    const vulkan::Buffer spectrum_buffer = buffer_of<SpectralBin>(device, bins);
    const vulkan::Buffer survivor_buffer = buffer_of<Survivor>(device, survivors);
    const vulkan::Buffer element_buffer = buffer_of<Element>(device, elements);
    const vulkan::Buffer facet_buffer = buffer_of<Facet>(device, facets);
    const vulkan::Buffer echo(device, expected.size() * sizeof(float));
    using enum vulkan::BindingKind;
    const vulkan::Kernel kernel(device, "probe_records", ::probe_records,
                                {{kernels::BINDING_SURFACES, uniform_buffer},
                                 {kernels::BINDING_PARAMETERS, uniform_buffer},
                                 {kernels::BINDING_SPECTRUM, uniform_buffer},
                                 {kernels::BINDING_SURVIVORS, storage_buffer},
                                 {kernels::BINDING_ELEMENTS, storage_buffer},
                                 {kernels::BINDING_FACETS, storage_buffer},
                                 {kernels::BINDING_FOUND, storage_buffer}});
    const std::array<vulkan::Binding, 7> bindings = {{{kernels::BINDING_SURFACES, &surface_buffer},
                                                      {kernels::BINDING_PARAMETERS, &parameter_buffer},
                                                      {kernels::BINDING_SPECTRUM, &spectrum_buffer},
                                                      {kernels::BINDING_SURVIVORS, &survivor_buffer},
                                                      {kernels::BINDING_ELEMENTS, &element_buffer},
                                                      {kernels::BINDING_FACETS, &facet_buffer},
                                                      {kernels::BINDING_FOUND, &echo}}};
    vulkan::Commands commands(device);
    commands.dispatch(kernel, bindings, std::span<const std::byte>{}, 1);
    commands.barrier();
    commands.submit_and_wait();
    EXPECT_EQ(echo.read_values<float>(expected.size()), expected);
}
