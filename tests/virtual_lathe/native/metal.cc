// SPDX-License-Identifier: Apache-2.0
// Turning is a radius that only ever gets smaller:
//
//      tool   |      /           A tool with its tip at (z, x) leaves at
//             |     /            most x + outline(u) at z + u.  Whatever
//             |   _/             stood higher is gone, chips and overhangs
//              \_/               with it: a radius has no undercut.
//            tip u -> free end
//
// The tip is the corner of the square around the nose, on the chuck's and on
// the axis' side, so the nose's centre is one radius away from it in Z and X.

#include "metal.hh"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace lathe
{

namespace
{

constexpr double NOTHING = std::numeric_limits<double>::infinity();
constexpr double TINY = 1e-9; // steps; less than this is arithmetic
constexpr double SCALLOP = 0.005;

double radians(double degrees)
{
    return degrees * std::acos(-1.0) / 180;
}

} // namespace

Outline::Edge Outline::edge(double nose, double degrees)
{
    if (degrees >= 90)
        return {nose, nose, NOTHING};
    double angle = radians(degrees);
    return {nose * std::sin(angle), nose * (1 - std::cos(angle)),
            std::tan(angle)};
}

Outline::Outline(const vl_tool &tool)
    : nose_(tool.width > 0 ? std::min(tool.nose, tool.width / 2) : tool.nose),
      chuck_centre_(nose_), free_centre_(std::max(nose_, tool.width - nose_)),
      chuck_(edge(nose_, tool.chuck_edge)), free_(edge(nose_, tool.free_edge))
{
}

double Outline::side(double beyond_centre, const Edge &edge) const
{
    if (beyond_centre <= edge.tangent_z + TINY) {
        double rest = nose_ * nose_ - beyond_centre * beyond_centre;
        return nose_ - std::sqrt(std::max(0.0, rest));
    }
    return edge.tangent_x + (beyond_centre - edge.tangent_z) * edge.slope;
}

double Outline::at(double u) const
{
    if (u < chuck_centre_)
        return side(chuck_centre_ - u, chuck_);
    return u > free_centre_ ? side(u - free_centre_, free_) : 0;
}

double Outline::lowest(double from, double to) const
{
    if (to < chuck_centre_)
        return at(to);
    return from > free_centre_ ? at(from) : 0;
}

// Circles of radius r, s apart, leave ridges s * s / 8r high between them.
double Outline::stride() const
{
    return std::clamp(std::sqrt(8 * SCALLOP * nose_), 1.0 / VL_COLUMNS_PER_STEP,
                      2.0);
}

Metal::Metal(double radius, int first_z, int last_z)
    : radii((last_z - first_z) * PER_STEP + 1, radius), radius_(radius),
      first_z_(first_z), outline_({0, 0, 90, 90}),
      highest_((radii.size() + BLOCK - 1) / BLOCK, radius)
{
}

void Metal::set_tool(const vl_tool &tool)
{
    outline_ = Outline(tool);
}

// Blocks in which anything stands higher than the lowest the tool gets there.
void Metal::find_near(const vl_path &path)
{
    double x = std::min(path.x_from, path.x_to);
    double z_low = std::min(path.z_from, path.z_to);
    double z_high = std::max(path.z_from, path.z_to);
    near_.clear();
    for (size_t b = 0; b < highest_.size(); b++) {
        if (highest_[b] <= x)
            continue;
        double from = z_of(b * BLOCK) - z_high;
        double to = z_of((b + 1) * BLOCK) - z_low;
        if (highest_[b] > x + outline_.lowest(from, to))
            near_.push_back(b);
    }
}

void Metal::cut_block(size_t block, double x, double z, bool trial, vl_cut &cut)
{
    size_t first = block * BLOCK;
    size_t end = std::min(first + BLOCK, radii.size());
    if (highest_[block] <= x + outline_.lowest(z_of(first) - z, z_of(end) - z))
        return;
    for (size_t i = first; i < end; i++) {
        double left = std::max(0.0, x + outline_.at(z_of(i) - z));
        if (radii[i] <= left + TINY)
            continue;
        cut.columns++;
        cut.reach = std::max(cut.reach, radii[i] - x);
        if (!trial)
            radii[i] = left;
    }
}

void Metal::update_highest(size_t block)
{
    auto first = radii.begin() + block * BLOCK;
    auto end = radii.begin() + std::min((block + 1) * BLOCK, radii.size());
    highest_[block] = *std::max_element(first, end);
}

// Metal cut through to the axis is held by nothing in front of the cut.
void Metal::let_fall(vl_cut &cut)
{
    auto severed = radii.end();
    for (size_t b : near_) {
        auto first = radii.begin() + b * BLOCK;
        auto end = radii.begin() + std::min((b + 1) * BLOCK, radii.size());
        auto through = std::find(first, end, 0.0);
        if (through != end)
            severed = std::min(severed, through);
    }
    if (std::all_of(severed, radii.end(), [](double r) { return r == 0; }))
        return;
    cut.fallen = int(severed - radii.begin());
    fallen.assign(severed, radii.end());
    std::fill(severed, radii.end(), 0.0);
    for (size_t b = cut.fallen / BLOCK; b < highest_.size(); b++)
        update_highest(b);
}

bool Metal::touches(double x, double z) const
{
    for (size_t b = 0; b < highest_.size(); b++) {
        size_t end = std::min((b + 1) * BLOCK, radii.size());
        double low = outline_.lowest(z_of(b * BLOCK) - z, z_of(end) - z);
        if (highest_[b] < x + low - TINY)
            continue;
        for (size_t i = b * BLOCK; i < end; i++)
            if (radii[i] > 0 && radii[i] >= x + outline_.at(z_of(i) - z) - TINY)
                return true;
    }
    return false;
}

vl_cut Metal::move(const vl_path &path, bool trial)
{
    vl_cut cut = {0, -1, 0};
    if (std::min(path.x_from, path.x_to) >= radius_)
        return cut;
    find_near(path);
    if (near_.empty())
        return cut;
    double dx = path.x_to - path.x_from, dz = path.z_to - path.z_from;
    int places = std::ceil(std::hypot(dx, dz) / outline_.stride() - TINY);
    places = std::max(1, places);
    for (int i = 1; i <= places; i++) {
        double part = double(i) / places;
        for (size_t block : near_)
            cut_block(block, path.x_from + part * dx, path.z_from + part * dz,
                      trial, cut);
    }
    if (trial || cut.columns == 0)
        return cut;
    for (size_t block : near_)
        update_highest(block);
    let_fall(cut);
    return cut;
}

} // namespace lathe

