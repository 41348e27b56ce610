/* Entries: one segment at a time into the step stream.
   SPDX-License-Identifier: Apache-2.0 */

#include "motion/entries.h"
#include "config.h"             /* rest */
#include "motion/arc.h"         /* octants */
#include "motion/interpolate.h" /* runs */
#include "motion/path.h"        /* the segment */
#include "motion/stream.h"      /* entries */

/* Last entries of an octant in which the flat top of an arc is looked for. */
#define FLAT 48

/* Stretch of a diagonal step, sqrt(2). */
#define DIAGONAL 106

#define RUN_NONE 0
#define RUN_LINE 1
#define RUN_ARC 2

uint16_t entries_made;

/* Screw less tool at the end of what has been generated. */
int16_t entries_planned_slack_x;
int16_t entries_planned_slack_z;

/* The run. */
uint8_t entries_run_kind;
uint16_t entries_run_left;

/* Dead steps to be taken up before the next step of an axis. */
uint16_t entries_due_x;
uint16_t entries_due_z;
static uint8_t due_flags_x;
static uint8_t due_flags_z;

/* An entry that waits until they have been. */
uint8_t entries_waiting;
static uint8_t waiting_flags;
static uint8_t waiting_stretch;

extern volatile uint8_t step_ring[256];

static uint16_t size(int16_t value)
{
    return value < 0 ? -value : value;
}

/*
 * Dead steps that an axis needs before it moves in a direction; the slack is
 * 0 when the screw pushes the tool in + direction and -dead when in -. A
 * chain that was broken off in between continues from where it stood.
 */
static uint16_t dead_steps(int16_t slack, uint16_t dead, uint8_t negative)
{
    int16_t due = negative ? slack + (int16_t)dead : -slack;

    return due > 0 ? (uint16_t)due : 0;
}

static void turn_x(uint8_t negative)
{
    entries_due_x =
        dead_steps(entries_planned_slack_x, motion_dead_x, negative);
    due_flags_x = STREAM_STEP_X | STREAM_SLACK_X;
    if (negative) {
        due_flags_x |= STREAM_X_NEGATIVE;
    }
}

static void turn_z(uint8_t negative)
{
    entries_due_z =
        dead_steps(entries_planned_slack_z, motion_dead_z, negative);
    due_flags_z = STREAM_STEP_Z | STREAM_SLACK_Z;
    if (negative) {
        due_flags_z |= STREAM_Z_NEGATIVE;
    }
}

static void turn(uint8_t flags)
{
    if (flags & STREAM_STEP_X) {
        turn_x(flags & STREAM_X_NEGATIVE);
    }
    if (flags & STREAM_STEP_Z) {
        turn_z(flags & STREAM_Z_NEGATIVE);
    }
}

static void begin_line(void)
{
    uint16_t x = size(path_present.dx);
    uint16_t z = size(path_present.dz);
    uint8_t flags_x = STREAM_STEP_X;
    uint8_t flags_z = STREAM_STEP_Z;
    uint16_t slope;

    if (path_present.dx < 0) {
        flags_x |= STREAM_X_NEGATIVE;
    }
    if (path_present.dz < 0) {
        flags_z |= STREAM_Z_NEGATIVE;
    }
    run_straight = STREAM_ADVANCES;
    run_diagonal = STREAM_ADVANCES | flags_x | flags_z;
    if (x > z) {
        run_straight |= flags_x;
        run_major = x;
        run_minor = z;
    } else {
        run_straight |= flags_z;
        run_major = z;
        run_minor = x;
    }
    entries_run_left = run_major;
    if (entries_run_left == 0) {
        return;
    }
    run_error = run_major >> 1;
    slope = (uint16_t)((((uint32_t)run_minor << 8) + run_error) / run_major);
    run_stretch = slope > 255 ? DIAGONAL : interpolate_stretch((uint8_t)slope);
    entries_run_kind = RUN_LINE;
    turn(run_minor != 0 ? run_diagonal : run_straight);
}

static void next_octant(void)
{
    uint8_t rest;

    entries_run_left = arc_next();
    if (entries_run_left == 0) {
        rest = arc_rest_flags();
        if (rest != 0) {
            turn(rest);
            entries_waiting = 1;
            waiting_flags = rest | STREAM_ADVANCES;
            waiting_stretch = step_ring[(uint8_t)(stream_head - 1)];
        }
        entries_run_kind = RUN_NONE;
        return;
    }
    run_straight = STREAM_ADVANCES | arc_major_flags;
    run_diagonal = run_straight | arc_minor_flags;
    turn(run_diagonal);
    segments[path_made].end = entries_made + arc_left();
}

