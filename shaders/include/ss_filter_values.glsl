// Values other passes work on. The post filter: three planes of one float per pixel, area occlusion and two of bitmask
// occlusion that its passes read and write in turn. Interpolation: one plane, visibility.
// Needs the io bindings.
#ifndef SS_FILTER_VALUES_GLSL
#define SS_FILTER_VALUES_GLSL

void ss_store_filter_values(ivec2 pixel, float area, float bits)
{
    const uint i = ss_filter_index(pixel);
    filter_values[i] = area;
    filter_values[ss_filter_plane() + i] = bits;
    filter_values[2u * ss_filter_plane() + i] = bits;
}

// For interpolation: no sample of the pixel's kernel occludes, or all of them do.
const float SS_ALL_LIT = 2.0, SS_ALL_DARK = -1.0;

void ss_store_visible(ivec2 pixel, float visible)
{
    filter_values[ss_filter_index(pixel)] = visible;
}

#endif
