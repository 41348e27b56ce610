/* Path: queue of segments, and their entries in the step stream.
   SPDX-License-Identifier: Apache-2.0 */

#include "motion/path.h"
#include "motion/entries.h" /* generation */
#include "motion/plan.h"    /* speeds, corners */
#include "motion/ramp.h"    /* speed */
#include "motion/stream.h"  /* entries */

/* Entries generated in one turn of the main loop: bounds the time away from
   the link, and still keeps ahead of 60,000 entries/s. */
#define BATCH 64

/* While the source computes for long the tool waits behind the last segment
   known, from so many entries left on. */
#define BRIDGE_FILL 32
#define BRIDGE_MS 50

/* More than a bank: placed by hand, see tornillo.lkr. */
struct segment __at(0x500) segments[SEGMENTS];
uint32_t segment_speed[SEGMENTS];
volatile uint8_t path_head;
volatile uint8_t path_made;
volatile uint8_t path_mark;
uint8_t path_refused;

struct segment path_next;
struct segment path_present;
uint32_t path_rate;

uint16_t motion_dead_x;
uint16_t motion_dead_z;

uint8_t path_complete;
uint8_t path_ended;
uint8_t path_started;
#define WAITS 2
uint8_t path_begun;

uint8_t path_busy(void)
{
    return !path_ended || (stream_flags & STREAM_ACTIVE);
}

void path_cancel(void)
{
    stream_abort();
    path_ended = 1;
}

static uint8_t after(uint8_t index)
{
    index++;
    return index == SEGMENTS ? 0 : index;
}

static uint16_t size(int16_t value)
{
    return value < 0 ? -value : value;
}

/* Entries of a line, and of an arc at least so many. */
static uint16_t larger_of(uint16_t one, uint16_t other)
{
    return one > other ? one : other;
}

/* Structures are copied byte by byte: the compiler's way takes three times
   the room. */
static __data const uint8_t *copy_from;
static __data uint8_t *copy_to;

static void copy_segment(void)
{
    uint8_t i;

    for (i = sizeof(struct segment); i != 0; i--) {
        *copy_to++ = *copy_from++;
    }
}

void path_try(void)
{
    copy_from = (__data const uint8_t *)&path_next;
    copy_to = (__data uint8_t *)&path_present;
    copy_segment();
}

/* Takes one more segment into the queue, if there is room. */
static uint8_t accept(void)
{
    uint8_t next = after(path_head);

    if (path_complete || next == ramp_segment) {
        return 0;
    }
    if (!path_source()) {
        path_complete = 1;
        if (path_head == path_made) { /* nothing at all */
            path_mark = path_next.mark;
            path_ended = 1;
        }
        return 0;
    }
    path_next.count = 0;
    if ((path_next.kind & SEGMENT_KIND) <= SEGMENT_ARC_CCW) {
        path_next.count = larger_of(size(path_next.dx), size(path_next.dz));
    }
    plan_next();
    copy_from = (__data const uint8_t *)&path_next;
    copy_to = (__data uint8_t *)&segments[path_head];
    copy_segment();
    segment_speed[path_head] = path_rate;
    plan_back(path_head);
    path_head = next;
    return 1;
}

/* Begins the segment at path_made, or goes on to the next; 0 when there is
   nothing to do now. */
static uint8_t next_segment(void)
{
    __data struct segment *segment = &segments[path_made];

    if (path_begun) {
        segment->end = entries_made;
        if (after(path_made) == path_head) {
            if (path_complete) {
                stream_push(STREAM_END, 0);
                path_ended = 1;
            }
            return 0;
        }
        segment = &segments[after(path_made)];
        segment->end = entries_made + segment->count;
        path_made = after(path_made); /* last: ramp_tick() follows it */
    } else if (path_made == path_head) {
        return 0;
    } else {
        segment->end = entries_made + segment->count;
    }
    path_begun = 1;
    if (path_started) {
        path_started = 1;
    }
    copy_from = (__data const uint8_t *)segment;
    copy_to = (__data uint8_t *)&path_present;
    copy_segment();
    entries_segment();
    return 1;
}

/* Returns 1 when the segments that are there have all been generated. */
static uint8_t make(void)
{
    uint8_t bare = 0;
    uint8_t budget = BATCH;
    uint8_t room;
    uint8_t done;

    if (path_ended) {
        return 0;
    }
    if (!path_started && !path_complete && after(path_head) != ramp_segment) {
        return 0; /* look ahead as far as possible before the first step */
    }
    while (budget != 0 && !path_ended && !path_refused) {
        room = stream_room();
        if (room < 4) {
            break;
        }
        room -= 2;
        done = entries_make(room < budget ? room : budget);
        if (done == ENTRIES_COMPLETE) {
            done = next_segment();
            bare = done == 0;
        }
        if (done == 0) {
            break;
        }
        budget -= done;
    }
    if (path_refused || (!path_started && ramp_holding())) {
        return 0;
    }
    if (!path_started &&
        (path_ended || bare || stream_fill() >= STREAM_ENTRIES / 2)) {
        path_started = 1;
        ramp_begin(0);
        stream_start();
    } else if (path_started && !path_ended && stream_fill() < stream_low) {
        stream_low = stream_fill();
    }
    return bare;
}

/* The last step before the queue's end is slow enough to stop behind it, so
   the tool may stand there. */
void path_bridge(void)
{
    if (make() && path_started && !path_ended &&
        stream_fill() < (path_started == WAITS ? 1 : BRIDGE_FILL)) {
        stream_push(STREAM_WAIT, BRIDGE_MS);
        plan_begin();
        path_started = WAITS;
    }
}

void path_keep_up(void)
{
    if (!path_ended) {
        make();
    }
}

void path_poll(void)
{
    if (!path_ended) {
        accept();
        make();
    }
}
