// The scenes themselves. Lengths are world units, floors lie at y = 0.
#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "error.hpp"
#include "scene_build.hpp"

namespace
{

const glm::vec3 floor_colour(0.50f, 0.48f, 0.45f);
const glm::vec3 clay(0.66f, 0.29f, 0.18f);
const glm::vec3 ochre(0.72f, 0.50f, 0.16f);
const glm::vec3 teal(0.13f, 0.42f, 0.44f);
const glm::vec3 slate(0.24f, 0.31f, 0.46f);
const glm::vec3 wood(0.45f, 0.27f, 0.14f);
const glm::vec3 ivory(0.74f, 0.69f, 0.58f);

double radians(double degrees)
{
    return degrees * glm::pi<double>() / 180.0;
}

glm::dmat4 at(double x, double y, double z)
{
    return glm::translate(glm::dmat4(1.0), glm::dvec3(x, y, z));
}

glm::dmat4 turned(double degrees, const glm::dvec3 &axis)
{
    return glm::rotate(glm::dmat4(1.0), radians(degrees), axis);
}

// An axis-parallel box from corner to corner.
void add_box(Mesh &mesh, const glm::dvec3 &lower, const glm::dvec3 &upper, const glm::vec3 &colour)
{
    const glm::dvec3 centre = (lower + upper) * 0.5;
    mesh.append(make_box((upper - lower) * 0.5, colour), at(centre.x, centre.y, centre.z));
}

Mesh make_floor(double half_size)
{
    return make_quad({0, 0, half_size}, {half_size, 0, 0}, floor_colour);
}

SceneSetup start(const char *name, double floor_half_size, const glm::dvec3 &eye, const glm::dvec3 &target)
{
    SceneSetup s;
    s.name = name;
    s.floor = make_floor(floor_half_size);
    s.camera.eye = eye;
    s.camera.target = target;
    s.camera.fov_y = radians(45.0);
    return s;
}

void set_light(SceneSetup &s, const glm::dvec3 &centre, const glm::dvec3 &target, double half, double fov)
{
    s.light_centre = centre;
    s.light_target = target;
    s.light_half_u = s.light_half_v = half;
    s.map_fov = radians(fov);
}

SceneSetup balls()
{
    SceneSetup s = start("balls", 12.0, {0, 5, 9}, {0, 0.8, 0});
    const glm::vec3 colours[3] = {clay, ochre, teal};
    for (int y = 0; y < 3; y++)
        for (int z = -1; z <= 1; z++)
            for (int x = -1; x <= 1; x++)
                s.objects.append(make_sphere(0.45, 48, 24, colours[y]), at(1.2 * x, 0.8 + 1.2 * y, 1.2 * z));
    set_light(s, {2, 9, 3}, {0, -1, 0}, 0.8, 70.0);
    return s;
}

SceneSetup slab()
{
    SceneSetup s = start("slab", 12.0, {0, 5.5, 7}, {0, 0.4, 0});
    add_box(s.objects, {-1, 2, -1}, {1, 2.02, 1}, clay);
    set_light(s, {0, 7, 0}, {0, 0, 0}, 0.8, 80.0);
    s.map_size = 512;
    return s;
}

SceneSetup fence()
{
    SceneSetup s = start("fence", 14.0, {0.5, 3.4, 7.5}, {0, 0.6, 0.5});
    for (int i = 0; i < 24; i++)
        add_box(s.objects, {-3.0 + 0.26 * i, 0, -0.03}, {-2.92 + 0.26 * i, 1.8, 0.03}, wood);
    for (double y : {0.4, 1.4})
        add_box(s.objects, {-3.0, y, -0.04}, {3.1, y + 0.1, 0.04}, wood);
    set_light(s, {-1, 5, -4.5}, {0, 0.4, 0.1}, 0.5, 70.0);
    s.light_up = {0, 1, 0};
    return s;
}

SceneSetup post()
{
    SceneSetup s = start("post", 12.0, {0, 4.5, 8}, {0, 1.2, 0});
    add_box(s.objects, {-0.15, 0, -0.15}, {0.15, 4.2, 0.15}, clay);
    set_light(s, {0, 5.5, 0}, {0, 0, 0}, 1.2, 100.0);
    s.map_range = {0.5, 30.0, false};
    return s;
}

// From the light's centre the upper plate hides all below it, yet the lower box and the pillar decide most of the
// penumbra (Assarsson and Akenine-Moeller 2003; figure 9 of the 2007 bitmask paper).
SceneSetup silhouette()
{
    SceneSetup s = start("silhouette", 12.0, {2.5, 4.6, 7.2}, {0, 0.9, 0});
    add_box(s.objects, {-0.6, 3.0, -0.6}, {0.6, 3.04, 0.6}, teal);
    add_box(s.objects, {-0.85, 1.5, -0.85}, {0.85, 1.6, 0.85}, ochre);
    add_box(s.objects, {-0.3, 0.0, -0.3}, {0.3, 1.5, 0.3}, clay);
    set_light(s, {0, 6, 0}, {0, 0, 0}, 1.0, 90.0);
    return s;
}

SceneSetup contact()
{
    SceneSetup s = start("contact", 12.0, {0.5, 3.6, 7.0}, {0, 0.5, 0});
    add_box(s.objects, {-2.3, 0, -0.6}, {-1.2, 1.1, 0.5}, clay);
    s.objects.append(make_box({0.5, 0.8, 0.5}, ochre), at(0.1, 0.8, -0.2) * turned(35.0, {0, 1, 0}));
    s.objects.append(make_cylinder(0.45, 0.35, 64, teal), at(1.9, 0.35, 0.2));
    s.objects.append(make_box({0.35, 0.08, 0.7}, slate), at(0.9, 0.08, 1.6) * turned(-20.0, {0, 1, 0}));
    set_light(s, {-2.5, 5.5, 2.0}, {0, 0.3, 0.2}, 0.7, 70.0);
    return s;
}

// A bush without leaves: rods of two or three texels of the light's map, in all directions.
SceneSetup twigs()
{
    SceneSetup s = start("twigs", 12.0, {0.6, 3.0, 5.6}, {0, 0.8, 0});
    s.objects.append(make_cylinder(0.05, 0.55, 24, wood), at(0.0, 0.55, 0.0));
    const int count = 72;
    const double half = 0.6, golden_angle = 137.50776;
    for (int i = 0; i < count; i++) {
        // From steep to flat, and around the trunk.
        const double lean = 20.0 + 65.0 * i / (count - 1.0);
        const glm::dmat4 place = at(0.0, 1.1 - 0.4 * i / (count - 1.0), 0.0) * turned(golden_angle * i, {0, 1, 0}) *
                                 turned(lean, {1, 0, 0}) * at(0.0, half, 0.0);
        s.objects.append(make_cylinder(0.009, half, 12, i % 3 ? wood : ochre), place);
    }
    set_light(s, {-1.5, 5.5, 1.5}, {0, 0.6, 0}, 0.5, 50.0);
    s.map_size = 1024;
    return s;
}

// Low closed ridges: their slopes stay below the light's elevation everywhere, so that nothing shadows anything.
SceneSetup lit()
{
    SceneSetup s = start("lit", 12.0, {0, 4.2, 7.5}, {0, 0.2, 0});
    const glm::vec3 colours[3] = {ochre, teal, clay};
    const double slopes[3] = {6.0, 9.0, 12.0};
    for (int i = 0; i < 3; i++) {
        const double x = -2.3 + 2.3 * i, half = 1.0;
        const double height = half * std::tan(radians(slopes[i]));
        const glm::dvec3 top(x, height, 0.0);
        const glm::dvec3 corners[4] = {
            {x - half, 0, half}, {x + half, 0, half}, {x + half, 0, -half}, {x - half, 0, -half}};
        for (int k = 0; k < 4; k++) {
            const glm::dvec3 a = corners[k], b = corners[(k + 1) % 4];
            const glm::dvec3 normal = glm::normalize(glm::cross(b - a, top - a));
            for (const glm::dvec3 &p : {a, b, top}) {
                s.objects.indices.push_back(static_cast<uint32_t>(s.objects.positions.size()));
                s.objects.positions.push_back(glm::vec3(p));
                s.objects.normals.push_back(glm::vec3(normal));
                s.objects.colours.push_back(colours[i]);
            }
        }
    }
    set_light(s, {1, 8, 1}, {0, 0, 0}, 0.6, 80.0);
    return s;
}

// A lid wider than the floor, and the camera under it.
SceneSetup umbra()
{
    SceneSetup s = start("umbra", 6.0, {0, 1.5, 5.6}, {0, 0.55, 0});
    add_box(s.objects, {-6.6, 2.6, -6.6}, {6.6, 2.7, 6.6}, slate);
    s.objects.append(make_sphere(0.5, 48, 24, clay), at(-1.1, 0.5, 0.3));
    s.objects.append(make_box({0.45, 0.45, 0.45}, ochre), at(0.9, 0.45, -0.3) * turned(30.0, {0, 1, 0}));
    s.objects.append(make_cylinder(0.3, 0.6, 48, teal), at(0.0, 0.6, -1.6));
    set_light(s, {0, 12, 0}, {0, 0, 0}, 0.8, 80.0);
    return s;
}

// A room lit from inside a lantern: a cage that is close to the light on all sides. One map sees the floor of it.
SceneSetup lantern()
{
    SceneSetup s = start("lantern", 4.0, {0, 2.2, 6.4}, {0, 1.4, 0});
    const double radius = 0.35, half = 0.35, height = 1.7;
    for (const double y : {-half, half})
        s.objects.append(make_cylinder(radius + 0.02, 0.02, 48, slate), at(0, height + y, 0));
    const int bars = 12;
    for (int i = 0; i < bars; i++) {
        const double angle = radians(360.0 * (i + 0.5) / bars);
        s.objects.append(make_cylinder(0.014, half, 16, slate),
                         at(radius * std::cos(angle), height, radius * std::sin(angle)));
    }
    s.objects.append(make_cylinder(0.02, 0.7, 16, slate), at(0, height + half + 0.7, 0));
    s.objects.append(make_box({0.35, 0.35, 0.35}, ochre), at(-1.9, 0.35, 0.9) * turned(25.0, {0, 1, 0}));
    s.objects.append(make_sphere(0.45, 48, 24, clay), at(1.7, 0.45, -0.8));
    add_box(s.objects, {-4.0, 0, -3.1}, {4.0, 3.2, -3.0}, ivory);
    add_box(s.objects, {-3.6, 0, -3.0}, {-3.5, 3.2, 4.0}, teal);
    add_box(s.objects, {3.5, 0, -3.0}, {3.6, 3.2, 4.0}, teal);
    set_light(s, {0, height, 0}, {0, 0, 0}, 0.08, 90.0);
    s.map_range.near_plane = 0.1;
    s.map_size = 512;
    return s;
}

struct Entry {
    SceneName name;
    SceneSetup (*make)();
};

const Entry entries[] = {
    {{"balls", "3 x 3 x 3 balls hovering over a floor"}, balls},
    {{"slab", "one thin plate right under the light"}, slab},
    {{"fence", "thin slats in front of the light"}, fence},
    {{"post", "a tall thin post under a large light"}, post},
    {{"silhouette", "occluders hidden from the light's centre by a smaller one above them"}, silhouette},
    {{"contact", "boxes and a cylinder resting on the floor"}, contact},
    {{"twigs", "thin rods in all directions"}, twigs},
    {{"lantern", "a room lit from inside a cage"}, lantern},
    {{"lit", "gentle slopes, nothing in shadow"}, lit},
    {{"umbra", "all receivers under a big lid"}, umbra},
};

} // namespace

