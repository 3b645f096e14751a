/* From the caller's double-precision matrices to the push constants of a peer. */
#ifndef PEER_GEOMETRY_H
#define PEER_GEOMETRY_H

#include "peers.h"
#include "shaders/peer_params.h"

/* NULL, or why the matrices cannot be used. */
const char *peer_geometry(const peer_info *info, const peer_inputs *inputs, struct peer_params *out);

#endif
