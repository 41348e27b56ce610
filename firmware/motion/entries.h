/*
 * Entries: turns one segment at a time into step-stream entries, with the
 * dead steps of the screws.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Dead steps come before the first step of an axis in a new direction, in
 * entries that leave the axis at rest on the path if there are any: behind
 * the turning point of an arc, and, where an octant ends in one, in its last
 * entries too. Only what does not fit there gets entries of its own, during
 * which the tool stands still.
 *
 * Used by path.c only; main loop.
 */
#ifndef ENTRIES_H
#define ENTRIES_H

#include <stdint.h>

/* Entries made since path_begin() that advance the path. */
extern uint16_t entries_made;

/* For path_begin() (set_up.c), which sets all to 0 and the slack to what the
   screws have now: the run, dead steps due, an entry that waits for them;
   screw less tool at the end of what has been generated. */
extern uint8_t entries_run_kind;
extern uint16_t entries_run_left;
extern uint16_t entries_due_x;
extern uint16_t entries_due_z;
extern uint8_t entries_waiting;
extern int16_t entries_planned_slack_x;
extern int16_t entries_planned_slack_z;

/* Takes path_present. */
void entries_segment(void);

/* Makes entries, at most room (4 or more). Returns how many, 0 when it has
   to wait for more room, ENTRIES_COMPLETE when the segment has no more. */
uint8_t entries_make(uint8_t room);
#define ENTRIES_COMPLETE 0xFF

#endif
