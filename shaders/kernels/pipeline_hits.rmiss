#version 460
#extension GL_GOOGLE_include_directive : require
// The generation stage has set the payload to no hit.
#include "device/kernel.glsl"

layout(location = 0) rayPayloadInEXT Hit met;

void main() {}
