/*
 * Path: the queue of segments ahead of the tool, planned as a whole, and
 * turned into step-stream entries.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * A chain is a sequence of segments without a stop of the stream: lines,
 * arcs, waits, outputs, signals. Its owner offers them one by one through
 * path_source(), which path_poll() calls as long as the queue has room; the
 * last SEGMENTS - 2 of them are looked ahead over.
 *
 * Two positions per axis: segments are given and counted for the tool; the
 * screw turns the dead steps on top whenever an axis changes direction.
 * Where the path leaves that axis at rest anyway (the flat top of an arc)
 * they are taken up in the same entries, and else in entries of their own,
 * during which the tool stands still.
 *
 * Main loop only. Positions: machine steps, 16 bits. Rates: 1/256 step/s
 * along the path.
 */
#ifndef PATH_H
#define PATH_H

#include <stdint.h>

#define SEGMENTS 16u

/* Kinds of segment. */
#define SEGMENT_LINE 0
#define SEGMENT_ARC_CW 1   /* from +Z towards +X */
#define SEGMENT_ARC_CCW 2  /* from +X towards +Z */
#define SEGMENT_WAIT 3     /* dx: milliseconds, 1..255 */
#define SEGMENT_OUTPUT 4   /* dx: relays, bit 6 spindle, bit 7 coolant */
#define SEGMENT_SIGNAL 5   /* dx: number for stream_signal */
#define SEGMENT_RAPID 0x80 /* with the above: the override does not apply */
#define SEGMENT_REST 0x40  /* planned: the motors come to rest before it */
#define SEGMENT_KIND 0x07

struct segment {
    int16_t dx; /* end, from the start */
    int16_t dz;
    int32_t cx; /* centre, from the start, 1/256 step */
    int32_t cz;
    uint8_t kind;
    uint8_t mark;    /* any number; shown by path_mark while it is executed */
    uint16_t count;  /* entries, for an arc at least so many */
    uint16_t end;    /* stream_count at its end */
    uint16_t entry;  /* braking distance it may be entered with, 1/2 step */
    uint16_t corner; /* the same from the geometry alone */
};

extern struct segment __at(0x500) segments[SEGMENTS];
extern uint32_t segment_speed[SEGMENTS]; /* wanted, 1/256 step/s */

/* First free place, and the segment being turned into entries. */
extern volatile uint8_t path_head;
extern volatile uint8_t path_made;

/* The segment that path_source() describes, from dx to mark; planned in this
   place before it goes into the queue. */
extern struct segment path_next;
extern uint32_t path_rate;

/* Set path_rate from 1/FEED_UNIT step/s, and from whole ones. */
void path_set_feed(uint16_t feed);
void path_set_rapid(uint16_t rate);

/* The segment being turned into entries; path_try() puts path_next there
   while nothing moves, to ask arc.h about it. */
extern struct segment path_present;
void path_try(void);

/* Mark of the segment being executed. */
extern volatile uint8_t path_mark;

extern uint16_t motion_dead_x;
extern uint16_t motion_dead_z;

/* Takes the settings into use. */
void path_configure(void);

/* Written by the owner of the motion (lathe/machine.c): fills path_next,
   and path_rate and returns 1, or 0 when the chain is complete. */
uint8_t path_source(void);

/* The source has described an arc that does not exist: nothing of it has
   been made, and nothing more will be. */
extern uint8_t path_refused;

/* The chain: path_source() has no more; the end has been pushed; the interrupt
   has been set going (2: it finds a wait behind the last step); path_made has
   been begun. Of path.c and set_up.c alone. */
extern uint8_t path_complete;
extern uint8_t path_ended;
extern uint8_t path_started;
extern uint8_t path_begun;

/* Starts a chain at the present tool position. */
void path_begin(void);

/* Plans and generates as far as there is room; every main loop turn. */
void path_poll(void);

/* The same without planning, for the main loop's other work: called every
   millisecond it lets the fastest motion go on. */
void path_keep_up(void);

/* Generates alone, for a path_source() that computes for long: called every
   50 ms or oftener it lets the tool stand where the queue ends, and the stream
   not run dry. */
void path_bridge(void);

/* True from path_begin() until the last step has been made. */
uint8_t path_busy(void);

/* Ends the chain at once; the tool position stays exact. */
void path_cancel(void);

/* The tool stands at the switch's release point, the screw last turned in
   the negative direction. */
void path_set_home(uint8_t axis);

#endif
