/*
 * Status LED.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 *   2 s on after reset             alive
 *   slow blinking, 0.5 s / 0.5 s   idle, not homed
 *   on                             idle, homed
 *   mostly on, short gaps          moving: homing or running
 *   fast blinking, 0.1 s / 0.1 s   hold, or a pause of the part
 *   n flashes, pause of 1.5 s      alarm number n (docs/alarms.md)
 *   n flashes once, in idle        part number n has been selected
 */
#ifndef LED_H
#define LED_H

#include <stdint.h>

/* Updates the LED; main loop, every turn. */
void led_poll(void);

/* Flashes a number once while the machine is idle; 0 does nothing. */
void led_show(uint8_t flashes);

/* The lamp itself. */
void led_on(void);
void led_off(void);

#endif
