// The receiver side's descriptor set.
#ifndef SS_IO_BINDINGS_GLSL
#define SS_IO_BINDINGS_GLSL

layout(set = SS_SET_IO, binding = SS_BIND_DEPTH) uniform texture2D camera_depth;
layout(set = SS_SET_IO, binding = SS_BIND_NORMALS) uniform texture2D camera_normals;
layout(set = SS_SET_IO, binding = SS_BIND_VISIBILITY) uniform writeonly image2D visibility_image;
layout(set = SS_SET_IO, binding = SS_BIND_FRAME, std140) uniform ss_frame_buffer
{
    ss_frame frame;
};
// SS_FLAG_*; the sum is as in ss_layers.
uint ss_flags = frame.flags.x + gl_WorkGroupID.z;

layout(set = SS_SET_IO, binding = SS_BIND_CONTROL, std430) buffer ss_control_buffer
{
    ss_control control;
};
layout(set = SS_SET_IO, binding = SS_BIND_TILES, std430) buffer ss_tiles_buffer
{
    uint tiles[];
};

layout(set = SS_SET_IO, binding = SS_BIND_FILTER, std430) buffer ss_filter_buffer
{
    float filter_values[];
};

// Planes of a value per pixel: what passes keep for each other (ss_filter_values.glsl), then two of sub-lights.
uint ss_filter_plane()
{
    return frame.quality.z;
}

uint ss_filter_index(ivec2 pixel)
{
    return uint(pixel.y * frame.area.z + pixel.x);
}

// Where entries of the tiles buffer's parts are; ss_types.h says what they are.
uint ss_undecided_slot(uint i)
{
    return frame.tiles.z + 2u * i;
}

uint ss_pixel_slot(uint i)
{
    return frame.lists.x + 2u * i;
}

uint ss_packet_slot(uint list, uint i)
{
    return (list == SS_LIST_LARGE ? frame.lists.y : frame.lists.z) + SS_PACKET_WORDS * i;
}

uint ss_interpolated_slot(uint i, uint words)
{
    return frame.lists.w + words * i;
}

// Four floats of column `column` of a tile.
uint ss_column_slot(uint tile, uint column)
{
    return frame.lists.x + 4u * (tile * SS_TILE_X + column);
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
    return ivec2(tile % frame.tiles.x, tile / frame.tiles.x) * ivec2(SS_TILE_X, SS_TILE_Y) +
           ivec2(lane % SS_TILE_X, lane / SS_TILE_X);
}

// What this sub-light shows, and the sum over those before it.
uint ss_sublight_index(ivec2 pixel)
{
    return frame.quality.w + ss_filter_index(pixel);
}

uint ss_sum_index(ivec2 pixel)
{
    return frame.quality.w + ss_filter_plane() + ss_filter_index(pixel);
}

void ss_write_visibility(ivec2 pixel, float visible)
{
    if (SS_SUBLIGHTS)
        filter_values[ss_sublight_index(pixel)] = visible;
    else
        imageStore(visibility_image, frame.area.xy + pixel, vec4(visible));
}

#endif
