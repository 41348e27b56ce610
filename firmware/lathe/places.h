/*
 * Places of a part: what the tool does now, and from where on it goes on.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Places are numbered in the order of the part: the way to it is 1, then
 * comes every pass and pause; a change of tool takes two numbers, so that
 * the place before it is no pass. Behind 255 comes 0.
 *
 * Up to 16 segments, five passes, are described ahead of the tool. What it
 * does now is told by the mark of the segment: the number of its place.
 *
 * Main loop only.
 */
#ifndef PLACES_H
#define PLACES_H

#include <stdint.h>

/* Starts anew; what lies before the place `from` has been cut already. */
void places_begin(uint8_t from);

/* What is described next is another place: pass of an operation, pass 0 =
   none. */
void places_next(uint8_t operation, uint8_t pass);

/* The place to go on from, 0 when what is described has reached it. */
extern uint8_t places_to_go_on;

/* Mark for the segments described now; before the place to go on from, that
   one's. */
uint8_t places_mark(void);

/* What a mark near to the newest stands for. */
uint8_t places_operation(uint8_t mark);
uint8_t places_pass(uint8_t mark);

#endif
