// The GLSL side of the language that the files of this folder are written in; physics.hpp is the C++ side.
//
// The common language: `real`, `real2`, `real3`, int, uint, uvec4 and plain structs; every literal wrapped as
// real(0.5); what must not be contracted marked VKFV_PRECISE; functions marked VKFV_FUNCTION that return structs (no
// `out`, no swizzles, no default arguments); structs built by assigning fields; what host and device share as lists of
// fields (records.glsl); GLM's names for GLSL's functions. What differs between host and device (where surfaces are
// kept, how a specimen is hit) is reached through functions that take VKFV_SCENE first: nothing on the device, the
// scene object on the host (VKFV_SCENE_ALONE where no other argument follows). These files include nothing and carry no
// include guards: physics.hpp compiles them once in double and once in float.
#define real float
#define real2 vec2
#define real3 vec3
#define VKFV_FUNCTION
#define VKFV_PRECISE precise
#define VKFV_SCENE_FUNCTION
#define VKFV_SCENE_PARAMETER
#define VKFV_SCENE
#define VKFV_SCENE_ALONE
// At the end of a loop that lanes leave one by one. Where lanes are elements of a CPU's registers (lavapipe of Mesa
// 25), an `if` that none takes is passed over, but a loop that asks first whether to go on runs one more round, for
// none: kernels for software devices ask at the end too. A GPU's lanes would then meet again elsewhere, and an H100
// takes two fifths longer.
#ifdef VKFV_SOFTWARE
#define VKFV_LEAVE_IF(condition) \
    if (condition) { \
        break; \
    }
#else
#define VKFV_LEAVE_IF(condition)
#endif
#define VKFV_DECLARE(type, name) type name;
#define VKFV_DECLARE_ARRAY(type, name, size) type name[size];
#define VKFV_DECLARE_KNOWN(k, place, type, name) type name;

uint multiply_high(uint a, uint b) {
    uint high;
    uint low;
    umulExtended(a, b, high, low);
    return high;
}
