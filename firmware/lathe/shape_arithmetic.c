/* Slopes and arcs of shape_check.c: what needs 32 bits.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/shape_arithmetic.h"
#include "arithmetic.h"    /* products */
#include "lathe/contour.h" /* the piece */
#include "link/protocol.h" /* largest radius */
#include "motion/arc.h"    /* arcs that the motion takes */
#include "motion/path.h"   /* kinds of segment */
#include "store/flash.h"   /* reading numbers */
#include "store/parts.h"   /* where the image is */

uint8_t shape_steeper(uint16_t dx, uint16_t slope, uint16_t dz)
{
    factor_1 = slope;
    factor_2 = dz;
    return ((uint32_t)dx << 8) > product();
}

static uint16_t root(uint32_t square)
{
    root_of = square;
    return root_find();
}

/* The first lines see to it that the motion's own check cannot overflow. */
uint8_t shape_arc_valid(void)
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
