// Whether lanes are elements of a CPU's registers (lavapipe). Such a device passes over an `if` that no lane takes, but
// of a loop that asks first whether to go on it runs one more round, for no lane: its loops ask at the end as well. On
// GPUs, whose lanes would meet again elsewhere, that costs a fifth of a forward trace, and is compiled out.
#ifdef __cplusplus
const bool software_device = false;
#else
layout(constant_id = CONSTANT_SOFTWARE) const bool software_device = false;
#endif
