/*
 * Plan: how fast each queued segment may be cut and entered.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Speed: the programmed one, but no axis faster than its maximum. Corner:
 * the direction changes by (du_x, du_z) from one segment to the next, so at
 * path speed v the axes jump by v du; no axis may jump by more than its
 * start/stop speed. Where one turns back the tool rests for REST_MS. A tangent
 * joint (du below 1/64) does not slow down.
 * Entry: the corner's limit, or what the way left behind it allows to brake
 * from; worked out backwards from the end of the queue, where the tool must
 * be able to stop.
 *
 * Main loop only.
 */
#ifndef PLAN_H
#define PLAN_H

#include <stdint.h>

/* The axes' limits, step/s: start/stop speeds, highest speeds. */
extern uint16_t plan_start_x;
extern uint16_t plan_start_z;
extern uint16_t plan_maximum_x;
extern uint16_t plan_maximum_z;

/* Forgets the direction of the segment before: the tool stands. */
void plan_begin(void);

/* Plans path_next: its corner, and path_rate within the axes' limits. */
void plan_next(void);

/* Plans the queue back from the segment just put at an index, its last. */
void plan_back(uint8_t index);

#endif
