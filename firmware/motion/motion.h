/*
 * Straight moves of one axis at constant speed, turned into step-stream
 * entries, with the dead steps taken up at every reversal.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * A chain is a sequence of moves without a stop of the stream. Its owner
 * offers the moves one by one through motion_source(), which motion_poll()
 * calls whenever the previous move has been generated: some 100 ms before
 * the tool gets there.
 *
 * Two positions per axis: moves are given and counted for the tool; the
 * screw turns the dead steps on top whenever an axis changes direction,
 * while the tool stands still. Between moves that differ in axis or
 * direction the chain waits SETTLE_MS (config.h): a motor at its full
 * start/stop rate must come to rest before it turns back.
 *
 * Main loop only. Positions are machine steps in 16 bits: 32,767 full steps
 * are 233 mm on the OTMT-CO, whose travel is 16,072; 32-bit positions cost
 * 8 KB of flash. Rates: 1/256 step/s.
 */
#ifndef MOTION_H
#define MOTION_H

#include <stdint.h>

/* The move that motion_source() describes. */
extern uint8_t move_axis;  /* AXIS_X or AXIS_Z */
extern int16_t move_to;    /* target, machine steps */
extern uint32_t move_rate; /* 1/256 step/s */
extern uint8_t move_mark;  /* shown by stream_mark while it is executed */

/* Dead steps of each axis that moves take up, from the settings. */
extern uint16_t motion_dead_x;
extern uint16_t motion_dead_z;

/* Written by the owner of the motion (lathe/machine.c): fills move_* and
   returns 1, or returns 0 when the chain is complete. */
uint8_t motion_source(void);

/* Starts a chain at the present tool position. */
void motion_begin(void);

/* Generates entries as far as there is room; call in every main loop turn. */
void motion_poll(void);

/* Tool steps made since motion_begin(), for the progress. Take-up does not
   count; up to 127 entries of it in the stream make the figure so much too
   small for a moment. */
uint32_t motion_made(void);

/* True from motion_begin() until the last step has been made. */
uint8_t motion_busy(void);

/* Ends the chain at once; the tool position stays exact. */
void motion_cancel(void);

/* Tells that the tool stands at the given place with the screw last turned
   away from the switch (negative): the result of homing. */
void motion_set_home(uint8_t axis);

#endif
