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
#define STREAM_NEW_SPEED 0x40 /* the next queued speed holds from here on */
#define STREAM_END 0x80       /* no step; the chain of moves is complete */

/* Bits of stream_flags. */
#define STREAM_ACTIVE 0x01
#define STREAM_WAITING 0x02
#define STREAM_DRY 0x04

#define STREAM_ENTRIES 127u /* one of 128 stays free */
#define STREAM_SPEEDS 7u    /* one of 8 stays free */

/* Shortest period a chain may ask for: 60,000 steps/s. Below it the next
   compare time could pass before the interrupt has set it. */
#define STREAM_PERIOD_MIN 200ul
#define STREAM_PERIOD_MAX 0xB00000ul /* with stretch it fits 24 bits: 1 s */

/* Shared with the step interrupt. The positions are the tool's, in machine
   steps; the slack is screw minus tool, 0 after a positive move and minus
   the dead steps after a negative one. Read them with stream_position(). */
extern volatile uint8_t stream_head;
extern volatile uint8_t stream_tail;
extern volatile uint8_t stream_flags;
extern volatile uint8_t stream_mark;
extern volatile int16_t position_x;
extern volatile int16_t position_z;
extern volatile int16_t slack_x;
extern volatile int16_t slack_z;

/* Fewest entries left in the ring while moving, since the last start. */
extern uint8_t stream_low;

/* Sets up Timer 1 and CCP2; call once after reset. */
void stream_init(void);

/* Chooses the coil tables: mode 0 two phases on, 1 wave, 2 half step; an
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

/* Speeds that can be queued now, 0..STREAM_SPEEDS. */
uint8_t stream_speeds_free(void);

/* Queues the speed that the next entry with STREAM_NEW_SPEED switches to.
   period: cycles per step, STREAM_PERIOD_MIN..MAX; mark: any number, shows
   in stream_mark from that entry on. */
void stream_push_speed(uint32_t period, uint8_t mark);

/* Starts executing. The first entry follows 1 ms later. */
void stream_start(void);

/* Stops between two steps; nothing is lost (any). */
void stream_freeze(void);

/* Goes on after stream_freeze(), 1 ms later. */
void stream_thaw(void);

/* Stops at once and forgets everything queued (any). */
void stream_abort(void);

/* Copies a tool position without stopping the interrupt. */
int16_t stream_position_x(void);
int16_t stream_position_z(void);

#endif
