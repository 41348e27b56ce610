/* Cuts: the passes of one operation.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/cuts.h"
#include "arithmetic.h"    /* proportions */
#include "lathe/contour.h" /* stretches, material */
#include "lathe/part.h"    /* cutting data */
#include "link/protocol.h" /* types */
#include "motion/path.h"   /* kinds of segment, feeding the stream */
#include "store/flash.h"   /* reading numbers */

#define FARTHEST 32767
#define NOWHERE (-32767 - 1)

uint8_t cuts_kind;
int16_t cuts_height;
int16_t cuts_rise;
int16_t cuts_z;
int16_t cuts_x;
int16_t cuts_end;
uint8_t cuts_open;
uint8_t cuts_finish;
int16_t cuts_start;
uint16_t cuts_pass;
uint16_t cuts_passes;

static uint8_t roughing; /* CUT_ALONG, CUT_FACING or CUT_PLUNGE */
static uint8_t follows;  /* passes along the contour to come */
static int16_t start_x;
static int16_t end_z;
static int16_t top; /* largest radius left over the operation */
static uint16_t allowance;
static int16_t from;        /* level 0 */
static uint16_t step_depth; /* from level to level */
static uint16_t deeper;     /* levels that take one step more */
static uint16_t levels;
static uint16_t level; /* 1.. */
static int16_t last_s; /* of the stretch cut last */
static int16_t last_e;

static void spread(int16_t to)
{
    uint16_t depth = (uint16_t)(from - to);

    levels = 0;
    if (from > to) {
        levels = (depth + part_depth_of_cut - 1) / part_depth_of_cut;
        step_depth = depth / levels;
        deeper = depth % levels;
    }
}

static int16_t level_at(uint16_t number)
{
    return from - step_depth * number - (number < deeper ? number : deeper);
}

