// The ledger's counts, gathered in shared memory and added to the buffer once a workgroup.
layout(constant_id = 1) const uint ledger_slots = 1;
layout(set = 0, binding = 4, scalar) buffer LedgerCounts { uint64_t ledger_counts[]; };

shared uint tally[ledger_slots];

void tally_clear() {
    for (uint slot = gl_LocalInvocationIndex; slot < ledger_slots; slot += gl_WorkGroupSize.x) {
        tally[slot] = 0u;
    }
    barrier();
}

void tally_fate(Fate fate) { atomicAdd(tally[ledger_slot(fate)], 1u); }

void tally_flush() {
    barrier();
    for (uint slot = gl_LocalInvocationIndex; slot < ledger_slots; slot += gl_WorkGroupSize.x) {
        if (tally[slot] != 0u) {
            atomicAdd(ledger_counts[slot], uint64_t(tally[slot]));
        }
    }
}
