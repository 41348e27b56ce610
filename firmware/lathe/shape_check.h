/*
 * Checks the shapes of a part: places inside stock and travel, arcs that
 * exist, slopes that the edges of the tool can follow, a way in.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Called by lathe/part_check.c for one record after the other, with
 * contour_own at the present one and everything before it found good. All
 * return 0 or REFUSAL_... Main loop only.
 */
#ifndef SHAPE_CHECK_H
#define SHAPE_CHECK_H

#include <stdint.h>

/* The offsets of the tool in use, or of none: it must clear the stock inside
   the travel. Call it before the others. */
uint8_t shape_check_tool(void);

/* The record just read, of known size. */
uint8_t shape_check_contour(void);
uint8_t shape_check_plunge(void);

#endif
