// Shadow rays from receivers to samples of a light.
#include "ray_shadow.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "parallel.hpp"

FloatImage trace_shadows(const RayScene &rays, const Receivers &receivers, const LightSampler &sampler,
                         const RayProgress &progress)
{
    FloatImage visibility(receivers.width, receivers.height, 1.0f);
    // Handed out in pieces small enough for cores to stay busy to the end, where shadows make some receivers slow.
    constexpr size_t piece = 64;
    const size_t total = receivers.points.size();
    const uint32_t pieces = static_cast<uint32_t>((total + piece - 1) / piece);
    std::atomic<uint32_t> done{0};
    std::mutex mutex;
    parallel_for(pieces, [&](uint32_t index) {
        SegmentList segments;
        segments.resize(sampler.count());
        const size_t first = index * piece;
        for (size_t i = first; i < std::min(first + piece, total); i++) {
            const Receiver &receiver = receivers.points[i];
            const glm::dvec3 start = receiver.position + receiver.normal * receiver.offset;
            uint32_t free = 0;
            if (sampler.aim(receiver, start, segments))
                free = rays.count_free(glm::vec3(start), segments);
            visibility.texels[receiver.pixel] = static_cast<float>(free) / static_cast<float>(segments.count);
        }
        const uint32_t finished = ++done;
        if (progress && (finished % 64 == 0 || finished == pieces)) {
            const std::lock_guard<std::mutex> lock(mutex);
            progress(static_cast<double>(finished) / pieces);
        }
    });
    return visibility;
}
