/*
 * Step stream: the queue between the main loop, which plans, and the step
 * interrupt, which only executes. One entry is one step of either or both
 * motors, or a wait.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * The main loop pushes entries ahead of time; the interrupt (see
 * step_interrupt.asm) takes one, writes the coils, counts. A chain of moves
 * ends with an entry STREAM_END; running out of entries without it sets
 * STREAM_DRY, which the machine turns into an alarm.
 *
 * Who may call: the main loop only. The functions marked "any" may also be
 * called from the low-priority interrupt.
 *
 * Units: steps; periods in instruction cycles of 1/12 us.
 */
#ifndef STREAM_H
#define STREAM_H

#include <stdint.h>

/* Flags of an entry. */
#define STREAM_STEP_X 0x01
#define STREAM_X_NEGATIVE 0x02
#define STREAM_STEP_Z 0x04
#define STREAM_Z_NEGATIVE 0x08
#define STREAM_SLACK_X 0x10 /* turns the screw, the tool stands still */
#define STREAM_SLACK_Z 0x20
#define STREAM_ADVANCES 0x40 /* counts in stream_count */

/* Orders: entries without a step. Their stretch is a number. */
#define STREAM_END 0x80    /* the chain is complete */
#define STREAM_WAIT 0x81   /* milliseconds before the entry after */
#define STREAM_OUTPUT 0x82 /* relays: bit 6 spindle, bit 7 coolant */
#define STREAM_SIGNAL 0x83 /* goes to stream_signal */

/* Bits of stream_flags. */
#define STREAM_ACTIVE 0x01
#define STREAM_WAITING 0x02
#define STREAM_DRY 0x04
#define STREAM_STOOD 0x08 /* before the entry to come; for the ramp */

#define STREAM_ENTRIES 127u /* one of 128 stays free */

/* Shared with the step interrupt. The positions are the tool's, in machine
   steps; the slack is screw minus tool, 0 after a positive move and minus
   the dead steps after a negative one. Read them with stream_position(). */
extern volatile uint8_t stream_head;
extern volatile uint8_t stream_tail;
extern volatile uint8_t stream_flags;
extern volatile uint8_t stream_signal;
extern volatile uint8_t stream_pulse;  /* step pulse beyond 5 us, 1/4 us */
extern volatile uint16_t stream_count; /* entries that advanced the path */
extern volatile int16_t position_x;
extern volatile int16_t position_z;
extern volatile int16_t slack_x;
extern volatile int16_t slack_z;

/* Fewest entries left in the ring while moving, since the last start. */
extern uint8_t stream_low;

/* Sets up Timer 1 and CCP2; call once after reset. */
void stream_init(void);

/* Chooses the outputs: mode 0 two phases on, 1 wave, 2 half step, 3 step,
   direction and enable on the first three pins of each axis; an
   inverted axis turns the other way. Only while not active; the rotors may
   jump by up to two steps when the windings are next switched on. */
void stream_set_coils(uint8_t mode, uint8_t invert_x, uint8_t invert_z);

/* Energises the windings at the present phase. */
void stream_coils_on(void);

/* Takes current off all windings at once (any). */
void stream_coils_off(void);

/* Entries that can be pushed now, 0..STREAM_ENTRIES. */
uint8_t stream_room(void);

/* Entries waiting, 0..STREAM_ENTRIES (any). */
uint8_t stream_fill(void);

/* Pushes one entry; the caller has checked stream_room(). stretch is the
   path length of this step less one, in 1/256 (0 for a straight step). */
void stream_push(uint8_t flags, uint8_t stretch);

/* Empties the queue, sets stream_count to 0, energises the coils. */
void stream_prepare(void);

/* Starts executing, once stream_period has been set. The first entry follows
   1 ms later. */
void stream_start(void);

/* Goes on after the ramp has stopped it between two steps, 1 ms later. */
void stream_thaw(void);

/* Stops at once and forgets everything queued (any). */
void stream_abort(void);

/* Copies the tool position of an axis, AXIS_X or AXIS_Z, without stopping the
   interrupt. */
int16_t stream_position(uint8_t axis);

#endif
