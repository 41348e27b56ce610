/*
 * Cuts: the passes of one operation, one after the other.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * cuts_begin() measures what has to be cut, cuts_next() works out the next
 * pass; lathe/passes.c makes the moves. Levels, pockets and what is left out
 * are told in lathe/passes.h.
 *
 * Pockets need no list: a stretch of a level lies inside one of the level
 * above. From a pass the next one is the first stretch inside it, a level
 * deeper. Where there is none its pocket is at its bottom, and the search
 * goes up: the next one is the first stretch behind it that lies inside a
 * stretch already begun.
 *
 * Main loop only; coordinates of the part, steps. A pass is worked out in 1
 * to 10 ms for a contour of 20 pieces.
 */
#ifndef CUTS_H
#define CUTS_H

#include <stdint.h>

enum cut {
    CUT_ALONG,  /* from cuts_z to cuts_end at cuts_x */
    CUT_FACING, /* to cuts_end at cuts_z */
    CUT_PLUNGE, /* the same, in pecks */
    CUT_FOLLOW  /* the contour, with its start at cuts_x */
};

extern uint8_t cuts_kind;
extern int16_t cuts_rise;   /* x where nothing is in the way to cuts_z */
extern int16_t cuts_height; /* x where nothing is in the way there */
extern int16_t cuts_z;      /* where the tool goes in */
extern int16_t cuts_x;
extern int16_t cuts_end;
extern uint8_t cuts_open;   /* nothing is in the way in at cuts_z */
extern uint8_t cuts_finish; /* at the finish feed */
extern int16_t cuts_start;  /* z of the contour's start */

extern uint16_t cuts_pass; /* level or contour pass, from 1 */
extern uint16_t cuts_passes;

/* Takes the record just read, a CONTOUR or PLUNGE, with contour_own at it.
   Returns 0 when nothing of it is left to cut. */
uint8_t cuts_begin(void);

/* Works out the next pass; 0 = the operation is complete. */
uint8_t cuts_next(void);

#endif
