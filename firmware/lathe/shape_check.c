/* Checks of the contours and plunges of a part.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/shape_check.h"
#include "lathe/contour.h"          /* pieces, material */
#include "lathe/part.h"             /* records */
#include "lathe/shape_arithmetic.h" /* slopes, arcs */
#include "link/protocol.h"          /* offsets, refusals */
#include "motion/arc.h"             /* arcs that the motion takes */
#include "motion/path.h"            /* kinds of segment */
#include "store/flash.h"            /* reading numbers */
#include "store/parts.h"            /* where the image is */
#include "store/settings.h"         /* travel, part zero */

#define KIND_LAST 4 /* of a contour: profile */

/* Part coordinates of the low ends of the travels, for the tool in use. */
static int16_t lowest_x;
static int16_t lowest_z;

/* Leaves machine zero, seen from the part's zero, in lowest_z; 1 = out of
   range. */
static uint8_t zero_wrong(uint8_t id, int16_t offset, int16_t stock)
{
    lowest_z = -(settings[id] + offset);
    if (lowest_z < 0 || lowest_z > POSITION_MAX) {
        return 1;
    }
    stock = lowest_z - stock; /* room for the retract, both 0 to 32,000 */
    return stock < part_retract;
}

/* The tool clears the stock; that place must be inside the travel, whose
   high end is machine zero. */
uint8_t shape_check_tool(void)
{
    if (zero_wrong(SETTING_ZERO_X, part_offset_x, part_stock_radius)) {
        return REFUSAL_OUTSIDE_TRAVEL;
    }
    lowest_x = lowest_z - settings[SETTING_TRAVEL_X];
    if (zero_wrong(SETTING_ZERO_Z, part_offset_z,
                   part_stock_front + part_retract)) {
        return REFUSAL_OUTSIDE_TRAVEL;
    }
    lowest_z -= settings[SETTING_TRAVEL_Z];
    return 0;
}

static int16_t lowest; /* smallest x of the contour so far */

/* What check_place() looks at. */
static int16_t place_x;
static int16_t place_z;

static uint8_t check_place(void)
{
    if (place_x < -(int16_t)part_below) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    if (place_x > part_stock_radius) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    if (place_z < part_retract - part_stock_length) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    if (place_x < lowest_x) {
        return REFUSAL_OUTSIDE_TRAVEL;
    }
    if (place_z < lowest_z) {
        return REFUSAL_OUTSIDE_TRAVEL;
    }
    if (place_x < lowest) {
        lowest = place_x;
    }
    return 0;
}

/* The same for a place that must lie behind contour_zs and outwards (up) or
   inwards of contour_xs: where it does not, 16 bits have not held it. */
static uint8_t check_next(uint8_t up)
{
    if (place_z > contour_zs) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    if (up ? place_x < contour_xs : place_x > contour_xs) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    return check_place();
}

/* A tangent of dx steps up, down if negative, for dz steps along. */
static uint8_t check_slope(int16_t dx, uint16_t dz)
{
    uint16_t most = part_front;
    uint8_t reason = REFUSAL_FRONT_EDGE;

    if (dx < 0) {
        dx = -dx;
        most = part_back;
        reason = REFUSAL_BACK_EDGE;
    }
    if (most == SLOPE_ANY) {
        return 0;
    }
    return shape_steeper(dx, most, dz) ? reason : 0;
}

/* The tangent of the arc at a place given from its centre. Rises on the
   side of the free end of a convex arc, falls on that of a concave one. */
static uint8_t check_tangent(int16_t x, int16_t z)
{
    if (contour_arc != SEGMENT_ARC_CW) {
        x = -x;
        z = -z;
    }
    return check_slope(z, x);
}

/* True when the motion takes the arc just read, and neither end lies beyond its
   extremum of z. The first lines see to it that the motion's own check cannot
   overflow. */
