// What the estimators share, and one factory for each kind of technique. make_estimator chooses among them.
#pragma once

#include "estimator.hpp"

std::unique_ptr<Estimator> make_library_estimator(gpu &g, DeviceCase &device_case, const Technique &technique,
                                                  bool stats);
std::unique_ptr<Estimator> make_peer_estimator(gpu &g, DeviceCase &device_case, const Technique &technique);
std::unique_ptr<Estimator> make_average_estimator(gpu &g, DeviceCase &device_case, const Technique &technique);
std::unique_ptr<Estimator> make_embree_estimator(DeviceCase &device_case, const Technique &technique);

// What a peer is told about a depth buffer and about the light.
peer_depth to_peer(const gpu_image &image, const Frustum &frustum);
peer_light to_peer(const Light &light);

// A storage image for the result, of the camera's size and R32F.
gpu_image make_output(gpu &g, const FloatImage &size);
FloatImage read_output(gpu &g, gpu_image &image);

// Layer maps of a case in order of their index, at most `limit`. Throws Error where there are others.
std::vector<size_t> layer_maps(const Case &data, std::optional<uint32_t> limit);
// The same for each sub-light, in the order of evaluation; a light that is not divided is one.
std::vector<std::vector<size_t>> sublight_maps(const Case &data, std::optional<uint32_t> limit);
