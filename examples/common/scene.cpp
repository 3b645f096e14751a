// What all scenes share: options, and the frusta of camera and light.
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.hpp"
#include "scene_build.hpp"

static void check(bool ok, const char *what)
{
    if (!ok)
        fail("scene option %s", what);
}

static void check_options(const SceneOptions &o)
{
    check(!o.light_size || (*o.light_size >= 0.0 && *o.light_size <= 1000.0), "light size: expected 0 to 1000");
    check(!o.angular_radius || (*o.angular_radius >= 0.0 && *o.angular_radius <= 0.5),
          "angular radius: expected 0 to 0.5 radians");
    check(o.map_behind >= 0.0 && o.map_behind <= 1000.0, "distance behind the light: expected 0 to 1000");
    check(!o.light_direction || glm::length(*o.light_direction) > 0.0, "light direction: expected a vector, not zero");
    check(!(o.directional && o.infinite_map), "infinite map: a directional light's map is orthographic");
}

// An orthographic map around everything that casts a shadow, deep enough for the floor behind it.
static Frustum sun_map(const Light &sun, const Bounds &casters, bool reversed)
{
    const glm::dvec3 centre = casters.centre();
    const double radius = 0.5 * glm::length(casters.size());
    const double slope = std::max(0.1, std::fabs(sun.direction.y));
    // From the top of the bounding sphere along the light down to the floor.
    const double reach = (centre.y + radius) / slope + radius;
    const double half = radius + reach * std::tan(sun.angular_radius);
    // A slanting map meets the floor earlier on one side and later on the other.
    const double slant = half * std::sqrt(1.0 - slope * slope) / slope;
    return directional_frustum(sun, centre, half, {0.5, 1.0 + radius + reach + slant, reversed}, radius + 1.0);
}

Scene finish_scene(const SceneSetup &setup, const SceneOptions &options)
{
    check_options(options);
    const double infinity = std::numeric_limits<double>::infinity();
    Scene scene;
    scene.name = setup.name;
    scene.mesh = setup.objects;
    const Bounds casters = setup.objects.bounds();
    scene.mesh.append(setup.floor);
    scene.origin = options.world_offset;
    scene.map_size = setup.map_size;
    scene.map_fov = setup.map_fov;
    scene.map_range = setup.map_range;
    scene.map_range.reversed = options.reversed_map;
    if (options.infinite_map)
        scene.map_range.far_plane = infinity;
    scene.map_behind = options.map_behind;

    scene.camera = setup.camera;
    scene.camera.eye += options.world_offset;
    scene.camera.target += options.world_offset;
    scene.camera.range.reversed = options.reversed_camera;
    if (options.infinite_camera)
        scene.camera.range.far_plane = infinity;

    double half_u = setup.light_half_u, half_v = setup.light_half_v;
    if (options.light_size)
        half_u = half_v = *options.light_size * 0.5;
    if (options.directional) {
        const glm::dvec3 towards = setup.light_target - setup.light_centre;
        scene.light.shape = LightShape::directional;
        scene.light.direction = glm::normalize(options.light_direction.value_or(towards));
        scene.light.angular_radius =
            options.angular_radius.value_or(std::min(0.5, std::atan(half_u / glm::length(towards))));
        scene.map = sun_map(scene.light, casters, options.reversed_map);
        scene.map.view[3] -= glm::dvec4(glm::dmat3(scene.map.view) * options.world_offset, 0.0);
        return scene;
    }
    // The map's axes come from a light of size one, so that a point light has a map as well.
    Light unit = rectangle_light(setup.light_centre, setup.light_target, setup.light_up, 1.0, 1.0);
    unit.centre += options.world_offset;
    scene.map = light_frustum(unit, scene.map_fov, scene.map_range, scene.map_behind);
    scene.light = unit;
    scene.light.half_u *= half_u;
    scene.light.half_v *= half_v;
    return scene;
}

void place_light(Scene &scene, const glm::dvec3 &centre, const glm::dvec3 &target, const glm::dvec3 &up)
{
    const double half_u = glm::length(scene.light.half_u), half_v = glm::length(scene.light.half_v);
    // As in finish_scene.
    scene.light = rectangle_light(centre, target, up, 1.0, 1.0);
    scene.map = light_frustum(scene.light, scene.map_fov, scene.map_range, scene.map_behind);
    scene.light.half_u *= half_u;
    scene.light.half_v *= half_v;
}

Frustum camera_frustum(const Scene &scene, uint32_t width, uint32_t height)
{
    const Camera &c = scene.camera;
    const double aspect = static_cast<double>(width) / height;
    return {look_at(c.eye, c.target, c.up), perspective(c.fov_y, aspect, c.range), c.range.reversed};
}

Frustum sub_light_frustum(const Scene &scene, uint32_t grid, uint32_t i, uint32_t j)
{
    if (scene.light.shape != LightShape::rectangle || !(glm::length(scene.light.half_u) > 0.0))
        fail("scene %s: only a rectangular light with a size has sub-lights", scene.name.c_str());
    return light_frustum(sub_light(scene.light, grid, grid, i, j), scene.map_fov, scene.map_range, scene.map_behind);
}
