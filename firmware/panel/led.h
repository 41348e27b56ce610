/*
 * Status LED.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 *   2 s on after reset             alive
 *   slow blinking, 0.5 s / 0.5 s   idle, not homed
 *   on                             idle, homed
 *   mostly on, short gaps          moving: homing or running
 *   fast blinking, 0.1 s / 0.1 s   hold
 *   n flashes, pause of 1.5 s      alarm number n (docs/alarms.md)
 */
#ifndef LED_H
#define LED_H

/* Updates the LED; main loop, every turn. */
void led_poll(void);

#endif
