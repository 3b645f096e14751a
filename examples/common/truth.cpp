#include "truth.hpp"

#include <filesystem>

#include <unistd.h>

#include "error.hpp"
#include "light_sampling.hpp"
#include "ray_scene.hpp"
#include "ray_shadow.hpp"
#include "receivers.hpp"

namespace fs = std::filesystem;

namespace
{

// Part of the cache's key: change it with anything that changes results.
constexpr uint32_t truth_version = 1;

// One sample in each cell of a grid, in double precision and traced whatever the receiver's plane says.
class TruthSampler final : public LightSampler
{
  public:
    TruthSampler(const Light &light, const Receivers &receivers, const TruthOptions &options)
        : light_(light), reach_(receivers.reach), grid_(light_grid(options.samples)), cells_(light_cells(grid_)),
          seed_(options.seed * 0xd1342543de82ef95u)
    {
        light_.centre -= receivers.origin;
    }
    uint32_t count() const override
    {
        return grid_ * grid_;
    }
    bool aim(const Receiver &receiver, const glm::dvec3 &start, SegmentList &out) const override
    {
        const uint64_t base = seed_ + receiver.pixel * (static_cast<uint64_t>(grid_) * grid_);
        for (uint32_t k = 0; k < count(); k++) {
            const LightCell cell = cells_[k];
            const uint64_t random = mix(base + cell.j * grid_ + cell.i);
            const double s = (cell.i + static_cast<double>(random & 0xffffffffu) * 0x1p-32) / grid_;
            const double t = (cell.j + static_cast<double>(random >> 32) * 0x1p-32) / grid_;
            const glm::vec3 segment(to_light_sample(light_, start, s, t, reach_));
            out.x[k] = segment.x;
            out.y[k] = segment.y;
            out.z[k] = segment.z;
        }
        return true;
    }

  private:
    Light light_; // in mesh space
    double reach_;
    uint32_t grid_;
    std::vector<LightCell> cells_;
    uint64_t seed_;
};

// Whether a receiver counts in the mask: not one that sees the light under less than about a degree, where a
// tessellated surface's own terminator decides more than any occluder.
class Mask
{
  public:
    Mask(const Light &light, const glm::dvec3 &origin, double light_near) : light_(light), light_near_(light_near)
    {
        light_.centre -= origin;
        if (light.shape == LightShape::rectangle || light.shape == LightShape::disc) {
            const glm::dvec3 forward = glm::cross(light.half_v, light.half_u);
            const double length = glm::length(forward);
            light_forward_ = length > 0.0 ? forward / length : glm::dvec3(0.0);
        }
    }
    bool has(const Receiver &receiver) const
    {
        const glm::dvec3 to_light = to_light_centre(light_, receiver.position);
        if (!(glm::dot(receiver.normal, to_light) > 0.02 * glm::length(to_light)))
            return false;
        return light_forward_ == glm::dvec3(0.0) || -glm::dot(to_light, light_forward_) > light_near_;
    }

  private:
    Light light_; // in mesh space
    glm::dvec3 light_forward_{0.0};
    double light_near_;
};

// Two FNV-1a hashes of 64 bits with different starts.
class Hash
{
  public:
    void bytes(const void *data, size_t size)
    {
        const auto *p = static_cast<const unsigned char *>(data);
        for (size_t i = 0; i < size; i++) {
            a_ = (a_ ^ p[i]) * 0x100000001b3u;
            b_ = (b_ ^ p[i]) * 0x10000000233u;
        }
    }
    template <typename T>
    void value(const T &v)
    {
        static_assert(std::is_trivially_copyable<T>::value, "hashes bytes");
        bytes(&v, sizeof v);
    }
    template <typename T>
    void values(const std::vector<T> &v)
    {
        value(v.size());
        bytes(v.data(), v.size() * sizeof(T));
    }
    std::string text() const
    {
        char out[40];
        std::snprintf(out, sizeof out, "%016llx%016llx", static_cast<unsigned long long>(a_),
                      static_cast<unsigned long long>(b_));
        return out;
    }

  private:
    uint64_t a_ = 0xcbf29ce484222325u, b_ = 0x84222325cbf29ce4u;
};

} // namespace

Truth compute_truth(const Mesh &mesh, const glm::dvec3 &origin, const DepthView &camera, const Light &light,
                    const TruthOptions &options, const TruthProgress &progress)
{
    if (options.samples < 1 || options.samples > 65536)
        fail("ground truth: %u light samples, expected 1 to 65536", options.samples);
    const RayScene rays(mesh);
    const Receivers receivers = find_receivers(mesh, rays, origin, camera);
    Truth truth{trace_shadows(rays, receivers, TruthSampler(light, receivers, options), progress),
                FloatImage(receivers.width, receivers.height, 0.0f)};
    const Mask mask(light, origin, options.light_near);
    for (const Receiver &receiver : receivers.points)
        truth.mask.texels[receiver.pixel] = mask.has(receiver) ? 1.0f : 0.0f;
    return truth;
}

Truth cached_truth(const std::string &folder, const Mesh &mesh, const glm::dvec3 &origin, const DepthView &camera,
                   const Light &light, const TruthOptions &options, const TruthProgress &progress)
{
    Hash hash;
    hash.value(truth_version);
    hash.values(mesh.positions);
    hash.values(mesh.indices);
    hash.value(origin);
    hash.value(camera.depth.width);
    hash.value(camera.depth.height);
    hash.values(camera.depth.texels);
    hash.value(camera.frustum.view);
    hash.value(camera.frustum.projection);
    hash.value(camera.frustum.reversed);
    hash.value(static_cast<int>(light.shape));
    for (const glm::dvec3 *v : {&light.centre, &light.half_u, &light.half_v, &light.direction})
        hash.value(*v);
    hash.value(light.angular_radius);
    hash.value(options.samples);
    hash.value(options.light_near);
    if (options.seed != 0)
        hash.value(options.seed);
    const fs::path base = fs::path(folder) / ("truth-" + hash.text());
    const std::string visibility_path = base.string() + ".exr", mask_path = base.string() + "-mask.exr";

    std::error_code code;
    if (fs::exists(visibility_path, code) && fs::exists(mask_path, code)) {
        try {
            Truth cached{read_exr(visibility_path), read_exr(mask_path)};
            if (cached.visibility.width == camera.depth.width && cached.visibility.height == camera.depth.height &&
                cached.mask.texels.size() == cached.visibility.texels.size())
                return cached;
        } catch (const Error &) {
            // A damaged entry is computed again and replaced.
        }
    }
    Truth truth = compute_truth(mesh, origin, camera, light, options, progress);
    fs::create_directories(folder, code);
    // Written aside and renamed, so that an interrupted or a second process leaves no half-written entry.
    const std::string aside = base.string() + "." + std::to_string(getpid()) + ".part.exr";
    write_exr(aside, truth.mask);
    fs::rename(aside, mask_path);
    write_exr(aside, truth.visibility);
    fs::rename(aside, visibility_path);
    return truth;
}
