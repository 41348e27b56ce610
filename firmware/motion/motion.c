/* Straight moves of one axis into step-stream entries.
   SPDX-License-Identifier: Apache-2.0 */

#include "motion/motion.h"
#include "config.h"        /* CYCLES_PER_SECOND */
#include "link/protocol.h" /* AXIS_X */
#include "motion/stream.h"

/* Entries generated in one call: bounds the time away from the link. */
#define BATCH 16

/* Differs from the flags of any move, so that a chain starts with a rest. */
#define NO_MOVE 0xFF

uint8_t move_axis;
int16_t move_to;
uint32_t move_rate;
uint8_t move_mark;

uint16_t motion_dead_x;
uint16_t motion_dead_z;

/* Where the generator is, ahead of the tool. */
static int16_t planned_x;
static int16_t planned_z;
static int16_t planned_slack_x;
static int16_t planned_slack_z;
static uint8_t last_flags;     /* axis and direction of the previous move */
static uint32_t planned_steps; /* tool steps of all moves taken so far */

/* What is left of the move being generated. */
static uint8_t flags;
static uint8_t slack_flag;
static uint8_t speed_due;
static uint16_t slack_left;
static uint16_t steps_left;

static uint8_t ended;   /* STREAM_END has been pushed */
static uint8_t started; /* the interrupt has been set going */

void motion_begin(void)
{
    planned_x = stream_position_x();
    planned_z = stream_position_z();
    planned_slack_x = slack_x;
    planned_slack_z = slack_z;
    last_flags = NO_MOVE;
    slack_left = 0;
    steps_left = 0;
    planned_steps = 0;
    ended = 0;
    started = 0;
    stream_coils_on();
}

uint32_t motion_made(void)
{
    uint16_t ahead = steps_left + stream_fill();

    return planned_steps > ahead ? planned_steps - ahead : 0;
}

uint8_t motion_busy(void)
{
    return !ended || (stream_flags & STREAM_ACTIVE);
}

void motion_cancel(void)
{
    stream_abort();
    ended = 1;
}

void motion_set_home(uint8_t axis)
{
    if (axis == AXIS_X) {
        position_x = 0;
        slack_x = -(int16_t)motion_dead_x;
    } else {
        position_z = 0;
        slack_z = -(int16_t)motion_dead_z;
    }
}

/*
 * Steps the screw must turn before the tool follows. The slack is 0 when the
 * screw pushes the tool in + direction and -dead when it pushes in -; a move
 * that was broken off in between continues from where it stood.
 */
static void take_up(__data int16_t *slack, uint16_t dead, uint8_t negative)
{
    int16_t goal = negative ? -(int16_t)dead : 0;

    if (negative ? *slack > goal : *slack < goal) {
        slack_left = negative ? *slack - goal : goal - *slack;
        *slack = goal;
    }
}

/* Takes the move offered in move_*; the speeds are queued here. */
static void begin_move(void)
{
    int16_t distance;
    uint32_t period = RATE_TO_PERIOD / move_rate;

    if (move_axis == AXIS_X) {
        distance = move_to - planned_x;
        planned_x = move_to;
        flags = STREAM_STEP_X;
    } else {
        distance = move_to - planned_z;
        planned_z = move_to;
        flags = STREAM_STEP_Z;
    }
    if (distance == 0) {
        return;
    }
    if (distance < 0) {
        flags |= (uint8_t)(flags << 1);
        distance = -distance;
    }
    steps_left = distance;
    planned_steps += distance;
    if (move_axis == AXIS_X) {
        slack_flag = STREAM_SLACK_X;
        take_up(&planned_slack_x, motion_dead_x, flags & STREAM_X_NEGATIVE);
    } else {
        slack_flag = STREAM_SLACK_Z;
        take_up(&planned_slack_z, motion_dead_z, flags & STREAM_Z_NEGATIVE);
    }
    if (last_flags != flags) {
        stream_push_speed(SETTLE_PERIOD, move_mark);
        stream_push(STREAM_NEW_SPEED, 0);
    }
    last_flags = flags;
    if (period < STREAM_PERIOD_MIN) {
        period = STREAM_PERIOD_MIN;
    } else if (period > STREAM_PERIOD_MAX) {
        period = STREAM_PERIOD_MAX;
    }
    stream_push_speed(period, move_mark);
    speed_due = STREAM_NEW_SPEED;
}

/* Pushes the entry that ends the chain, or takes the next move. Two entries
   of room and two speeds are enough for either. */
static void next_move(void)
{
    if (motion_source()) {
        begin_move();
    } else {
        stream_push(STREAM_END, 0);
        ended = 1;
    }
}

void motion_poll(void)
{
    uint8_t room = stream_room();
    uint8_t batch;

    for (batch = BATCH; batch != 0 && room > 1 && !ended; batch--) {
        if (slack_left != 0) {
            stream_push(flags | slack_flag | speed_due, 0);
            speed_due = 0;
            slack_left--;
        } else if (steps_left != 0) {
            stream_push(flags | speed_due, 0);
            speed_due = 0;
            steps_left--;
        } else if (stream_speeds_free() >= 2) {
            next_move();
        } else {
            break;
        }
        room = stream_room();
    }
    if (!started && (ended || stream_fill() >= STREAM_ENTRIES / 2)) {
        started = 1;
        stream_start();
    } else if (started && !ended && stream_fill() < stream_low) {
        stream_low = stream_fill();
    }
}