namespace
{

std::vector<std::unique_ptr<lathe::Metal>> &pieces()
{
    static std::vector<std::unique_ptr<lathe::Metal>> all;
    return all;
}

int copy(const std::vector<double> &from, double *to, int room)
{
    std::copy_n(from.begin(), std::min<size_t>(room, from.size()), to);
    return from.size();
}

} // namespace

lathe::Metal &lathe::piece(int number)
{
    return *pieces()[number];
}

int vl_metal_new(double radius, int first_z, int last_z)
{
    pieces().push_back(std::make_unique<lathe::Metal>(radius, first_z, last_z));
    return pieces().size() - 1;
}

void vl_metal_tool(int metal, const struct vl_tool *tool)
{
    pieces()[metal]->set_tool(*tool);
}

void vl_metal_move(int metal, const struct vl_path *path, int trial,
                   struct vl_cut *cut)
{
    *cut = pieces()[metal]->move(*path, trial);
}

int vl_metal_radii(int metal, double *radii, int room)
{
    return copy(pieces()[metal]->radii, radii, room);
}

double vl_metal_radius(int metal, int column)
{
    return pieces()[metal]->radii[column];
}

int vl_metal_fallen(int metal, double *radii, int room)
{
    return copy(pieces()[metal]->fallen, radii, room);
}

double vl_tool_outline(const struct vl_tool *tool, double u)
{
    return lathe::Outline(*tool).at(u);
}
