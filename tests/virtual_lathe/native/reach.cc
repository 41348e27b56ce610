// SPDX-License-Identifier: Apache-2.0
// What a tool can make of a wanted surface without cutting into it: the
// morphological closing of the surface by the outline of the tool.
//
//   floor(tip)   = highest of  wanted(tip + u) - outline(u)
//   reached(z)   = lowest of   floor(z - u) + outline(u)
//
// Both loops go from the lowest point of the outline outwards and stop as soon
// as the outline has risen too far to matter.

#include "metal.hh"

#include <algorithm>
#include <cmath>

namespace lathe
{

namespace
{

// The outline at whole columns; u = (i - zero) / per_step.
struct Table {
    std::vector<double> height;
    int zero = 0, bottom = 0;

    Table(const Outline &outline, int per_step, double highest, int count)
    {
        bottom = int(std::lround(outline.bottom() * per_step));
        int low = bottom, high = bottom;
        while (bottom - low < count &&
               outline.at(double(low - 1) / per_step) <= highest)
            low--;
        while (high - bottom < count &&
               outline.at(double(high + 1) / per_step) <= highest)
            high++;
        for (int i = low; i <= high; i++)
            height.push_back(outline.at(double(i) / per_step));
        zero = -low;
        bottom -= low;
    }
    int size() const
    {
        return int(height.size());
    }
};

double floor_at(const std::vector<double> &wanted, double highest,
                const Table &tool, int tip)
{
    double best = -INFINITY;
    for (int direction : {1, -1})
        for (int i = tool.bottom; i >= 0 && i < tool.size(); i += direction) {
            if (highest - tool.height[i] <= best)
                break;
            int column = tip + i - tool.zero;
            if (column >= 0 && column < int(wanted.size()))
                best = std::max(best, wanted[column] - tool.height[i]);
        }
    return best;
}

double reached_at(const std::vector<double> &floor, double lowest,
                  const Table &tool, int column)
{
    double best = INFINITY;
    for (int direction : {1, -1})
        for (int i = tool.bottom; i >= 0 && i < tool.size(); i += direction) {
            if (lowest + tool.height[i] >= best)
                break;
            int tip = column - (i - tool.zero);
            if (tip >= 0 && tip < int(floor.size()))
                best = std::min(best, floor[tip] + tool.height[i]);
        }
    return best;
}

// How far (0, x) is from the line between (z, from) and (z + wide, to).
double to_line(double x, double z, double wide, double from, double to)
{
    double rise = to - from;
    double part = (-z * wide + (x - from) * rise) / (wide * wide + rise * rise);
    part = std::clamp(part, 0.0, 1.0);
    return std::hypot(z + part * wide, from + part * rise - x);
}

} // namespace

} // namespace lathe

void vl_reach(const struct vl_tool *tool, const double *wanted, double *reached,
              int count, int per_step)
{
    using namespace lathe;
    std::vector<double> surface(wanted, wanted + count);
    // Where nothing is wanted the tool may go past the axis by its nose.
    for (double &radius : surface)
        if (radius <= 0)
            radius = -tool->nose;
    double highest = *std::max_element(surface.begin(), surface.end());
    Table table(Outline(*tool), per_step, highest + tool->nose, count);
    std::vector<double> floor(count + table.zero);
    for (size_t tip = 0; tip < floor.size(); tip++)
        floor[tip] = floor_at(surface, highest, table, int(tip));
    double lowest = *std::min_element(floor.begin(), floor.end());
    for (int i = 0; i < count; i++) {
        double best = reached_at(floor, lowest, table, i);
        reached[i] = std::max(wanted[i], best);
    }
}

double vl_above(const double *surface, int count, int per_step, int column,
                double radius)
{
    const double wide = 1.0 / per_step, wall = 1e9;
    double best = radius - surface[column];
    for (int away = 0; away * wide < best; away++)
        for (int first : {column + away, column - away - 1})
            if (first >= 0 && first + 1 < count)
                best = std::min(
                    best, lathe::to_line(radius, (first - column) * wide, wide,
                                         std::min(surface[first], wall),
                                         std::min(surface[first + 1], wall)));
    return best;
}
