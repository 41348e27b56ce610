/* Roughing and finishing passes of a stored part.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/passes.h"
#include "config.h"         /* PARK_STEPS */
#include "lathe/part.h"     /* the part */
#include "link/protocol.h"  /* axes, settings */
#include "motion/path.h"    /* segments */
#include "motion/stream.h"  /* where the tool is */
#include "store/settings.h" /* part zero, rapid rates */

enum stage {
    STAGE_NEXT_OPERATION,
    STAGE_CLEAR,    /* X out of the stock */
    STAGE_APPROACH, /* Z to where the operation starts */
    STAGE_INFEED,
    STAGE_CUT,
    STAGE_RETRACT,
    STAGE_RETURN,
    STAGE_PARK_X,
    STAGE_PARK_Z,
    STAGE_DONE
};

uint8_t passes_operations;
uint32_t passes_total_steps;

static uint8_t slot_cut; /* other readers of the store may have moved on */
static uint8_t stage;
static uint16_t record; /* offset of the present operation */
static uint8_t record_size;
static uint8_t operation; /* 1.. */
static uint16_t pass;     /* 1.. while cutting */
static uint16_t passes;

/* The present operation, part coordinates. */
static uint8_t infeed_axis;
static uint8_t cut_axis;
static int16_t level_from;
static int16_t level_depth; /* from there to the last roughing level */
static uint16_t allowance;  /* left for the finishing pass */
static uint16_t step_depth; /* of one roughing pass */
static uint16_t deeper;     /* passes that take one step more */
static int16_t cut_from;
static int16_t cut_to;

/*
 * Up to 18 segments, five passes, are described ahead of the tool. What it
 * does now is told by the mark of the segment: an index into this ring.
 */
#define SHOWN 8
static uint8_t shown_operation[SHOWN];
static uint8_t shown_pass[SHOWN];
static uint8_t shown_passes[SHOWN];
static uint8_t newest;

static uint8_t at_most_255(uint16_t value)
{
    return value > 255 ? 255 : (uint8_t)value;
}

static void show_pass(void)
{
    newest = (newest + 1) & (SHOWN - 1);
    shown_operation[newest] = operation;
    shown_pass[newest] = at_most_255(pass);
    shown_passes[newest] = at_most_255(passes);
}

uint8_t passes_operation(void)
{
    return shown_operation[path_mark];
}

uint8_t passes_pass(void)
{
    return shown_pass[path_mark];
}

uint8_t passes_passes(void)
{
    return shown_passes[path_mark];
}

/* Lowest z in front of which nothing larger than x is left. */
static int16_t front_left(int16_t x)
{
    int16_t front = part_stock_front;

    for (part_first(); part_record != record; part_next()) {
        if (part_x <= x && part_low < front) {
            front = part_low;
        }
    }
    return front;
}

/* Radius left just behind z (on the chuck's side of it). */
static int16_t radius_behind(int16_t z)
{
    int16_t radius = part_stock_radius;

    for (part_first(); part_record != record; part_next()) {
        if (part_low < z && z <= part_high && part_x < radius) {
            radius = part_x;
        }
    }
    return radius;
}

/* Largest radius left between z_end and z_start. On the way to the chuck the
   radius can only grow where an earlier operation ends. */
static int16_t largest_radius(int16_t z_start, int16_t z_end)
{
    int16_t largest = radius_behind(z_start);
    uint16_t at = PART_IMAGE_HEADER_SIZE;

    while (at != record) {
        int16_t end;

        part_record = at;
        part_read_operation();
        at += part_size;
        end = part_low;
        if (end > z_end && end < z_start) {
            int16_t radius = radius_behind(end);

            if (radius > largest) {
                largest = radius;
            }
        }
    }
    return largest;
}

/* Divides level_depth into passes. */
static void divide(void)
{
    uint16_t depth = (uint16_t)level_depth;

    passes = 0;
    if (level_depth > 0) {
        passes = (depth + part_depth_of_cut - 1) / part_depth_of_cut;
        step_depth = depth / passes;
        deeper = depth % passes;
    }
    if (allowance != 0) {
        passes++;
    }
}

/* The operation as it was read, while others are read. */
static int16_t high;
static int16_t low;
static int16_t x;

static void plan_face(void)
{
    infeed_axis = AXIS_Z;
    cut_axis = AXIS_X;
    level_from = front_left(x);
    level_depth = level_from - low;
    cut_from = part_stock_radius + part_retract;
    cut_to = x;
}

static void plan_cylinder(void)
{
    infeed_axis = AXIS_X;
    cut_axis = AXIS_Z;
    cut_from = front_left(x);
    if (cut_from > high) {
        cut_from = high;
    }
    if (cut_from <= low) {
        return; /* nothing left of it */
    }
    level_from = largest_radius(cut_from, low);
    level_depth = level_from - x;
    allowance = part_allowance;
    if (allowance > (uint16_t)level_depth) {
        allowance = (uint16_t)level_depth;
    }
    level_depth -= allowance;
    cut_from += part_retract;
    cut_to = low;
}

