// The specimen's acceleration structure, and the triangles that it is built of.
layout(set = 0, binding = BINDING_STRUCTURE) uniform accelerationStructureEXT specimen_structure;

layout(set = 0, binding = BINDING_VERTICES, scalar) readonly buffer Vertices { real vertices[]; }; // three a vertex, mm
layout(set = 0, binding = BINDING_TRIANGLES, scalar) readonly buffer Triangles {
    uint triangles[];
}; // three indices a triangle

real3 triangle_vertex(uint triangle, uint corner) {
    uint first = 3u * triangles[3u * triangle + corner];
    return real3(vertices[first], vertices[first + 1u], vertices[first + 2u]);
}
