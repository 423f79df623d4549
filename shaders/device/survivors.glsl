// The list between the two halves of the forward trace. Its order differs from run to run; the results do not, since
// images and ledgers add integers.
layout(set = 0, binding = BINDING_SURVIVORS, scalar) buffer Survivors { Survivor survivors[]; };
layout(set = 0, binding = BINDING_SURVIVOR_COUNT, scalar) buffer SurvivorCount { uint survivor_count; };