const std::vector<SceneName> &scene_names()
{
    static const std::vector<SceneName> names = [] {
        std::vector<SceneName> list;
        for (const Entry &entry : entries)
            list.push_back(entry.name);
        return list;
    }();
    return names;
}

Scene make_scene(const std::string &name, const SceneOptions &options)
{
    std::string known;
    for (const Entry &entry : entries) {
        if (name == entry.name.name)
            return finish_scene(entry.make(), options);
        known += known.empty() ? "" : ", ";
        known += entry.name.name;
    }
    fail("unknown scene '%s', expected one of %s", name.c_str(), known.c_str());
}

Scene make_model_scene(const std::string &path, const SceneOptions &options)
{
    const Mesh mesh = load_mesh(path, ivory);
    const Bounds bounds = mesh.bounds();
    const glm::dvec3 size = bounds.size();
    const double extent = std::max(size.x, std::max(size.y, size.z));
    if (!(extent > 0.0) || !std::isfinite(extent))
        fail("%s: all vertices are in one place", path.c_str());
    SceneSetup s = start("model", 12.0, {1.5, 3.2, 6}, {0, 1.1, 0});
    const size_t slash = path.find_last_of('/');
    s.name = path.substr(slash == std::string::npos ? 0 : slash + 1);
    s.name = s.name.substr(0, s.name.find_last_of('.'));
    const glm::dvec3 centre = bounds.centre();
    s.objects.append(mesh,
                     glm::scale(glm::dmat4(1.0), glm::dvec3(2.8 / extent)) * at(-centre.x, -bounds.lower.y, -centre.z));
    set_light(s, {-2.5, 6.5, 2.5}, {-0.3, 1.0, 0.1}, 0.7, 60.0);
    return finish_scene(s, options);
}
