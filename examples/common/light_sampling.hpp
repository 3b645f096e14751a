// Points of a light, for the ground truth.
#pragma once

#include "light.hpp"

// The segment from p to the light's sample (s, t), both in [0, 1): the occlusion test's direction, whose length is the
// segment's. For a directional light it is as long as `far_away`.
glm::dvec3 to_light_sample(const Light &light, const glm::dvec3 &p, double s, double t, double far_away);

// From p to the light's centre; for a directional light of length one.
glm::dvec3 to_light_centre(const Light &light, const glm::dvec3 &p);
