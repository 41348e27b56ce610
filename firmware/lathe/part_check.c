/* Checks a part image before it is stored or cut.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/part_check.h"
#include "arithmetic.h"     /* products */
#include "lathe/contour.h"  /* pieces, material */
#include "lathe/part.h"     /* header and records */
#include "link/protocol.h"  /* offsets, refusals */
#include "motion/arc.h"     /* root */
#include "motion/path.h"    /* kinds of segment */
#include "store/flash.h"    /* reading numbers */
#include "store/parts.h"    /* where the image is */
#include "store/settings.h" /* step size, travel, part zero */

#define IMAGE_FLAG_INCH 1
#define KIND_LAST 4  /* of a contour: profile */
#define TOOL_LAST 15 /* number of a tool */

uint8_t part_check_operation;

uint16_t part_check_max_rate(void)
{
    int16_t x = settings[SETTING_RAPID_RATE_X];
    int16_t z = settings[SETTING_RAPID_RATE_Z];

    return x < z ? x : z;
}

/* At least one character of a-z 0-9 -, then zeros only. */
static uint8_t name_valid(void)
{
    uint8_t last = '-';
    uint8_t i;

    for (i = 0; i < NAME_LENGTH; i++) {
        uint8_t c = flash_read();

        if (c == 0 ? i == 0
                   : last == 0 || !(c == '-' || (c >= '0' && c <= '9') ||
                                    (c >= 'a' && c <= 'z'))) {
            return 0;
        }
        last = c;
    }
    return 1;
}

static uint8_t feed_wrong(uint16_t feed)
{
    if (feed < FEED_MIN) {
        return 1;
    }
    return (feed - 1) / FEED_UNIT >= part_check_max_rate();
}

static uint8_t length_valid(int16_t length)
{
    return length > 0 && length <= POSITION_MAX;
}

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
static uint8_t check_zero(void)
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

static uint8_t check_header(void)
{
    parts_seek(PART_IMAGE_FORMAT_AT);
    if (flash_read() != PART_IMAGE_FORMAT) {
        return REFUSAL_FORMAT;
    }
    flash_read(); /* the number of operations */
    if (flash_read() > IMAGE_FLAG_INCH) {
        return REFUSAL_FORMAT;
    }
    if (flash_read() != 0) {
        return REFUSAL_FORMAT;
    }
    if (!name_valid()) {
        return REFUSAL_NAME;
    }
    /* The name is followed by the step sizes. */
    if ((int16_t)flash_read_u16() != settings[SETTING_STEP_X_NM] ||
        (int16_t)flash_read_u16() != settings[SETTING_STEP_Z_NM]) {
        return REFUSAL_STEP_SIZE;
    }
    if (!length_valid(part_stock_radius) || !length_valid(part_stock_length) ||
        part_stock_front < 0 || part_stock_front > STOCK_FRONT_MAX) {
        return REFUSAL_STOCK;
    }
    if (part_operations == 0 || part_operations > OPERATIONS_MAX) {
        return REFUSAL_OPERATION_COUNT;
    }
    if (part_retract <= 0 || part_retract > RETRACT_MAX) {
        return REFUSAL_RETRACT;
    }
    part_offset_x = 0;
    part_offset_z = 0;
    return check_zero();
}

