/* Contour: stretches and material at a level.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/contour.h"
#include "arithmetic.h"    /* products */
#include "lathe/part.h"    /* records */
#include "link/protocol.h" /* types */
#include "motion/arc.h"    /* root */
#include "motion/path.h"   /* kinds of segment, feeding the stream */
#include "store/flash.h"   /* reading numbers */
#include "store/parts.h"   /* where the image is */

#define EVERYWHERE 32767
#define NOWHERE (-32767 - 1)
#define LINE_SIZE 5 /* bytes */
#define ARC_SIZE 11

uint16_t contour_own;

int16_t contour_zs;
int16_t contour_xs;
int16_t contour_ze;
int16_t contour_xe;
uint8_t contour_arc;
uint32_t contour_square;
int16_t contour_from_z;
int16_t contour_from_x;
int16_t contour_to_z;
int16_t contour_to_x;
int16_t contour_dz;
int16_t contour_dx;
uint8_t contour_split;
uint16_t contour_at;

int16_t contour_s;
int16_t contour_e;
uint8_t contour_contains;

static uint16_t end;   /* of the record; 0 = a line to contour_to_z */
static uint16_t width; /* of the tool of the record being asked */

static uint16_t size(int16_t value)
{
    return value < 0 ? -value : value;
}

uint32_t contour_squared(int16_t distance)
{
    factor_1 = size(distance);
    factor_2 = factor_1;
    return product();
}

void contour_open(void)
{
    parts_seek(part_record + OPERATION_HEAD_SIZE);
    contour_split = 0;
    contour_ze = flash_read_u16();
    contour_xe = flash_read_u16(); /* z_low of a plunge */
    if (part_type == OPERATION_PLUNGE) {
        contour_to_z = contour_xe;
        contour_ze += width;
        contour_xe = flash_read_u16();
        end = 0;
    } else {
        contour_at = part_record + OPERATION_CONTOUR_SEGMENTS_AT;
        end = part_record + part_size;
    }
}

/* A coordinate of a centre, rounded to steps. */
static int16_t read_centre(void)
{
    uint8_t fraction = flash_read();

    return (int16_t)(flash_read_u16() + (fraction >> 7));
}

static void read_arc(void)
{
    int16_t radius;

    contour_from_x = -read_centre();
    contour_from_z = -read_centre();
    contour_square =
        contour_squared(contour_from_x) + contour_squared(contour_from_z);
    contour_to_x = contour_from_x + contour_dx;
    contour_to_z = contour_from_z + contour_dz;
    if (contour_from_z > 0 && contour_to_z < 0) {
        contour_split = 1;
        contour_ze = contour_zs - contour_from_z;
        contour_xe = contour_xs - contour_from_x;
        root_of = contour_square;
        radius = root_find();
        /* Rounded, a top may come out a step too low. */
        contour_xe += contour_arc == SEGMENT_ARC_CW ? radius + 1 : -radius;
    }
}

uint8_t contour_size(void)
{
    return contour_arc == SEGMENT_LINE ? LINE_SIZE : ARC_SIZE;
}

uint8_t contour_next(void)
{
    if (contour_split) {
        contour_from_x += contour_xe - contour_xs;
    }
    contour_zs = contour_ze;
    contour_xs = contour_xe;
    if (contour_split) {
        contour_split = 0;
        contour_from_z = 0;
        contour_ze += contour_to_z;
        contour_xe += contour_to_x - contour_from_x;
        return 1;
    }
    if (end == 0) {
        contour_arc = SEGMENT_LINE;
        contour_ze = contour_to_z;
        return contour_zs != contour_ze;
    }
    if (contour_at == end) {
        return 0;
    }
    parts_seek(contour_at);
    contour_arc = flash_read();
    contour_dx = flash_read_u16();
    contour_dz = flash_read_u16();
    contour_xe += contour_dx;
    contour_ze += contour_dz;
    if (contour_arc != SEGMENT_LINE) {
        read_arc();
    }
    contour_at += contour_size();
    return 1;
}

void contour_read_centre(void)
{
    parts_seek(contour_at - 6);
    path_next.cx = flash_read_i24();
    path_next.cz = flash_read_i24();
}

/* Where the piece passes level v, which lies between its ends. */
static int16_t cross(int16_t v)
{
    uint32_t along;
    int16_t z;
    uint8_t falls = contour_xs > contour_xe;

    if (contour_arc == SEGMENT_LINE) {
        divisor = size(contour_xe - contour_xs);
        factor_1 = (uint16_t)(contour_zs - contour_ze);
        factor_2 = size(v - (falls ? contour_xe : contour_xs));
        z = (int16_t)proportion(); /* rounded towards the side below v */
        return falls ? contour_ze + z : contour_zs - z;
    }
    along = contour_squared(v - 1 - contour_xs + contour_from_x);
    along = along > contour_square ? 0 : contour_square - along;
    root_of = along;
    z = root_find();
    if (contour_from_z <= 0) {
        z = -z;
    }
    z += contour_zs - contour_from_z;
    z += falls ? -2 : 2;
    if (z > contour_zs) {
        return contour_zs;
    }
    return z < contour_ze ? contour_ze : z;
}

/* Of the record at part_record. */
static uint8_t stretch(int16_t v, int16_t z)
{
    uint8_t inside;
    uint8_t more;
    uint8_t now;

    contour_open();
    inside = contour_xe <= v;
    contour_s = contour_ze;
    if (part_type == OPERATION_CONTOUR && (part_kind & CONTOUR_FACING)) {
        contour_s = EVERYWHERE;
    }
    do {
        more = contour_next();
        now = more && contour_xe <= v;
        if (inside && !now) {
            contour_e = more ? cross(v) : contour_ze;
            if (contour_e < z && contour_e < contour_s) {
                contour_contains = contour_s >= z;
                if (contour_contains) {
                    contour_s = z;
                }
                return 1;
            }
        } else if (!inside && now) {
            contour_s = cross(v);
        }
        inside = now;
    } while (more);
    return 0;
}

uint8_t contour_stretch(int16_t v, int16_t z)
{
    part_record = contour_own;
    part_read_record();
    return stretch(v, z);
}

int16_t contour_material(int16_t v, int16_t z)
{
    uint8_t changed;

    if (v >= part_stock_radius) {
        return NOWHERE;
    }
    if (z > part_stock_front) {
        z = part_stock_front;
    }
    do {
        __asm__("clrwdt"); /* every round shortens what is left */
        changed = 0;
        part_first();
        while (part_record != contour_own) {
            if (part_type == OPERATION_TOOL) {
                parts_seek(part_record + OPERATION_TOOL_WIDTH_AT);
                width = flash_read_u16();
            } else if (part_type >= OPERATION_CONTOUR && stretch(v, z) &&
                       contour_contains) {
                z = contour_e;
                changed = 1;
            }
            part_next();
        }
    } while (changed);
    return z;
}
