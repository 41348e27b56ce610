/*
 * Moving by the keys: jog, touch, go to zero, and part zero.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * LEFT and RIGHT move Z, towards the chuck and away from it; X IN and DOWN
 * move X towards the spindle's axis, X OUT and UP away from it. A step is made
 * for each press, and again while the key is held; with the size CONTINUOUS
 * the slide moves until the key is let go.
 *
 * Main loop only. Functions that return a number return ERROR_OK or the
 * ERROR_... that says why not.
 */
#ifndef BY_HAND_H
#define BY_HAND_H

#include <stdint.h>

/* How a key moves a slide. The size is 0, 1, 2 for 0.01, 0.1, 1 mm or 0.001,
   0.01, 0.1 inch, then CONTINUOUS; the speed the number of a rate. */
#define CHOICE_SIZE 0
#define CHOICE_SPEED 1
#define CHOICES 4 /* of each */
#define CONTINUOUS 3
extern uint8_t by_hand_choice[2];

/* The rate in step/s, 0 rapid; the size in thousandths of the unit, 0
   continuous. */
uint16_t by_hand_rate(void);
uint16_t by_hand_distance(void);

/* The diameter that X gets, in thousandths of the unit. */
extern uint16_t by_hand_diameter;

uint8_t by_hand_jog(uint8_t key);
uint8_t by_hand_zero(uint8_t axis);
uint8_t by_hand_touch(uint8_t axis);
uint8_t by_hand_go_zero(void);

/* Every 4 ms. Ends a continuous jog, and sets part zero after a touch: returns
   the text (TEXT_...) that tells how it ended, 0 when nothing did. */
uint8_t by_hand_poll(void);

#endif