static uint8_t check_cut(void)
{
    if (part_kind > SPRING_MAX) {
        return REFUSAL_FORMAT;
    }
    if (part_depth_of_cut == 0 ||
        part_depth_of_cut > (uint16_t)part_stock_radius) {
        return REFUSAL_DEPTH_OF_CUT;
    }
    if (part_allowance > part_depth_of_cut) {
        return REFUSAL_ALLOWANCE;
    }
    if (feed_wrong(part_feed) || feed_wrong(part_finish_feed)) {
        return REFUSAL_FEED;
    }
    if (part_spindle != 0 &&
        (part_spindle < (uint16_t)settings[SETTING_SPINDLE_MIN] ||
         part_spindle > (uint16_t)settings[SETTING_SPINDLE_MAX])) {
        return REFUSAL_SPINDLE;
    }
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
    factor_1 = most;
    factor_2 = dz;
    return ((uint32_t)(uint16_t)dx << 8) > product() ? reason : 0;
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

static uint16_t root(uint32_t square)
{
    root_of = square;
    return root_find();
}

/* The motion takes the arc, and neither end lies beyond its extremum of z.
   The first lines see to it that the motion's own check cannot overflow. */
static uint8_t arc_valid(void)
{
    uint16_t radius = root(contour_square);
    uint16_t off =
        root(contour_squared(contour_to_x) + contour_squared(contour_to_z)) -
        radius + 2;
    int16_t from_x = contour_from_x;
    int16_t to_x = contour_to_x;

    if (contour_arc != SEGMENT_ARC_CW) {
        from_x = -from_x;
        to_x = -to_x;
    }
    if ((from_x | to_x) < 0) {
        return 0;
    }
    if (radius > RADIUS_MAX || off > 4 || contour_to_z > contour_from_z) {
        return 0;
    }
    parts_seek(contour_at - 6);
    path_present.kind = contour_arc;
    path_present.dx = contour_dx;
    path_present.dz = contour_dz;
    path_present.cx = flash_read_i24();
    path_present.cz = flash_read_i24();
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

static uint8_t check_contour(void)
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

static uint8_t check_plunge(void)
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

/* More bytes than a record of closed form has are wrong too. */
static uint8_t size_wrong(uint8_t size)
{
    return part_size != size;
}

/* The record read last, whose bytes are there; number: of the record, from
   0. */
static uint8_t check_record(uint8_t number)
{
    if (part_type == 0 || part_type > OPERATION_PLUNGE) {
        return REFUSAL_OPERATION_TYPE;
    }
    if (number < 2 && part_type != number + 1) {
        return REFUSAL_ORDER;
    }
    switch (part_type) {
    case OPERATION_TOOL:
        if (size_wrong(OPERATION_TOOL_SIZE)) {
            break;
        }
        part_apply();
        if (part_kind > TOOL_LAST || part_width > WIDTH_MAX ||
            part_below > WIDTH_MAX) {
            return REFUSAL_FORMAT;
        }
        return check_zero();
    case OPERATION_CUT:
        if (size_wrong(OPERATION_CUT_SIZE)) {
            break;
        }
        part_apply();
        return check_cut();
    case OPERATION_PAUSE:
        if (part_size > OPERATION_PAUSE_MAX) {
            break;
        }
        return part_kind > 1 ? REFUSAL_FORMAT : 0;
    case OPERATION_CONTOUR:
        if (part_size < OPERATION_CONTOUR_SEGMENTS_AT) {
            break;
        }
        return check_contour();
    default:
        if (size_wrong(OPERATION_PLUNGE_SIZE)) {
            break;
        }
        return check_plunge();
    }
    return REFUSAL_OPERATION_SIZE;
}

static uint8_t check_records(void)
{
    uint8_t number = 0;
    uint8_t operations = 0;
    uint8_t reason;
    uint16_t left = part_length - PART_IMAGE_HEADER_SIZE;

    contour_own = PART_IMAGE_HEADER_SIZE;
    while (left != 0) {
        part_check_operation = operations + 1;
        if (left < OPERATION_HEAD_SIZE) {
            return REFUSAL_LENGTH;
        }
        part_record = contour_own;
        part_read_record();
        if (part_size < OPERATION_HEAD_SIZE || part_size > left) {
            return REFUSAL_LENGTH;
        }
        lowest = part_stock_radius;
        left -= part_size;
        reason = check_record(number); /* comes back to this record */
        contour_own += part_size;
        if (reason != 0) {
            return reason;
        }
        if (part_type >= OPERATION_PAUSE && operations <= OPERATIONS_MAX) {
            operations++; /* too many are never the right number */
        }
        if (number < 2) {
            number++;
        }
    }
    part_check_operation = 0;
    return operations == part_operations ? 0 : REFUSAL_OPERATION_COUNT;
}

uint8_t part_check(uint8_t slot, uint16_t length)
{
    uint8_t reason;

    part_check_operation = 0;
    if (length < PART_IMAGE_HEADER_SIZE || length > PART_IMAGE_MAX) {
        return REFUSAL_LENGTH;
    }
    part_open(slot, length);
    reason = check_header();
    return reason != 0 ? reason : check_records();
}