/* The kinds of order follow each other like the orders of the stream. */
void entries_segment(void)
{
    uint8_t kind = path_present.kind & SEGMENT_KIND;

    if (path_present.kind & SEGMENT_REST) {
        stream_push(STREAM_WAIT, REST_MS);
    }
    if (kind == SEGMENT_LINE) {
        begin_line();
    } else if (kind <= SEGMENT_ARC_CCW) {
        if (!arc_begin()) {
            path_refused = 1;
            return;
        }
        entries_run_kind = RUN_ARC;
        next_octant();
    } else {
        stream_push(STREAM_WAIT - SEGMENT_WAIT + kind,
                    (uint8_t)path_present.dx);
    }
}

static void interpolate(uint8_t batch)
{
    run_batch = batch;
    run_head = stream_head;
    if (entries_run_kind == RUN_LINE) {
        interpolate_line();
    } else {
        interpolate_arc();
    }
    entries_run_left -= batch;
}

static void publish(uint8_t batch)
{
    stream_head = run_head;
    entries_made += batch;
}

/* Adds due dead steps of the axes that an entry leaves at rest. */
static uint8_t with_dead_steps(uint8_t flags)
{
    if (entries_due_x != 0 && !(flags & STREAM_STEP_X)) {
        flags |= due_flags_x;
        entries_due_x--;
        entries_planned_slack_x += flags & STREAM_X_NEGATIVE ? -1 : 1;
    }
    if (entries_due_z != 0 && !(flags & STREAM_STEP_Z)) {
        flags |= due_flags_z;
        entries_due_z--;
        entries_planned_slack_z += flags & STREAM_Z_NEGATIVE ? -1 : 1;
    }
    return flags;
}

/* One entry while dead steps are due. */
static void careful_entry(void)
{
    uint8_t at = stream_head;
    uint8_t flags;

    if (entries_waiting) {
        if (entries_due_x != 0 || entries_due_z != 0) {
            stream_push(with_dead_steps(0), 0);
            return;
        }
        entries_waiting = 0;
        stream_push(waiting_flags, waiting_stretch);
        if (waiting_flags & STREAM_ADVANCES) {
            entries_made++;
        }
        return;
    }
    interpolate(1);
    flags = step_ring[at];
    if ((entries_due_x != 0 && (flags & STREAM_STEP_X)) ||
        (entries_due_z != 0 && (flags & STREAM_STEP_Z))) {
        entries_waiting = 1;
        waiting_flags = flags;
        waiting_stretch = step_ring[at + 1];
        return;
    }
    step_ring[at] = with_dead_steps(flags);
    publish(1);
}

/*
 * The end of an octant behind which the minor axis turns back: takes up dead
 * steps in the entries after that axis' last step.
 */
static void flat_top(void)
{
    uint8_t batch = (uint8_t)entries_run_left;
    uint8_t step = arc_minor_flags & (STREAM_STEP_X | STREAM_STEP_Z);
    uint8_t at;

    interpolate(batch);
    at = run_head;
    while (batch != 0 && !(step_ring[(uint8_t)(at - 2)] & step)) {
        at -= 2;
        batch--;
    }
    if (step == STREAM_STEP_X) {
        turn_x(!(arc_minor_flags & STREAM_X_NEGATIVE));
    } else {
        turn_z(!(arc_minor_flags & STREAM_Z_NEGATIVE));
    }
    while (at != run_head) {
        step_ring[at] = with_dead_steps(step_ring[at]);
        at += 2;
    }
}

/* Generates what is left of the run, as far as room goes; returns entries. */
static uint8_t generate(uint8_t room)
{
    uint8_t batch = room;

    if (entries_run_left < batch) {
        batch = (uint8_t)entries_run_left;
    }
    if (entries_run_kind == RUN_ARC && arc_turns) {
        if (entries_run_left <= FLAT) {
            if (room < entries_run_left) {
                return 0;
            }
            flat_top();
            publish(batch);
            return batch;
        }
        if (entries_run_left - batch < FLAT) {
            batch = (uint8_t)(entries_run_left - FLAT);
        }
    }
    interpolate(batch);
    publish(batch);
    return batch;
}

uint8_t entries_make(uint8_t room)
{
    if (entries_waiting ||
        ((entries_due_x != 0 || entries_due_z != 0) && entries_run_left != 0)) {
        careful_entry();
    } else if (entries_run_left != 0) {
        return generate(room);
    } else if (entries_run_kind == RUN_ARC) {
        next_octant();
    } else {
        entries_run_kind = RUN_NONE;
        return ENTRIES_COMPLETE;
    }
    return 1;
}
