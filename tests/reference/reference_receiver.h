/* Receivers from a camera's depth image: section 3 of docs/numerics.md. */
#ifndef REFERENCE_RECEIVER_H
#define REFERENCE_RECEIVER_H

#include "reference_map.h"

/* Precision of a depth format, the rho of section 3. */
#define REFERENCE_PRECISION_16 (1.0 / 65536.0)
#define REFERENCE_PRECISION (1.0 / 2097152.0)

typedef struct reference_camera {
    double view_inverse[16], projection_inverse[16];
    uint32_t width, height; /* the render area */
    double far_depth;       /* 0 or 1 */
} reference_camera;

typedef struct reference_camera_image {
    const float *depth;   /* device depths of the render area, row by row */
    const float *normals; /* world-space xyz of each pixel, or NULL */
} reference_camera_image;

typedef struct reference_bias {
    double map_precision, camera_precision; /* rho of the two depth formats */
    bool override_bias;
    double bias; /* world units, with override_bias */
} reference_bias;

typedef enum reference_receiver_state {
    REFERENCE_RECEIVER_NONE,   /* no receiver: far plane, NaN, behind the projection centre or outside the map; lit */
    REFERENCE_RECEIVER_BEHIND, /* behind the light; lit */
    REFERENCE_RECEIVER_AWAY,   /* all of the light on the back of its plane; dark */
    REFERENCE_RECEIVER_ACTIVE  /* to be evaluated */
} reference_receiver_state;

typedef struct reference_receiver {
    reference_receiver_state state;
    double uvg[3];      /* set unless the state is NONE */
    double gradient[2]; /* dg/du, dg/dv of its plane; set when active, as the rest */
    double drift;       /* precision of the gradient: error of the plane per texel of distance */
    int side;           /* of its plane that the surface's front is on: 1 where g is greater, -1 where it is less */
    double horizon;     /* share of the light behind its plane */
    double eta;
    bool override_bias;
    double bias;
} reference_receiver;

/* False for a singular matrix. Right, down and forward of an orthographic camera form a right-handed frame. */
bool reference_camera_derive(reference_camera *camera, const double view[16], const double projection[16],
                             uint32_t width, uint32_t height);
/* World point of a device depth at the centre of pixel (x, y), and its derivative by the depth. False at the far plane,
 * for NaN and outside the render area. */
bool reference_camera_unproject(const reference_camera *camera, int64_t x, int64_t y, double depth, double world[3],
                                double derivative[3]);

/* The receiver of pixel (x, y). */
void reference_receiver_derive(reference_receiver *out, const reference_map *map, const reference_camera *camera,
                               const reference_camera_image *image, const reference_bias *bias, uint32_t x, uint32_t y);

/* (dg/du, dg/dv) of the plane through `uvg` with a world-space normal, not clamped. */
void reference_plane_gradient(const reference_map *map, const double uvg[3], const double normal[3],
                              double gradient[2]);
/* Whether all four neighbours, given by their (u, v, g) from the receiver, lie on the plane; `flat_eta` is the bias of
 * a plane without slope. */
bool reference_plane_smooth(const double offset[4][3], const double gradient[2], double flat_eta);
/* Share of the light behind the plane through `uvg`. */
double reference_horizon(const reference_map *map, const double uvg[3], const double gradient[2], int side);
/* Clamps a gradient to a slope of 89.5 degrees; a NaN becomes 0. */
void reference_gradient_clamp(const reference_map *map, double g, double gradient[2]);
/* The automatic bias. `away_per_depth` is how fast, in units of g, the point leaves the receiver's plane when the
 * camera's device depth changes. */
double reference_eta(const reference_map *map, const reference_bias *bias, double g, double away_per_depth,
                     const double gradient[2]);

#endif
