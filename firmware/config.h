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

/* Instruction clock: 48 MHz / 4. The step times, the 1 ms tick and USB all
   hang on it; the configuration words in config.asm belong to it. */
#define CYCLES_PER_SECOND 12000000ul

/* period in cycles = RATE_TO_PERIOD / (rate in 1/256 step/s) */
#define RATE_TO_PERIOD (CYCLES_PER_SECOND * 256ul)

/* Rest between two moves that differ in axis or direction, ms. Range 1..80.
   Long enough for a rotor of this size to stop swinging after one step. */
#define SETTLE_MS 10
#define SETTLE_PERIOD (CYCLES_PER_SECOND / 1000ul * SETTLE_MS)
#if SETTLE_MS < 1 || SETTLE_MS > 80
#error "SETTLE_MS must be 1 to 80 ms"
#endif

/* Where homing leaves the axes, steps from the switch. Range 1..200: enough
   that interference or heat does not close the switch again. */
#define PARK_STEPS 20
#if PARK_STEPS < 1 || PARK_STEPS > 200
#error "PARK_STEPS must be 1 to 200"
#endif

/* Fast approach gives up after the travel and this many steps more. */
#define HOMING_MARGIN_STEPS 400

#endif
