/* Plan: speeds and corners of the queued segments.
   SPDX-License-Identifier: Apache-2.0 */

#include "motion/plan.h"
#include "motion/interpolate.h" /* stretch of a slope */
#include "motion/path.h"        /* segments */
#include "motion/ramp.h"        /* braking distances */
#include "sfr.h"                /* INTCON */

#define GIEL_MASK 0x40
#define UNIT 128  /* a direction of length 1 */
#define TANGENT 2 /* changes of direction up to this do not count */
#define NO_LIMIT 0xFFFF
#define BACK (UNIT + UNIT / 8) /* more than a stop: the axis turns back */

uint16_t plan_start_x;
uint16_t plan_start_z;
uint16_t plan_maximum_x;
uint16_t plan_maximum_z;

/* Direction at the end of the last segment, and the one asked for. */
static int16_t end_x;
static int16_t end_z;
static int16_t unit_x;
static int16_t unit_z;
static uint8_t standing;

void plan_begin(void)
{
    standing = 1;
}

static uint16_t magnitude(int16_t value)
{
    return value < 0 ? -value : value;
}

/* unit_ := direction of (x, z), length UNIT within 1 %. */
static void direction(int16_t x, int16_t z)
{
    uint16_t larger = magnitude(x);
    uint16_t smaller = magnitude(z);
    uint8_t swapped = larger < smaller;
    uint8_t slope = 255;

    if (swapped) {
        larger = smaller;
        smaller = magnitude(x);
    }
    while (larger > 255) {
        larger >>= 1;
        smaller >>= 1;
    }
    if (larger != smaller) {
        slope = (uint8_t)((smaller << 8) / larger);
    }
    larger = 32768u / (256u + interpolate_stretch(slope));
    smaller = (uint16_t)((uint8_t)larger * slope) >> 8;
    unit_x = swapped ? smaller : larger;
    unit_z = swapped ? larger : smaller;
    if (x < 0) {
        unit_x = -unit_x;
    }
    if (z < 0) {
        unit_z = -unit_z;
    }
}

/* Speed at which an axis with this share of the direction reaches its own
   limit, step/s. */
static uint16_t axis_limit(uint16_t limit, uint16_t share)
{
    uint32_t speed = ((uint32_t)limit << 7) / (share > TANGENT ? share : 1);

    return share <= TANGENT || speed > NO_LIMIT ? NO_LIMIT : (uint16_t)speed;
}

static uint16_t smaller_of(uint16_t one, uint16_t other)
{
    return one < other ? one : other;
}

/* Braking distance that the change of direction at the start allows. */
static uint16_t corner(void)
{
    uint16_t turn_x = magnitude(unit_x - end_x);
    uint16_t turn_z = magnitude(unit_z - end_z);
    uint16_t speed;

    if (standing) {
        return ramp_stop;
    }
    if (turn_x > BACK || turn_z > BACK) {
        path_next.kind |= SEGMENT_REST;
        return ramp_stop;
    }
    speed = smaller_of(axis_limit(plan_start_x, turn_x),
                       axis_limit(plan_start_z, turn_z));
    return speed == NO_LIMIT ? NO_LIMIT : ramp_distance(speed);
}

/* Entries from the last segment back, as far as something changes. */
void plan_back(uint8_t index)
{
    uint16_t entry = ramp_stop;
    uint16_t way;

    while (index != ramp_segment) {
        __data struct segment *segment = &segments[index];

        way = segment->count > 32000u ? 64000u : segment->count << 1;
        entry += way;
        if (entry < way) {
            entry = NO_LIMIT;
        }
        if (entry > segment->corner) {
            entry = segment->corner;
        }
        if (segment->entry == entry) {
            return;
        }
        INTCON &= (uint8_t)~GIEL_MASK;
        segment->entry = entry;
        INTCON |= GIEL_MASK;
        index = (index == 0 ? SEGMENTS : index) - 1;
    }
}

/* Direction of an arc at a point given from its centre, 1/256 step: the
   position turned by a right angle. */
static void tangent(uint8_t kind, int32_t x, int32_t z)
{
    while (x > 32767 || x < -32767 || z > 32767 || z < -32767) {
        x >>= 1;
        z >>= 1;
    }
    if (kind == SEGMENT_ARC_CCW) {
        direction(-(int16_t)z, (int16_t)x);
    } else {
        direction((int16_t)z, -(int16_t)x);
    }
}

static void plan_arc(uint8_t kind)
{
    int32_t x = -path_next.cx;
    int32_t z = -path_next.cz;

    tangent(kind, x, z);
    path_next.corner = corner();
    tangent(kind, x + ((int32_t)path_next.dx << 8),
            z + ((int32_t)path_next.dz << 8));
}

void plan_next(void)
{
    uint8_t kind = path_next.kind & SEGMENT_KIND;
    uint16_t most = smaller_of(plan_maximum_x, plan_maximum_z);
    uint16_t own;

    path_next.corner = NO_LIMIT;
    path_next.entry = NO_LIMIT - 1; /* differs from any that is planned */
    if (kind == SEGMENT_WAIT) {
        standing = 1;
        path_next.corner = ramp_stop;
    } else if (kind <= SEGMENT_ARC_CCW) {
        if (kind == SEGMENT_LINE) {
            direction(path_next.dx, path_next.dz);
            most = smaller_of(axis_limit(plan_maximum_x, magnitude(unit_x)),
                              axis_limit(plan_maximum_z, magnitude(unit_z)));
            path_next.corner = corner();
        } else {
            plan_arc(kind);
        }
        end_x = unit_x;
        end_z = unit_z;
        standing = 0;
    }
    if ((uint16_t)(path_rate >> 8) >= most) {
        path_rate = (uint32_t)most << 8;
    }
    own = ramp_distance((uint16_t)(path_rate >> 8));
    if (kind <= SEGMENT_ARC_CCW && path_next.corner > own) {
        path_next.corner = own; /* not in faster than it goes on */
    }
}
