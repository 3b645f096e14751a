// Specialization constants; lib/vulkan/pipeline.c sets them all for every pipeline.
#ifndef SS_SPECIALIZATION_GLSL
#define SS_SPECIALIZATION_GLSL

layout(constant_id = SS_SPEC_PATTERN_SIDE) const int SS_PATTERN_SIDE = 16;
layout(constant_id = SS_SPEC_JITTERED) const bool SS_JITTERED = true;
layout(constant_id = SS_SPEC_PRIMITIVE) const int SS_PRIMITIVE = SS_PRIMITIVE_QUAD;
layout(constant_id = SS_SPEC_SAMPLED) const bool SS_SAMPLED = true;
layout(constant_id = SS_SPEC_MERGE_MAXIMUM) const bool SS_MERGE_MAXIMUM = false;
layout(constant_id = SS_SPEC_AREA) const bool SS_AREA = false;
layout(constant_id = SS_SPEC_HIERARCHY) const bool SS_HIERARCHY = true;
layout(constant_id = SS_SPEC_STATS) const bool SS_STATS = false;
layout(constant_id = SS_SPEC_FILTER) const bool SS_FILTER = false;
layout(constant_id = SS_SPEC_NORMALS) const bool SS_NORMALS = false;
layout(constant_id = SS_SPEC_LAYERED) const bool SS_LAYERED = true;
layout(constant_id = SS_SPEC_SPARSE) const bool SS_SPARSE = false;
layout(constant_id = SS_SPEC_SUBLIGHTS) const bool SS_SUBLIGHTS = false;
layout(constant_id = SS_SPEC_PACKET) const int SS_PACKET = 1;
layout(constant_id = SS_SPEC_BLOCK) const int SS_BLOCK = 4;
const uint SS_BLOCK_ROW = (SS_TILE_X + SS_BLOCK - 1) / SS_BLOCK; // blocks in a row of a tile; the last may stick out of it
const uint SS_TILE_BLOCKS = SS_BLOCK_ROW * SS_BLOCK_ROW;
layout(constant_id = SS_SPEC_REFINE) const bool SS_REFINE = false;
layout(constant_id = SS_SPEC_RECONSTRUCTION) const int SS_RECONSTRUCTION = SS_RECONSTRUCTION_JOINED;
layout(constant_id = SS_SPEC_SPLIT) const bool SS_SPLIT = false;
layout(constant_id = SS_SPEC_WALK) const bool SS_WALK = false;

#endif
