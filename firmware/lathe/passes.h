/*
 * Roughing and finishing passes of a stored part, computed as they are cut.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Face and cylinder are the same thing with the axes exchanged: an infeed
 * axis on which the levels lie, and a cut axis along which each pass runs.
 *
 *                infeed axis, cut axis    levels              a pass runs
 *   cylinder     X            Z           from the largest    from in front
 *                                         radius left to x    to z_end
 *   face         Z            X           from the front left from outside
 *                                         to z                to x_inner
 *
 * A pass: infeed to its level in front of the material (rapid), cut (feed),
 * back off by the retract (rapid), return (rapid). Reversals, and with them
 * the dead steps, lie in the returns, where the tool is clear.
 *
 * Levels are spread evenly, so no pass is deeper than the depth of cut and
 * none is a sliver; the last is exactly on size. A cylinder with a finish
 * allowance gets one more pass for it at the finish feed. Material that
 * earlier operations have removed is not cut again. At the end X, then Z go
 * back to park.
 *
 * Main loop only. The part must have passed part_check().
 */
#ifndef PASSES_H
#define PASSES_H

#include <stdint.h>

/* Prepares the part in a slot. */
void passes_begin(uint8_t slot);

/* Describes the next move in move_*; 0 when the tool is back at park. */
uint8_t passes_source(void);

/* What the tool is doing now, for the operator: operation 1..operations,
   pass 1..passes (0 = on the way). */
extern uint8_t passes_operations;
uint8_t passes_operation(void);
uint8_t passes_pass(void);
uint8_t passes_passes(void);

/* Tool steps of the whole run, an estimate for the progress. */
extern uint32_t passes_total_steps;

#endif
