// Where the nodes of dual grids are: docs/numerics.md, section 10. Cell (x, y) lies between samples x - 1 and x, y - 1 and y, so
// that the first cells and the last ones reach over the map's border. Node of level k at cell x: cells x to x + 2^k - 1. There is
// one at every multiple of 2^k, or above the join of that of the join.
// Needs the occluders.
#ifndef SS_DUAL_GRID_GLSL
#define SS_DUAL_GRID_GLSL

// How many times the places of nodes of a level are halved.
uint ss_dual_shift(uint level, uint node_level)
{
    return min(node_level, max(occ.levels.y, level) - level);
}

// The first of them, among a layer's texels; of node levels that are not there, that of the next one.
uint ss_first_node(uint level, uint node_level)
{
    const uint entry = SS_MAX_LEVELS * node_level + level;
    return occ.duals[entry / 4u][entry % 4u];
}

// A level's nodes of one layer.
struct ss_nodes
{
    uint base, shift;
    ivec2 size;
};

ss_nodes ss_load_nodes(uint layer, uint level, uint node_level)
{
    const uint per_layer = occ.duals[SS_MAX_LEVELS * SS_MAX_LEVELS / 4 - 1].w;
    const ivec2 cells = (ivec2(occ.size.xy) + (1 << level) - 1 >> level) + 1;
    ss_nodes n;
    n.base = occ.strides.z + occ.levels.z * occ.strides.w + layer * per_layer + ss_first_node(level, node_level);
    n.shift = ss_dual_shift(level, node_level);
    n.size = cells + (1 << n.shift) - 1 >> n.shift;
    return n;
}

// The node at a cell; behind the last ones, the last one.
uint ss_node_at(ss_nodes n, ivec2 cell)
{
    const ivec2 at = min(cell >> n.shift, n.size - 1);
    return n.base + uint(at.y * n.size.x + at.x);
}

#endif
