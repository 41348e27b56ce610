// SPDX-License-Identifier: Apache-2.0
// The bar in the chuck: a radius for every sixteenth of a step of Z, and the
// outline of the tool that lowers them.

#ifndef VIRTUAL_LATHE_METAL_HH
#define VIRTUAL_LATHE_METAL_HH

#include "virtual_lathe.h"

#include <stddef.h>
#include <vector>

namespace lathe
{

// What a tool occupies, seen from the axis: at a distance u along Z from its
// tip everything from at(u) outwards.  Infinite where there is no tool.
class Outline
{
public:
    explicit Outline(const vl_tool &tool);
    double at(double u) const;
    // The lowest of at(u) for from <= u <= to.
    double lowest(double from, double to) const;
    // Where on the way from u = 0 to the free side it is lowest first.
    double bottom() const
    {
        return chuck_centre_;
    }
    // How far the tool may move at a time so that what is left standing
    // between two places is lower than 0.005 step.
    double stride() const;

private:
    // An edge leaves the circle of the nose where it touches it.
    struct Edge {
        double tangent_z, tangent_x, slope;
    };
    static Edge edge(double nose, double degrees);
    double side(double beyond_centre, const Edge &edge) const;

    double nose_, chuck_centre_, free_centre_;
    Edge chuck_, free_;
};

class Metal
{
public:
    Metal(double radius, int first_z, int last_z);
    void set_tool(const vl_tool &tool);
    // Moves the tip on a straight line.  A trial removes nothing.
    vl_cut move(const vl_path &path, bool trial);
    // Whether there is no gap to a tool that has its tip here.
    bool touches(double x, double z) const;

    std::vector<double> radii;  // steps, one for each column
    std::vector<double> fallen; // the piece that fell off last
    static constexpr int PER_STEP = VL_COLUMNS_PER_STEP;

private:
    static constexpr size_t BLOCK = 256; // columns looked at at once
    void find_near(const vl_path &path);
    void cut_block(size_t block, double x, double z, bool trial, vl_cut &cut);
    void update_highest(size_t block);
    void let_fall(vl_cut &cut);
    double z_of(size_t column) const
    {
        return first_z_ + double(column) / PER_STEP;
    }

    double radius_;
    int first_z_;
    Outline outline_;
    std::vector<double> highest_; // radius in each block
    std::vector<size_t> near_;    // blocks the present move may touch
};

// The metal that vl_metal_new() has numbered so.
Metal &piece(int number);

} // namespace lathe

#endif
