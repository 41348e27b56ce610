/* Slopes and arcs of shape_check.c: what needs 32 bits.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/shape_arithmetic.h"
#include "arithmetic.h"    /* products */
#include "lathe/contour.h" /* the piece */
#include "motion/arc.h"    /* root */

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

uint16_t shape_radius(void)
{
    return root(contour_square);
}

uint16_t shape_end_radius(void)
{
    return root(contour_squared(contour_to_x) + contour_squared(contour_to_z));
}
