/*
 * Eight keys on one analogue input.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Key k pulls the input to k/8 of the supply, none leaves it at the supply.
 * Two at once read as the one with the lower number. Main loop only.
 */
#ifndef LADDER_H
#define LADDER_H

#include <stdint.h>

#define KEY_UP 0
#define KEY_DOWN 1
#define KEY_LEFT 2
#define KEY_RIGHT 3
#define KEY_OK 4
#define KEY_BACK 5
#define KEY_X_OUT 6
#define KEY_X_IN 7
#define KEY_NONE 8

/* The key that is down: the reading that the call before began. At least 50 us
   between two calls; the first tells nothing. */
uint8_t ladder_read(void);

#endif
