// Bits of cells that fold, row by row: docs/numerics.md, section 10; hierarchy_fold.comp makes them.
// Needs the occluder bindings.
#ifndef SS_FOLDS_GLSL
#define SS_FOLDS_GLSL

// Of a layer's level.
struct ss_folds
{
    uint first, words; // of a row
    int last;          // row
};

ss_folds ss_load_folds(uint layer, uint level)
{
    const uvec4 two_levels = occ.folds[level / 2u];
    const uvec2 of_level = level % 2u == 0u ? two_levels.xy : two_levels.zw;
    return ss_folds(layer * uint(occ.extent.y) + of_level.x, of_level.y, ss_level_size(level).y - 1);
}

// Cells x0 to x0 + 31 of row y. Those outside the map are not said to.
uint ss_folds_of_row(ss_folds f, int x0, int y)
{
    const uint x = uint(max(x0, 0)), word = x / 32u, shift = x % 32u;
    const uint row = f.first + uint(clamp(y, 0, f.last)) * f.words;
    const uint low = ss_bits_at(row + min(word, f.words - 1u)), high = ss_bits_at(row + min(word + 1u, f.words - 1u));
    const uint bits = shift == 0u ? low : low >> shift | high << (32u - shift);
    return x0 < 0 ? bits << min(uint(-x0), 31u) : bits;
}

#endif
