/* Stroke: one move of homing, jog, goto or touch.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/stroke.h"
#include "config.h"        /* filter */
#include "link/protocol.h" /* axes */
#include "motion/path.h"   /* segments */

int16_t stroke_dx;
int16_t stroke_dz;
uint16_t stroke_rate;

static uint8_t offered;

void stroke_begin(void)
{
    offered = 0;
    path_begin();
}

void stroke_along(uint8_t axis, int16_t distance)
{
    stroke_dx = 0;
    stroke_dz = 0;
    if (axis == AXIS_X) {
        stroke_dx = distance;
    } else {
        stroke_dz = distance;
    }
    stroke_begin();
}

uint8_t stroke_source(void)
{
    path_next.kind = SEGMENT_LINE | SEGMENT_RAPID;
    path_next.dx = 0;
    path_next.dz = 0;
    path_next.mark = 0;
    path_set_rapid(stroke_rate);
    if (offered >= 2) {
        path_next.kind = SEGMENT_WAIT;
        path_next.dx = FILTER_MS;
    } else if (offered == (stroke_dx <= 0)) {
        path_next.dx = stroke_dx;
    } else {
        path_next.dz = stroke_dz;
    }
    offered++;
    return offered <= 3;
}
