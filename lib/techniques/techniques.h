/* The stages of a visibility call, one file each. `create` makes a stage's pipelines for a view, `record` its passes.
 */
#ifndef SOFTSHI_TECHNIQUES_H
#define SOFTSHI_TECHNIQUES_H

#include "view.h"

softsh_result softshi_classify_create(softsh_view *view, const softshi_specialization *constants);
void softshi_classify_record(const softshi_visibility *visibility);

softsh_result softshi_bitmask_create(softsh_view *view, const softshi_specialization *constants);

softsh_result softshi_outline_create(softsh_view *view, const softshi_specialization *constants);

softsh_result softshi_separate_create(softsh_view *view, const softshi_specialization *constants);

softsh_result softshi_contour_create(softsh_view *view, const softshi_specialization *constants);

/* What is on the lists, by whichever technique the view was created with. Round 1: what interpolation left. */
void softshi_evaluate_record(const softshi_visibility *visibility, uint32_t round);

softsh_result softshi_interpolate_create(softsh_view *view, const softshi_specialization *constants);
void softshi_interpolate_record(const softshi_visibility *visibility);

softsh_result softshi_post_filter_create(softsh_view *view, const softshi_specialization *constants);
void softshi_post_filter_record(const softshi_visibility *visibility);

/* Adds what this sub-light shows to what the earlier ones did; the last one writes the mean. */
softsh_result softshi_combine_create(softsh_view *view, const softshi_specialization *constants);
void softshi_combine_record(const softshi_visibility *visibility);

softsh_result softshi_hard_create(softsh_view *view, const softshi_specialization *constants);
void softshi_hard_record(const softshi_visibility *visibility);

/* What every pass that queries the hierarchy reads. */
enum {
    SOFTSHI_HIERARCHY =
        SOFTSHI_HEADER | SOFTSHI_PLAN | SOFTSHI_FAN_DEPTH | SOFTSHI_PYRAMID | SOFTSHI_WIDE | SOFTSHI_BITS | SOFTSHI_DUAL
};

#endif
