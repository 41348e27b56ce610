/* Debouncing and repeating of the panel's keys.
   SPDX-License-Identifier: Apache-2.0 */

#include "panel/keys.h"
#include "panel/ladder.h" /* reading */

/* In calls of 4 ms. On the way from one voltage to another the ladder shows
   keys that nobody presses, so it must stand still longer than contacts
   bounce and the input's 0.1 ms take. */
#define STEADY 5         /* 20 ms */
#define REPEAT_FIRST 125 /* 0.5 s */
#define REPEAT_NEXT 25   /* 0.1 s */

uint8_t keys_down;

static uint8_t seen;
static uint8_t steady;
static uint8_t held;

uint8_t keys_poll(void)
{
    uint8_t now = ladder_read();

    if (now != seen) {
        seen = now;
        steady = 0;
    }
    if (steady != STEADY) {
        steady++;
    } else if (now != keys_down) {
        keys_down = now;
        held = 0;
        return now;
    } else if (now != KEY_NONE) {
        held++;
        if (held == REPEAT_FIRST) {
            held = REPEAT_FIRST - REPEAT_NEXT;
            return now;
        }
    }
    return KEY_NONE;
}
