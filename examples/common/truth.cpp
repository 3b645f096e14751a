#include "truth.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include <unistd.h>

#include "error.hpp"
#include "light_sampling.hpp"
#include "ray_scene.hpp"

namespace fs = std::filesystem;

namespace
{

// Part of the cache's key: change it with anything that changes results.
constexpr uint32_t truth_version = 1;

// A well-mixed hash of a counter (splitmix64), so that every pixel has its own reproducible random numbers.
uint64_t mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

struct Receiver {
    glm::dvec3 position; // in mesh space
    glm::dvec3 normal;   // of the triangle, towards the viewer
    double offset;       // how far to leave the surface so as not to hit it
};

class Tracer
{
  public:
    Tracer(const Mesh &mesh, const glm::dvec3 &origin, const DepthView &camera, const Light &light,
           const TruthOptions &options)
        : mesh_(mesh), rays_(mesh), depth_(camera.depth), reversed_(camera.frustum.reversed), light_(light),
          grid_(static_cast<uint32_t>(std::sqrt(static_cast<double>(options.samples)) + 1e-9)),
          light_near_(options.light_near)
    {
        // Everything in mesh space, where coordinates are small.
        glm::dmat4 view = camera.frustum.view;
        view[3] += glm::dvec4(glm::dmat3(view) * origin, 0.0);
        to_mesh_ = glm::inverse(camera.frustum.projection * view);
        light_.centre -= origin;
        const Bounds bounds = mesh.bounds();
        const double diagonal = glm::length(bounds.size());
        far_away_ = 2.0 * diagonal + 1.0;
        offset_ = 3e-5 * diagonal;
        if (light.shape == LightShape::rectangle || light.shape == LightShape::disc) {
            const glm::dvec3 forward = glm::cross(light.half_v, light.half_u);
            const double length = glm::length(forward);
            light_forward_ = length > 0.0 ? forward / length : glm::dvec3(0.0);
        }
    }

    void row(uint32_t y, Truth &truth) const
    {
        for (uint32_t x = 0; x < depth_.width; x++) {
            Receiver receiver;
            if (!find_receiver(x, y, receiver))
                continue;
            truth.mask.at(x, y) = faces_light(receiver) ? 1.0f : 0.0f;
            truth.visibility.at(x, y) = visibility(receiver, static_cast<uint64_t>(y) * depth_.width + x);
        }
    }

  private:
    glm::dvec3 unproject(uint32_t x, uint32_t y, double depth) const
    {
        const glm::dvec4 p = to_mesh_ * glm::dvec4(2.0 * (x + 0.5) / depth_.width - 1.0,
                                                   2.0 * (y + 0.5) / depth_.height - 1.0, depth, 1.0);
        return glm::dvec3(p) / p.w;
    }

    bool find_receiver(uint32_t x, uint32_t y, Receiver &out) const
    {
        const float depth = depth_.at(x, y);
        const float background = reversed_ ? 0.0f : 1.0f;
        if (!(depth >= 0.0f && depth <= 1.0f) || depth == background)
            return false;
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

    // Not counting those that see the light under less than about a degree, where a tessellated surface's own
    // terminator decides more than any occluder.
    bool faces_light(const Receiver &receiver) const
    {
        const glm::dvec3 to_light = to_light_centre(light_, receiver.position);
        if (!(glm::dot(receiver.normal, to_light) > 0.02 * glm::length(to_light)))
            return false;
        return light_forward_ == glm::dvec3(0.0) || -glm::dot(to_light, light_forward_) > light_near_;
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

    float visibility(const Receiver &receiver, uint64_t pixel) const
    {
        const glm::dvec3 p = receiver.position + receiver.normal * receiver.offset;
        const glm::vec3 start(p);
        glm::vec3 directions[8];
        uint32_t free = 0, pending = 0;
        for (uint32_t j = 0; j < grid_; j++)
            for (uint32_t i = 0; i < grid_; i++) {
                const uint64_t random = mix(pixel * (static_cast<uint64_t>(grid_) * grid_) + j * grid_ + i);
                const double s = (i + static_cast<double>(random & 0xffffffffu) * 0x1p-32) / grid_;
                const double t = (j + static_cast<double>(random >> 32) * 0x1p-32) / grid_;
                directions[pending++] = glm::vec3(to_light_sample(light_, p, s, t, far_away_));
                if (pending == 8) {
                    free += rays_.count_free(start, directions, pending);
                    pending = 0;
                }
            }
        if (pending)
            free += rays_.count_free(start, directions, pending);
        return static_cast<float>(free) / static_cast<float>(grid_ * grid_);
    }

    const Mesh &mesh_;
    RayScene rays_;
    const FloatImage &depth_;
    bool reversed_;
    Light light_;
    uint32_t grid_;
    glm::dmat4 to_mesh_;
    glm::dvec3 light_forward_{0.0};
    double light_near_;
    double far_away_;
    double offset_;
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
    const FloatImage &depth = camera.depth;
    Truth truth{FloatImage(depth.width, depth.height, 1.0f), FloatImage(depth.width, depth.height, 0.0f)};
    const Tracer tracer(mesh, origin, camera, light, options);

    std::atomic<uint32_t> next{0}, done{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            for (uint32_t y = next++; y < depth.height; y = next++) {
                tracer.row(y, truth);
                const uint32_t finished = ++done;
                if (progress && (finished % 8 == 0 || finished == depth.height)) {
                    const std::lock_guard<std::mutex> lock(mutex);
                    progress(static_cast<double>(finished) / depth.height);
                }
            }
        } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex);
            failure = std::current_exception();
        }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); i++)
        threads.emplace_back(work);
    work();
    for (std::thread &thread : threads)
        thread.join();
    if (failure)
        std::rethrow_exception(failure);
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