/* Largest radius left between two places, z_high > z_low. */
static int16_t highest(int16_t z_high, int16_t z_low)
{
    int16_t low = -(int16_t)part_below;
    int16_t high = part_stock_radius;

    while (low < high) { /* 15 times at most */
        int16_t middle = low + ((uint16_t)(high - low) >> 1);

        path_bridge();
        if (contour_material(middle, z_high) <= z_low) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return high;
}

static uint8_t begin_plunge(void)
{
    uint16_t over = part_width - (part_width >> 2);

    cuts_start = flash_read_u16();
    end_z = flash_read_u16();
    cuts_end = flash_read_u16();
    top = highest(cuts_start + part_width, end_z);
    levels = (uint16_t)(cuts_start - end_z + over - 1) / over + 1;
    roughing = CUT_PLUNGE;
    cuts_open = 0;
    return top > cuts_end;
}

/* Reads the whole contour: from = its smallest x. Returns 1 when it is a line
   along an axis. */
static uint8_t measure(void)
{
    uint8_t pieces = 0;

    contour_open();
    cuts_start = contour_ze;
    start_x = contour_xe;
    from = start_x;
    while (contour_next()) {
        if (pieces < 2) {
            pieces++;
        }
        if (contour_xe < from) {
            from = contour_xe;
        }
    }
    end_z = contour_ze;
    allowance = cuts_start == end_z ? 0 : part_allowance;
    if (pieces != 1 || contour_arc != SEGMENT_LINE) {
        return 0;
    }
    return start_x == contour_xe || cuts_start == end_z;
}

static uint8_t begin_contour(void)
{
    uint8_t facing = part_kind & CONTOUR_FACING;
    uint8_t simple = measure();
    int16_t lowest = from;

    roughing = CUT_ALONG;
    last_s = cuts_start;
    last_e = end_z;
    if (facing) {
        roughing = CUT_FACING;
        top = highest(part_stock_front, end_z);
        from = contour_material(start_x, part_stock_front);
        spread(end_z);
        if (levels == 0) {
            return 0;
        }
    } else {
        top = highest(cuts_start, end_z);
        if (top <= lowest) {
            return 0;
        }
        from = top;
        if (allowance > (uint16_t)(top - lowest)) {
            allowance = top - lowest;
        }
        spread(lowest + allowance);
    }
    if (!simple || allowance != 0) {
        follows = part_spring + 1;
        if (allowance != 0 && !simple) {
            follows++;
        }
    }
    return 1;
}

uint8_t cuts_begin(void)
{
    uint8_t any;

    level = 0;
    follows = 0;
    any = part_type == OPERATION_PLUNGE ? begin_plunge() : begin_contour();
    cuts_pass = 0;
    cuts_passes = levels + follows;
    cuts_height = top + part_retract;
    cuts_rise = cuts_height;
    cuts_finish = 0;
    return any;
}

static uint8_t next_plunge(void)
{
    if (level == levels) {
        return 0;
    }
    cuts_z = cuts_start;
    if (level != 0) {
        factor_1 = (uint16_t)(cuts_start - end_z);
        factor_2 = level;
        divisor = levels - 1;
        cuts_z -= (int16_t)proportion();
    }
    level++;
    cuts_pass = level;
    return 1;
}

static uint8_t next_facing(void)
{
    int16_t low;
    int16_t high;
    int16_t middle;

    cuts_open = 0;
    while (level != levels) {
        level++;
        cuts_z = level_at(level);
        low = start_x;
        high = top;
        while (low < high) {
            path_bridge();
            middle = low + ((uint16_t)(high - low) >> 1);
            contour_stretch(middle, FARTHEST);
            if (contour_e <= cuts_z) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        cuts_end = high;
        if (cuts_z < cuts_start) {
            cuts_end += allowance; /* in front of the contour all must go */
        }
        if (cuts_end < top) {
            cuts_pass = level;
            return 1;
        }
    }
    return 0;
}

static uint8_t stretch_at(uint16_t number, int16_t z)
{
    return contour_stretch(level_at(number) - (int16_t)allowance, z);
}

/* Sets level and stretch of the next pass along Z. */
static uint8_t next_stretch(void)
{
    int16_t above;

    if (level < levels && stretch_at(level + 1, last_s) && contour_s > last_e) {
        level++;
        return 1;
    }
    while (level != 0) {
        above = NOWHERE;
        if (level != 1) {
            stretch_at(level - 1, last_s); /* the one that it lies in */
            above = contour_e;
        }
        if (stretch_at(level, last_e) && contour_s > above) {
            return 1;
        }
        last_e = above;
        level--;
    }
    return 0;
}

static uint8_t next_along(void)
{
    int16_t v;

    if (level == 0 && cuts_pass != 0) {
        return 0; /* all pockets are done */
    }
    while (next_stretch()) {
        path_bridge();
        if (cuts_rise < level_at(level - 1) + part_retract) {
            cuts_rise = level_at(level - 1) + part_retract;
        }
        cuts_pass = level;
        last_s = contour_s;
        last_e = contour_e;
        cuts_end = contour_e;
        cuts_x = level_at(level);
        v = cuts_x - (int16_t)allowance;
        cuts_z = contour_material(v, last_s);
        if (cuts_z > last_e) {
            cuts_open = 0;
            if (contour_material(v, cuts_z + part_retract) <= cuts_z) {
                cuts_z += part_retract;
                cuts_open = 1;
            }
            cuts_height = level_at(level - 1) + part_retract;
            return 1;
        }
    }
    return 0;
}

static uint8_t next_follow(void)
{
    int16_t before = cuts_start + part_retract;

    if (follows == 0) {
        return 0;
    }
    follows--;
    cuts_finish = follows <= part_spring;
    cuts_x = start_x;
    if (!cuts_finish) {
        cuts_x += allowance;
    }
    cuts_open = contour_material(start_x, before) <= cuts_start;
    cuts_z = cuts_open ? before : cuts_start;
    cuts_height = top + part_retract;
    cuts_rise = cuts_height;
    cuts_pass = cuts_passes - follows;
    return 1;
}

uint8_t cuts_next(void)
{
    uint8_t found;

    cuts_kind = roughing;
    if (roughing == CUT_PLUNGE) {
        return next_plunge();
    }
    found = roughing == CUT_FACING ? next_facing() : next_along();
    if (!found) {
        cuts_kind = CUT_FOLLOW;
        found = next_follow();
    }
    return found;
}
