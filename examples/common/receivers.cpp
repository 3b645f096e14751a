// Receivers from a camera's depth buffer.
#include "receivers.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"

namespace
{

class Finder
{
  public:
    Finder(const Mesh &mesh, const RayScene &rays, const glm::dvec3 &origin, const DepthView &camera)
        : mesh_(mesh), rays_(rays), depth_(camera.depth), reversed_(camera.frustum.reversed)
    {
        glm::dmat4 view = camera.frustum.view;
        view[3] += glm::dvec4(glm::dmat3(view) * origin, 0.0);
        to_mesh_ = glm::inverse(camera.frustum.projection * view);
        diagonal_ = glm::length(mesh.bounds().size());
        offset_ = 3e-5 * diagonal_;
    }

    double reach() const
    {
        return 2.0 * diagonal_ + 1.0;
    }

    std::vector<Receiver> row(uint32_t y) const
    {
        std::vector<Receiver> found;
        Receiver receiver;
        for (uint32_t x = 0; x < depth_.width; x++)
            if (find(x, y, receiver))
                found.push_back(receiver);
        return found;
    }

  private:
    glm::dvec3 unproject(uint32_t x, uint32_t y, double depth) const
    {
        const glm::dvec4 p = to_mesh_ * glm::dvec4(2.0 * (x + 0.5) / depth_.width - 1.0,
                                                   2.0 * (y + 0.5) / depth_.height - 1.0, depth, 1.0);
        return glm::dvec3(p) / p.w;
    }

    bool find(uint32_t x, uint32_t y, Receiver &out) const
    {
        const float depth = depth_.at(x, y);
        const float background = reversed_ ? 0.0f : 1.0f;
        if (!(depth >= 0.0f && depth <= 1.0f) || depth == background)
            return false;
        out.pixel = y * depth_.width + x;
        out.position = unproject(x, y, depth);
        // One step of the depth format, in world units along the view ray.
        const double step = glm::length(unproject(x, y, std::nextafter(depth, 1.0f - background)) - out.position);
        const glm::dvec3 size = glm::abs(out.position);
        out.offset = std::max(offset_, 4.0 * step + 4e-6 * std::max(size.x, std::max(size.y, size.z)));

        // The triangle behind the pixel gives the plane; look for it only around the depth the buffer has.
        const glm::dvec3 start = unproject(x, y, 1.0 - background);
        const glm::dvec3 along = out.position - start;
        const double length = glm::length(along);
        for (double window = 4.0; window < 5000.0; window *= 8.0) {
            const double t = window * out.offset / length;
            const int64_t hit = rays_.nearest(glm::vec3(start), glm::vec3(along),
                                              static_cast<float>(std::max(0.0, 1.0 - t)), static_cast<float>(1.0 + t));
            if (hit >= 0 && plane(static_cast<size_t>(hit), along, out.normal))
                return true;
        }
        // A silhouette the rasteriser and the ray see differently: take the surface to face the viewer.
        out.normal = -along / length;
        return true;
    }

    bool plane(size_t triangle, const glm::dvec3 &along, glm::dvec3 &normal) const
    {
        const uint32_t *index = &mesh_.indices[triangle * 3];
        const glm::dvec3 a(mesh_.positions[index[0]]), b(mesh_.positions[index[1]]), c(mesh_.positions[index[2]]);
        const glm::dvec3 n = glm::cross(b - a, c - a);
        const double length = glm::length(n);
        if (!(length > 0.0))
            return false;
        normal = glm::dot(n, along) > 0.0 ? -n / length : n / length;
        return true;
    }

    const Mesh &mesh_;
    const RayScene &rays_;
    const FloatImage &depth_;
    bool reversed_;
    glm::dmat4 to_mesh_;
    double diagonal_;
    double offset_;
};

} // namespace

Receivers find_receivers(const Mesh &mesh, const RayScene &rays, const glm::dvec3 &origin, const DepthView &camera)
{
    const Finder finder(mesh, rays, origin, camera);
    std::vector<std::vector<Receiver>> rows(camera.depth.height);
    parallel_for(camera.depth.height, [&](uint32_t y) { rows[y] = finder.row(y); });
    Receivers receivers{camera.depth.width, camera.depth.height, origin, finder.reach(), {}};
    for (const std::vector<Receiver> &row : rows)
        receivers.points.insert(receivers.points.end(), row.begin(), row.end());
    return receivers;
}
