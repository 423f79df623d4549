// The GLSL side of the language that the files of this folder are written in; physics.hpp is the C++ side.
//
// The common language has `real`, `real2`, `real3`, int, uint, uvec4 and plain structs. Every literal is wrapped as
// real(0.5); arithmetic that must not be contracted is marked VKFV_PRECISE; functions are marked VKFV_FUNCTION and
// return structs (no `out`, no swizzles, no default arguments); structs are built by assigning fields; records that
// host and device share are lists of fields (records.glsl); GLSL's functions have GLM's names. Functions that reach
// data which host and device keep differently (surfaces, the specimen) take VKFV_SCENE first: nothing on the device,
// the scene object on the host (VKFV_SCENE_ALONE where no other argument follows). These files include nothing and
// carry no include guards: physics.hpp compiles them once in double and once in float.
#define real float
#define real2 vec2
#define real3 vec3
#define VKFV_FUNCTION
#define VKFV_PRECISE precise
#define VKFV_SCENE_FUNCTION
#define VKFV_SCENE_PARAMETER
#define VKFV_SCENE
#define VKFV_SCENE_ALONE
// Stands at the end of a loop that lanes leave one by one. Where lanes are elements of a CPU's registers (lavapipe of
// Mesa 25), an `if` that no lane takes is passed over, but a loop that tests first whether to go on runs one more round
// for no lane: kernels for software devices test at the end too. A GPU's lanes would then converge elsewhere, and an
// H100 takes two fifths longer.
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