static uint8_t arc_valid(void)
{
    uint16_t radius = shape_radius();
    uint16_t off = shape_end_radius() - radius + 2;
    int16_t from_x = contour_from_x;
    int16_t to_x = contour_to_x;

    if (contour_arc != SEGMENT_ARC_CW) {
        from_x = -from_x;
        to_x = -to_x;
    }
    if (from_x < 0 || to_x < 0 || contour_to_z > contour_from_z) {
        return 0;
    }
    if (radius > RADIUS_MAX || off > 4) {
        return 0;
    }
    path_next.kind = contour_arc;
    path_next.dx = contour_dx;
    path_next.dz = contour_dz;
    contour_read_centre();
    path_try();
    return arc_begin();
}

static uint8_t check_arc(void)
{
    uint8_t reason;

    if (!arc_valid()) {
        return REFUSAL_ARC;
    }
    if (contour_split) {
        if (part_kind & CONTOUR_FACING) {
            return REFUSAL_DIRECTION; /* it falls on one side */
        }
        place_x = contour_xe;
        if (contour_arc == SEGMENT_ARC_CW) {
            place_x--; /* its top as it is */
        }
        place_z = contour_ze;
        reason = check_next(contour_arc == SEGMENT_ARC_CW);
        if (reason != 0) {
            return reason;
        }
    }
    reason = check_tangent(contour_from_x, contour_from_z);
    if (reason == 0) {
        reason = check_tangent(contour_to_x, contour_to_z);
    }
    if (contour_split) {
        contour_next();
    }
    return reason;
}

/* The segment at contour_at. 16 bits do not hold its end when that lies on
   the wrong side of its start. */
static uint8_t check_segment(void)
{
    uint8_t reason;

    parts_seek(contour_at);
    contour_arc = flash_read();
    if (contour_arc > SEGMENT_ARC_CCW ||
        contour_own + part_size - contour_at < contour_size()) {
        return REFUSAL_OPERATION_SIZE;
    }
    contour_next();
    if (contour_dz > 0 || ((part_kind & CONTOUR_FACING) && contour_dx < 0)) {
        return REFUSAL_DIRECTION;
    }
    if (contour_dx == 0 && contour_dz == 0) {
        return REFUSAL_EMPTY_CUT;
    }
    place_x = contour_xs + contour_dx;
    place_z = contour_zs + contour_dz;
    reason = check_next(contour_dx >= 0);
    if (reason != 0) {
        return reason;
    }
    return contour_arc == SEGMENT_LINE ? check_slope(contour_dx, -contour_dz)
                                       : check_arc();
}

uint8_t shape_check_contour(void)
{
    uint8_t facing = part_kind & CONTOUR_FACING;
    uint16_t end = part_record + part_size;
    int16_t x;
    int16_t z;
    uint8_t reason;

    if ((part_kind & CONTOUR_KIND) > KIND_LAST ||
        (part_kind & (uint8_t) ~(CONTOUR_KIND | CONTOUR_FACING))) {
        return REFUSAL_FORMAT;
    }
    if (part_width != 0) {
        return REFUSAL_TOOL;
    }
    contour_open();
    lowest = part_stock_radius;
    x = contour_xe;
    z = contour_ze;
    place_x = x;
    place_z = z;
    if (z > part_stock_front + part_retract) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    reason = check_place();
    if (reason != 0) {
        return reason;
    }
    do {
        reason = check_segment();
        if (reason != 0) {
            return reason;
        }
    } while (contour_at != end);
    if (facing) {
        return contour_ze >= part_stock_front ? REFUSAL_EMPTY_CUT : 0;
    }
    if (contour_ze == z || lowest >= part_stock_radius) {
        return REFUSAL_EMPTY_CUT;
    }
    if (part_back == SLOPE_ANY || contour_material(x, z + 1) <= z) {
        return 0;
    }
    return REFUSAL_BLOCKED;
}

uint8_t shape_check_plunge(void)
{
    int16_t high = flash_read_u16();
    uint8_t reason;

    place_z = flash_read_u16();
    place_x = flash_read_u16();

    if (part_kind > 1) {
        return REFUSAL_FORMAT;
    }
    if (part_width == 0) {
        return REFUSAL_TOOL;
    }
    if (high > part_stock_front + part_retract - (int16_t)part_width) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    reason = check_place();
    if (reason == 0 && (place_z > high || place_x >= part_stock_radius)) {
        reason = REFUSAL_EMPTY_CUT;
    }
    return reason;
}
