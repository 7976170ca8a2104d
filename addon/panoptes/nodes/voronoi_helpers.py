# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL of Voronoi cells; places and dimensions are those of noise_helpers.py, whose hashes they use."""

from .helpers import add

add('noise_voronoi', '''
const int METRIC_EUCLIDEAN = 0, METRIC_MANHATTAN = 1, METRIC_CHEBYCHEV = 2, METRIC_MINKOWSKI = 3;
float voronoi_distance(vec4 a, vec4 b, int d, int metric, float exponent)
{
    vec4 v = abs(a - b);
    if (metric == METRIC_EUCLIDEAN || d == 1)
        return length(v);
    if (metric == METRIC_MANHATTAN)
        return v.x + v.y + v.z + v.w;
    if (metric == METRIC_CHEBYCHEV)
        return max(max(v.x, v.y), max(v.z, v.w));
    float sum = 0.0;
    for (int i = 0; i < d; ++i)
        sum += pow(v[i], exponent);
    return pow(sum, 1.0 / exponent);
}
struct Voronoi {
    float distance;
    vec3 color;
    vec4 place;
};
// The place of a cell's point, relative to the cell that is looked from.
vec4 voronoi_point(vec4 cell, vec4 offset, int d, float randomness)
{
    return offset + randomness * noise_random_place(cell + offset, d);
}
// Calls `body` for each cell within `reach` cells, nearest indices first along x.
#define VORONOI_CELLS(d, reach, body)                                                     \\
    for (int w = (d) > 3 ? -(reach) : 0; w <= ((d) > 3 ? (reach) : 0); ++w)               \\
    for (int z = (d) > 2 ? -(reach) : 0; z <= ((d) > 2 ? (reach) : 0); ++z)               \\
    for (int y = (d) > 1 ? -(reach) : 0; y <= ((d) > 1 ? (reach) : 0); ++y)               \\
    for (int x = -(reach); x <= (reach); ++x) { vec4 offset = vec4(x, y, z, w); body }
''', 'noise_hash')
add('noise_voronoi_nearest', '''
// The nearest point, or the second nearest.
Voronoi voronoi_nearest(vec4 p, int d, int metric, float exponent, float randomness, bool second)
{
    vec4 cell = floor(p), local = p - cell;
    float first = 1e30, next = 1e30;
    vec4 first_offset = vec4(0.0), next_offset = vec4(0.0);
    vec4 first_place = vec4(0.0), next_place = vec4(0.0);
    VORONOI_CELLS(d, 1, {
        vec4 place = voronoi_point(cell, offset, d, randomness);
        float there = voronoi_distance(place, local, d, metric, exponent);
        if (there < first) {
            next = first; next_offset = first_offset; next_place = first_place;
            first = there; first_offset = offset; first_place = place;
        } else if (there < next) {
            next = there; next_offset = offset; next_place = place;
        }
    })
    if (second)
        return Voronoi(next, noise_random_color(cell + next_offset, d), cell + next_place);
    return Voronoi(first, noise_random_color(cell + first_offset, d), cell + first_place);
}
''', 'noise_voronoi')
add('noise_voronoi_smooth', '''
Voronoi voronoi_smooth(vec4 p, int d, int metric, float exponent, float randomness, float smoothness)
{
    vec4 cell = floor(p), local = p - cell;
    Voronoi sum = Voronoi(8.0, vec3(0.0), vec4(0.0));
    VORONOI_CELLS(d, 2, {
        vec4 place = voronoi_point(cell, offset, d, randomness);
        float there = voronoi_distance(place, local, d, metric, exponent);
        float h = smoothstep(0.0, 1.0, 0.5 + 0.5 * (sum.distance - there) / smoothness);
        float correction = smoothness * h * (1.0 - h);
        sum.distance = mix(sum.distance, there, h) - correction;
        correction /= 1.0 + 3.0 * smoothness;
        sum.color = mix(sum.color, noise_random_color(cell + offset, d), h) - correction;
        sum.place = mix(sum.place, place, h) - correction;
    })
    for (int i = d; i < 4; ++i)
        sum.place[i] = 0.0;
    sum.place += cell;
    return sum;
}
''', 'noise_voronoi')
add('noise_voronoi_edge', '''
// The distance to the border between cells.
float voronoi_edge(vec4 p, int d, float randomness)
{
    vec4 cell = floor(p), local = p - cell;
    vec4 closest = vec4(0.0);
    float least = 1e30;
    VORONOI_CELLS(d, 1, {
        vec4 to_point = voronoi_point(cell, offset, d, randomness) - local;
        float squared = dot(to_point, to_point);
        if (squared < least) { least = squared; closest = to_point; }
    })
    float edge = 8.0;
    VORONOI_CELLS(d, 1, {
        vec4 to_point = voronoi_point(cell, offset, d, randomness) - local;
        vec4 across = to_point - closest;
        if (dot(across, across) > 0.0001)
            edge = min(edge, dot(0.5 * (closest + to_point), normalize(across)));
    })
    return edge;
}
''', 'noise_voronoi')
add('noise_voronoi_radius', '''
// Half the distance from the nearest point to the point nearest to it.
float voronoi_radius(vec4 p, int d, float randomness)
{
    vec4 cell = floor(p), local = p - cell;
    vec4 closest = vec4(0.0), closest_offset = vec4(0.0);
    float least = 1e30;
    VORONOI_CELLS(d, 1, {
        vec4 place = voronoi_point(cell, offset, d, randomness);
        float there = distance(place, local);
        if (there < least) { least = there; closest = place; closest_offset = offset; }
    })
    least = 1e30;
    VORONOI_CELLS(d, 1, {
        if (x != 0 || y != 0 || z != 0 || w != 0)
            least = min(least, distance(voronoi_point(cell, offset + closest_offset, d, randomness),
                                        closest));
    })
    return 0.5 * least;
}
''', 'noise_voronoi')
