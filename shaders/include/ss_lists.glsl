// Lists of pixels that one pass makes and the next is dispatched over. Their order differs from run to run; no result depends
// on it.
// Needs the io bindings.
#ifndef SS_LISTS_GLSL
#define SS_LISTS_GLSL

// The active list of an evaluation round.
void ss_append_active(uint round, uint id, float g_hi)
{
    const uint i = atomicAdd(control.evaluate_args[round].w, 1u);
    // The first pixel of each group of the next pass makes the dispatch large enough for it.
    if (i % SS_EVALUATE_GROUP == 0u) {
        const uint group = i / SS_EVALUATE_GROUP;
        atomicMax(control.evaluate_args[round].x, min(group + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.evaluate_args[round].y, group / SS_DISPATCH_WIDTH + 1u);
    }
    tiles[ss_active_slot(i)] = id;
    tiles[ss_active_slot(i) + 1u] = floatBitsToUint(g_hi);
}

void ss_append_interpolated(uint id, float g_hi)
{
    const uint i = atomicAdd(control.interpolate_args.w, 1u);
    if (i % SS_EVALUATE_GROUP == 0u) {
        const uint group = i / SS_EVALUATE_GROUP;
        atomicMax(control.interpolate_args.x, min(group + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.interpolate_args.y, group / SS_DISPATCH_WIDTH + 1u);
    }
    tiles[ss_interpolated_slot(i)] = id;
    tiles[ss_interpolated_slot(i) + 1u] = floatBitsToUint(g_hi);
}

#endif
