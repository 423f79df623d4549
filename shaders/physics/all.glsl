// Every file of the physics, in the order of their dependence.
#include "physics/records.glsl"
#ifdef VKFV_SPECIALISED
#include "device/prescription.glsl"
#endif
#include "physics/random.glsl"
#include "physics/emission_cell.glsl"
#include "physics/spectrum.glsl"
#include "physics/source.glsl"
#include "physics/conic.glsl"
#include "physics/asphere.glsl"
#include "physics/refraction.glsl"
#include "physics/fresnel.glsl"
#include "physics/ideal_lens.glsl"
#include "physics/pattern.glsl"
#include "physics/light_field.glsl"
#include "physics/train.glsl"
#include "physics/short_train.glsl"
#include "physics/train_polynomials.glsl"
#ifdef VKFV_POLYNOMIALS
#include "device/train_polynomials.glsl"
#endif
#include "physics/scatter_basis.glsl"
#include "physics/scatter_models.glsl"
#include "physics/scatter.glsl"
#include "physics/surface_function.glsl"
#include "physics/pupil_cells.glsl"
#include "physics/reflectance.glsl"
#include "physics/image_distortion.glsl"
#include "physics/path.glsl"
#if defined(__cplusplus) || defined(VKFV_NONSEQUENTIAL) || defined(VKFV_BVH)
#include "physics/ray_frame.glsl"
#endif
#if defined(__cplusplus) || defined(VKFV_NONSEQUENTIAL) // most kernels have no elements
#include "physics/facets.glsl"
#include "physics/nonsequential.glsl"
#endif
#if defined(__cplusplus) || defined(VKFV_BACKWARD)
#include "physics/lattice.glsl"
#include "physics/backward.glsl"
#endif