static void plan_operation(void)
{
    part_record = record;
    part_read_operation();
    high = part_high;
    low = part_low;
    x = part_x;
    level_depth = 0;
    allowance = 0;
    record_size = part_size;
    if (part_type == OPERATION_FACE) {
        plan_face();
    } else {
        plan_cylinder();
    }
    divide();
    pass = 1;
}

/* Infeed coordinate of the present pass. */
static int16_t level(void)
{
    if (pass == passes && allowance != 0) {
        return level_from - level_depth - allowance;
    }
    /* Even passes: the first `deeper` of them take one step more. */
    return level_from - step_depth * pass - (pass < deeper ? pass : deeper);
}

/* Where the segment described last ends, machine steps. */
static int16_t at_x;
static int16_t at_z;

static void move(uint8_t axis, int16_t to, uint32_t rate)
{
    path_next.kind = SEGMENT_LINE;
    path_next.dx = 0;
    path_next.dz = 0;
    path_next.mark = newest;
    path_rate = rate;
    if (axis == AXIS_X) {
        to += settings[SETTING_ZERO_X];
        path_next.dx = to - at_x;
        at_x = to;
    } else {
        to += settings[SETTING_ZERO_Z];
        path_next.dz = to - at_z;
        at_z = to;
    }
}

static void rapid(uint8_t axis, int16_t to)
{
    uint8_t id = axis == AXIS_X ? SETTING_RAPID_RATE_X : SETTING_RAPID_RATE_Z;

    move(axis, to, (uint32_t)settings[id] << 8);
    path_next.kind |= SEGMENT_RAPID;
}

static void park(uint8_t axis)
{
    rapid(axis, -PARK_STEPS -
                    settings[axis == AXIS_X ? SETTING_ZERO_X : SETTING_ZERO_Z]);
}

static uint32_t cut_feed(void)
{
    return allowance != 0 && pass == passes ? part_finish_feed() : part_feed();
}

/* Passes to the next operation that has something to cut; 0 = none left. */
static uint8_t next_operation(void)
{
    while (operation < passes_operations) {
        if (operation != 0) {
            record += record_size;
        }
        operation++;
        plan_operation();
        if (passes != 0) {
            return 1;
        }
    }
    return 0;
}

void passes_begin(uint8_t slot)
{
    slot_cut = slot;
    at_x = stream_position_x();
    at_z = stream_position_z();
    part_open(slot);
    passes_operations = part_operations;

    /* Walk through the operations once for the length of the run: the way
       there and back, and for each pass the cut, the return, the retract
       and the infeed again; everything is done twice. */
    record = PART_IMAGE_HEADER_SIZE;
    operation = 0;
    passes_total_steps =
        (uint16_t)(-settings[SETTING_ZERO_X] - part_stock_radius) +
        (uint32_t)(-settings[SETTING_ZERO_Z] - part_stock_front);
    while (next_operation()) {
        for (pass = 0; pass < passes; pass++) {
            passes_total_steps += (uint16_t)(cut_from - cut_to) + part_retract;
        }
    }
    passes_total_steps <<= 1;
    record = PART_IMAGE_HEADER_SIZE;
    operation = 0;
    pass = 0;
    passes = 0;
    stage = STAGE_NEXT_OPERATION;
    show_pass();
}

static void approach(void)
{
    rapid(AXIS_Z, cut_axis == AXIS_Z ? cut_from : level_from + part_retract);
    stage = STAGE_INFEED;
}

/* Describes the move of the present stage and sets the stage after it. */
uint8_t passes_source(void)
{
    int16_t inwards;

    part_reopen(slot_cut);
    if (stage == STAGE_NEXT_OPERATION) {
        stage = next_operation() ? STAGE_CLEAR : STAGE_PARK_X;
    }
    switch (stage) {
    case STAGE_CLEAR:
        rapid(AXIS_X, part_stock_radius + part_retract);
        stage = STAGE_APPROACH;
        if (path_next.dx > 0) {
            break;
        }
        /* Outside the stock already: both axes at once. */
        inwards = path_next.dx;
        approach();
        path_next.dx = inwards;
        break;
    case STAGE_APPROACH:
        approach();
        break;
    case STAGE_INFEED:
        show_pass();
        rapid(infeed_axis, level());
        stage = STAGE_CUT;
        break;
    case STAGE_CUT:
        move(cut_axis, cut_to, cut_feed());
        stage = STAGE_RETRACT;
        break;
    case STAGE_RETRACT:
        rapid(infeed_axis, level() + part_retract);
        stage = STAGE_RETURN;
        break;
    case STAGE_RETURN:
        rapid(cut_axis, cut_from);
        pass++;
        stage = pass > passes ? STAGE_NEXT_OPERATION : STAGE_INFEED;
        break;
    case STAGE_PARK_X:
        park(AXIS_X);
        stage = STAGE_PARK_Z;
        break;
    case STAGE_PARK_Z:
        park(AXIS_Z);
        stage = STAGE_DONE;
        break;
    default:
        return 0;
    }
    return 1;
}
