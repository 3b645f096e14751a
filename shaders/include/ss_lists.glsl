// Lists that one pass makes and the next is dispatched over. Their order differs from run to run; no result depends on it.
// Needs the io bindings.
#ifndef SS_LISTS_GLSL
#define SS_LISTS_GLSL

// An entry of an evaluation round's list; the first one of each group of the next pass makes the dispatch large enough for it.
uint ss_add_entry(uint round, uint list)
{
    const uint args = SS_LISTS * round + list, i = atomicAdd(control.evaluate_args[args].w, 1u);
    if (i % SS_EVALUATE_GROUP == 0u) {
        const uint group = i / SS_EVALUATE_GROUP;
        atomicMax(control.evaluate_args[args].x, min(group + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.evaluate_args[args].y, group / SS_DISPATCH_WIDTH + 1u);
    }
    return i;
}

void ss_append_pixel(uint round, uint id, float g_hi)
{
    const uint slot = ss_pixel_slot(ss_add_entry(round, SS_LIST_PIXELS));
    tiles[slot] = id;
    tiles[slot + 1u] = floatBitsToUint(g_hi);
}

// A packet begins at pixel `id`; bit x + 4 y of the mask is the pixel x to the right of it and y below.
void ss_append_packet(uint round, uint list, uint id, float g_hi, uint mask)
{
    const uint slot = ss_packet_slot(list, ss_add_entry(round, list));
    tiles[slot] = id;
    tiles[slot + 1u] = floatBitsToUint(g_hi);
    tiles[slot + 2u] = mask;
}

// What is looked at between the rounds, `words` words each.
uint ss_add_interpolated(uint words)
{
    const uint i = atomicAdd(control.interpolate_args.w, 1u);
    if (i % SS_EVALUATE_GROUP == 0u) {
        const uint group = i / SS_EVALUATE_GROUP;
        atomicMax(control.interpolate_args.x, min(group + 1u, SS_DISPATCH_WIDTH));
        atomicMax(control.interpolate_args.y, group / SS_DISPATCH_WIDTH + 1u);
    }
    return ss_interpolated_slot(i, words);
}

#endif
