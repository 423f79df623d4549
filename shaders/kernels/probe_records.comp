#version 460
#extension GL_GOOGLE_include_directive : require
// Echoes every field of the shared records as a number, so that the host can compare its own layout.
#include "device/bindings.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = BINDING_SURVIVORS, scalar) readonly buffer Survivors { Survivor survivors[]; };
layout(set = 0, binding = BINDING_ELEMENTS, scalar) readonly buffer Elements { Element elements[]; };
layout(set = 0, binding = BINDING_FACETS, scalar) readonly buffer Facets { Facet facets[]; };
layout(set = 0, binding = BINDING_FOUND, scalar) writeonly buffer Echo { real numbers[]; };

Hit specimen_hit(real3 origin, real3 direction) {
    Hit hit;
    hit.found = 0u;
    return hit;
}
real lattice_at(int column, int row) { return real(0.0); }
real material_number(int index) { return real(0.0); }
real pattern_point(Pattern pattern, int column, int row) { return real(0.0); }

int count = 0;

void echo(real field) { numbers[count++] = field; }
void echo(int field) { echo(real(field)); }
void echo(uint field) { echo(real(field)); }
void echo(real3 field) {
    echo(field.x);
    echo(field.y);
    echo(field.z);
}

#define VKFV_ECHO(type, name) echo(record.name);
#define VKFV_ECHO_KNOWN(k, place, type, name) echo(record.name);
#define VKFV_ECHO_ARRAY(type, name, size) \
    for (int i = 0; i < size; ++i) { \
        echo(record.name[i]); \
    }

void echo(Dispersion record) { VKFV_DISPERSION_FIELDS(VKFV_ECHO) }
void echo(Surface record) { VKFV_SURFACE_FIELDS(VKFV_ECHO, VKFV_ECHO_KNOWN, 0) }
void echo(SpectralBin record) { VKFV_SPECTRAL_BIN_FIELDS(VKFV_ECHO) }
void echo(RingLight record) { VKFV_RING_LIGHT_FIELDS(VKFV_ECHO) }
void echo(Element record) { VKFV_ELEMENT_FIELDS(VKFV_ECHO) }
void echo(Facet record) { VKFV_FACET_FIELDS(VKFV_ECHO) }
void echo(Pattern record) { VKFV_PATTERN_FIELDS(VKFV_ECHO) }
void echo(LightField record) { VKFV_LIGHT_FIELD_FIELDS(VKFV_ECHO) }
void echo(Instrument record) { VKFV_INSTRUMENT_FIELDS(VKFV_ECHO) }
void echo(Lobe record) { VKFV_LOBE_FIELDS(VKFV_ECHO, VKFV_ECHO_ARRAY) }
void echo(Material record) { VKFV_MATERIAL_FIELDS(VKFV_ECHO) }
void echo(SpecimenRecord record) { VKFV_SPECIMEN_RECORD_FIELDS(VKFV_ECHO) }
void echo(Exposure record) { VKFV_EXPOSURE_FIELDS(VKFV_ECHO) }
void echo(PupilCells record) { VKFV_PUPIL_CELLS_FIELDS(VKFV_ECHO) }
void echo(Survivor record) { VKFV_SURVIVOR_FIELDS(VKFV_ECHO) }

void main() {
    // The last of three elements is read of arrays, so that the stride is tested too.
    echo(surfaces[2]);
    echo(instrument);
    echo(specimen);
    echo(exposure);
    echo(pupil_cells);
    echo(cell_light.x);
    echo(cell_light.y);
    for (int word = 0; word < 4; ++word) {
        echo(emission_drawn[word]);
    }
    echo(emission_cells);
    echo(emission_cells_per_path);
    echo(spectrum[2]);
    echo(survivors[2]);
    echo(elements[2]);
    echo(facets[2]);
}
