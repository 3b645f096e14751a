// The receiver side's descriptor set. A pass that does not use a binding must not be given one.
#ifndef SS_IO_BINDINGS_GLSL
#define SS_IO_BINDINGS_GLSL

layout(set = SS_SET_IO, binding = SS_BIND_DEPTH) uniform texture2D camera_depth;
layout(set = SS_SET_IO, binding = SS_BIND_NORMALS) uniform texture2D camera_normals;
layout(set = SS_SET_IO, binding = SS_BIND_VISIBILITY) uniform writeonly image2D visibility_image;
layout(set = SS_SET_IO, binding = SS_BIND_FRAME, std140) uniform ss_frame_buffer
{
    ss_frame frame;
};
layout(set = SS_SET_IO, binding = SS_BIND_CONTROL, std430) buffer ss_control_buffer
{
    ss_control control;
};
// Per tile: its state; then the undecided tiles; then three words per penumbra tile: number, active pixels 0-31, 32-63.
layout(set = SS_SET_IO, binding = SS_BIND_TILES, std430) buffer ss_tiles_buffer
{
    uint tiles[];
};

uint ss_undecided_slot(uint i)
{
    return frame.tiles.z + i;
}

uint ss_penumbra_slot(uint i)
{
    return 2u * frame.tiles.z + 3u * i;
}

void ss_count(uint stat, uint n)
{
    // 64-bit sums from two words: the carry is found from the low word's old value, in whatever order additions come.
    const uint old = atomicAdd(control.stats[2u * stat], n);
    if (old + n < old)
        atomicAdd(control.stats[2u * stat + 1u], 1u);
}

// Pixel (in the render area) of lane `lane` of tile `tile`.
ivec2 ss_tile_pixel(uint tile, uint lane)
{
    return ivec2(tile % frame.tiles.x, tile / frame.tiles.x) * SS_TILE + ivec2(lane % SS_TILE, lane / SS_TILE);
}

void ss_write_visibility(ivec2 pixel, float visible)
{
    imageStore(visibility_image, frame.area.xy + pixel, vec4(visible));
}

#endif
