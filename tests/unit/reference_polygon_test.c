/* Area and winding of polygons on the light: clamped trapezoids against the papers' radial integration and against
 * clipping, winding numbers against discs. Every case has a fixed seed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "contour_case.h"
#include "reference_polygon.h"

/* Area of a polygon within the square by cutting off what lies beyond each side. */
static double clipped_area(double (*points)[2], int count, double limit)
{
    double current[64][2], next[64][2], twice = 0.0;
    memcpy(current, points, (size_t)count * sizeof(*points));
    for (int side = 0; side < 4; ++side) {
        const int axis = side / 2;
        const double sign = side % 2 ? -1.0 : 1.0;
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const double *const a = current[i], *const b = current[(i + 1) % count];
            const double inside_a = limit - sign * a[axis], inside_b = limit - sign * b[axis];
            if (inside_a >= 0.0)
                memcpy(next[kept++], a, sizeof(*next));
            if ((inside_a >= 0.0) != (inside_b >= 0.0)) {
                const double t = inside_a / (inside_a - inside_b);
                for (int k = 0; k < 2; ++k)
                    next[kept][k] = a[k] + t * (b[k] - a[k]);
                next[kept++][axis] = sign * limit;
            }
        }
        count = kept;
        memcpy(current, next, sizeof(current));
    }
    for (int i = 0; i < count; ++i) {
        const double *const a = current[i], *const b = current[(i + 1) % count];
        twice += a[0] * b[1] - b[0] * a[1];
    }
    return 0.5 * twice;
}

/* Area of the square of half side 1 between angle 0 and the direction of p, 0 to 4. Sides are numbered from the one at
 * angle 0, which is the last as well. */
static double swept(const double p[2])
{
    const double reach = fmax(fabs(p[0]), fabs(p[1]));
    int side = p[0] >= reach ? 0 : p[1] >= reach ? 1 : p[0] <= -reach ? 2 : 3;
    if (side == 0 && p[1] < 0.0)
        side = 4;
    static const double along[5][2] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}, {0, 1}};
    const double t = (along[side][0] * p[0] + along[side][1] * p[1]) / reach;
    return 0.5 * t + side;
}

/* The papers' radial integration: the part of the square between its centre and the edge, positive if the edge turns
 * around the centre from x to y. */
static double radial_area(const double a[2], const double b[2])
{
    double t0 = 0.0, t1 = 1.0, points[4][2], area = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
        const double d = b[axis] - a[axis];
        for (int sign = -1; sign <= 1; sign += 2) {
            const double room = 1.0 - sign * a[axis];
            if (sign * d > 0.0)
                t1 = fmin(t1, room / (sign * d));
            else if (sign * d < 0.0)
                t0 = fmax(t0, room / (sign * d));
            else if (room < 0.0)
                t1 = -1.0;
        }
    }
    /* Outside, inside, outside. */
    const bool enters = t0 < t1;
    const double times[4] = {0.0, enters ? t0 : 1.0, enters ? t1 : 1.0, 1.0};
    for (int k = 0; k < 4; ++k)
        for (int axis = 0; axis < 2; ++axis)
            points[k][axis] = a[axis] + times[k] * (b[axis] - a[axis]);
    for (int k = 0; k < 3; ++k) {
        const double *const p = points[k], *const q = points[k + 1];
        const double cross = p[0] * q[1] - p[1] * q[0];
        if (k == 1) {
            area += 0.5 * cross;
        } else if (times[k + 1] > times[k]) {
            /* Less than half a turn, in the direction of the cross product. */
            double turn = swept(q) - swept(p);
            if (cross > 0.0 && turn < 0.0)
                turn += 4.0;
            if (cross < 0.0 && turn > 0.0)
                turn -= 4.0;
            area += cross == 0.0 ? 0.0 : turn;
        }
    }
    return area;
}

static void areas_agree_with_radial_integration(void **unused)
{
    (void)unused;
    uint64_t state = 3;
    for (int round = 0; round < 20000; ++round) {
        double points[12][2], trapezoids = 0.0, radial = 0.0;
        const int count = 3 + (int)(reference_random(&state) % 10);
        const double reach = round % 3 == 0 ? 0.9 : round % 3 == 1 ? 2.5 : 100.0;
        for (int i = 0; i < count; ++i)
            for (int axis = 0; axis < 2; ++axis)
                points[i][axis] = reference_random_range(&state, -reach, reach);
        if (round % 5 == 1) /* through the light's centre */
            for (int axis = 0; axis < 2; ++axis)
                points[1][axis] = -points[0][axis];
        if (round % 5 == 2) /* a vertex at the centre */
            points[1][0] = points[1][1] = 0.0;
        if (round % 5 == 3) /* along the light's border */
            points[0][0] = points[1][0] = round % 2 ? 1.0 : -1.0;
        if (round % 5 == 4)
            points[0][1] = points[1][1] = round % 2 ? 1.0 : -1.0;
        for (int i = 0; i < count; ++i) {
            trapezoids += reference_edge_area(points[i], points[(i + 1) % count], 1.0);
            radial += radial_area(points[i], points[(i + 1) % count]);
        }
        const double clipped = clipped_area(points, count, 1.0);
        if (!(fabs(trapezoids - clipped) < 1e-12 && fabs(radial - clipped) < 1e-11))
            fail_msg("round %d: trapezoids %.17g, radial %.17g, clipped %.17g", round, trapezoids, radial, clipped);
    }
}

static void polygons_cover_what_is_inside(void **unused)
{
    (void)unused;
    const reference_map map = build_map(setup_on_light, 0.6, 0);
    uint64_t state = 4;
    for (int round = 0; round < 500; ++round) {
        /* A turned ellipse, tested sample by sample by its own equation, on one side of which its polygon lies. */
        const double c[2] = {reference_random_range(&state, -1, 1), reference_random_range(&state, -1, 1)};
        const double radius = reference_random_range(&state, 0.1, 1.5);
        reference_polygons polygons;
        reference_occlusion o;
        double previous[2] = {c[0] + radius, c[1]};
        reference_polygons_begin(&polygons, &map, SOFTSH_PATTERN_32X32);
        for (int i = 1; i <= 64; ++i) {
            const double angle = i % 64 * acos(-1.0) / 32.0,
                         next[2] = {c[0] + radius * cos(angle), c[1] + radius * sin(angle)};
            reference_polygons_add(&polygons, previous, next);
            memcpy(previous, next, sizeof(previous));
        }
        reference_polygons_end(&polygons, &o);
        for (uint32_t bit = 0; bit < 1024; ++bit) {
            double xy[2];
            reference_pattern_sample(SOFTSH_PATTERN_32X32, bit % 32, bit / 32, xy);
            const double distance = hypot(xy[0] / 16.0 - 1.0 - c[0], xy[1] / 16.0 - 1.0 - c[1]) / radius;
            const bool covered = (o.mask[bit / 32] >> bit % 32 & 1u) != 0;
            assert_true(covered || distance > 0.998);
            assert_true(!covered || distance < 1.0 + 1e-9);
        }
        assert_true(fabs(o.area - o.bitmask) < 0.05);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_agree_with_radial_integration),
        cmocka_unit_test(polygons_cover_what_is_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
