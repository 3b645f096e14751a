// Values the post filter works on: three planes of one float per pixel, area occlusion and two of bitmask occlusion that
// the filter's passes read and write in turn.
#ifndef SS_FILTER_VALUES_GLSL
#define SS_FILTER_VALUES_GLSL

layout(set = SS_SET_IO, binding = SS_BIND_FILTER, std430) buffer ss_filter_buffer
{
    float filter_values[];
};

uint ss_filter_plane()
{
    return frame.quality.z;
}

uint ss_filter_index(ivec2 pixel)
{
    return uint(pixel.y * frame.area.z + pixel.x);
}

void ss_store_filter_values(ivec2 pixel, float area, float bits)
{
    const uint i = ss_filter_index(pixel);
    filter_values[i] = area;
    filter_values[ss_filter_plane() + i] = bits;
    filter_values[2u * ss_filter_plane() + i] = bits;
}

#endif
