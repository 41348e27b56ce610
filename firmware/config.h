/*
 * Numbers of the firmware that are chosen, not measured: each with unit,
 * range and reason. A value out of range does not compile.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * What a user may change at the machine is a setting (link/protocol.toml).
 */
#ifndef CONFIG_H
#define CONFIG_H

/* Rest before an axis turns back, ms. Range 1..80. Long enough for a rotor of
   this size to stop swinging after a step at its start/stop speed. */
#define REST_MS 10
#if REST_MS < 1 || REST_MS > 80
#error "REST_MS must be 1 to 80 ms"
#endif

/* Where homing leaves the axes, steps from the switch. Range 1..200: enough
   that interference or heat does not close the switch again. */
#define PARK_STEPS 20
#if PARK_STEPS < 1 || PARK_STEPS > 200
#error "PARK_STEPS must be 1 to 200"
#endif

/* Shortest step pulse, us: what the step interrupt takes anyway. */
#define PULSE_LEAST_US 5

/* Fast approach gives up after the travel and this many steps more. */
#define HOMING_MARGIN_STEPS 400

#endif
