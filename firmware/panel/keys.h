/*
 * Keys of the panel: debounced, repeated while held.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Main loop only.
 */
#ifndef KEYS_H
#define KEYS_H

#include <stdint.h>

/* The key that is down, KEY_... */
extern uint8_t keys_down;

/* Every 4 ms: the key that has just gone down, or is held and comes again;
   else KEY_NONE. */
uint8_t keys_poll(void);

#endif
