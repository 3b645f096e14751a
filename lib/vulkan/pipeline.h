/* Compute pipelines of the manifest's shaders. */
#ifndef SOFTSHI_PIPELINE_H
#define SOFTSHI_PIPELINE_H

#include "context.h"
#include "shared.h"
#include "softshi_shaders.h"

/* Values of every specialization constant, indexed by SS_SPEC_*; the one past the end is a shader's own. */
typedef struct softshi_specialization {
    uint32_t values[SS_SPEC_COUNT + 1];
} softshi_specialization;

typedef struct softshi_pipeline {
    VkPipeline handle;
    const char *name; /* the shader's file name */
} softshi_pipeline;

softsh_result softshi_pipeline_create(const softsh_context *context, softshi_shader shader,
                                      const softshi_specialization *specialization, softshi_pipeline *out);
void softshi_pipeline_destroy(const softsh_context *context, softshi_pipeline *pipeline);

#endif
