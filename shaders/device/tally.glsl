// The ledger's counts, gathered in shared memory and added to the buffer once a workgroup.
layout(constant_id = CONSTANT_LEDGER_SLOTS) const uint ledger_slots = 1;
layout(set = 0, binding = BINDING_LEDGER, scalar) buffer LedgerCounts { uint64_t ledger_counts[]; };

// With directed scatter the sums of the weights, and the sum of the squares of each path's total (weight_square),
// follow the counts; in shared memory they are pairs of words.
const bool weighted = (scene_features & FEATURE_DIRECTED_SCATTER) != 0u;
const uint weighted_slots = weighted ? ledger_slots + 1u : 1u;

shared uint tally[ledger_slots];
shared uint low_sums[weighted_slots];
shared uint high_sums[weighted_slots];

void tally_clear() {
    for (uint slot = gl_LocalInvocationIndex; slot < ledger_slots; slot += gl_WorkGroupSize.x) {
        tally[slot] = 0u;
    }
    if (weighted) {
        for (uint slot = gl_LocalInvocationIndex; slot < weighted_slots; slot += gl_WorkGroupSize.x) {
            low_sums[slot] = 0u;
            high_sums[slot] = 0u;
        }
    }
    barrier();
}

void tally_sum(uint slot, uint amount) {
    uint before = atomicAdd(low_sums[slot], amount);
    if (before + amount < before) {
        atomicAdd(high_sums[slot], 1u);
    }
}

// Counts a fate. weight: in units of 1 / WEIGHT_ONE, used with directed scatter alone.
void tally_fate(Fate fate, uint weight) {
    uint slot = uint(ledger_slot(fate));
    atomicAdd(tally[slot], 1u);
    if (weighted) {
        tally_sum(slot, weight);
    }
}

void tally_flush() {
    barrier();
    for (uint slot = gl_LocalInvocationIndex; slot < ledger_slots; slot += gl_WorkGroupSize.x) {
        if (tally[slot] != 0u) {
            atomicAdd(ledger_counts[slot], uint64_t(tally[slot]));
        }
    }
    if (weighted) {
        for (uint slot = gl_LocalInvocationIndex; slot < weighted_slots; slot += gl_WorkGroupSize.x) {
            uint64_t sum = (uint64_t(high_sums[slot]) << 32) + uint64_t(low_sums[slot]);
            if (sum != uint64_t(0)) {
                atomicAdd(ledger_counts[ledger_slots + slot], sum);
            }
        }
    }
}
