/* Moves of a stored part: from record to record, from pass to pass.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/passes.h"
#include "config.h"         /* PARK_STEPS */
#include "lathe/contour.h"  /* stretches, material */
#include "lathe/cuts.h"     /* the passes of one operation */
#include "lathe/part.h"     /* the part */
#include "lathe/places.h"   /* what is being described */
#include "link/protocol.h"  /* axes, settings */
#include "motion/path.h"    /* segments */
#include "motion/stream.h"  /* where the tool is */
#include "store/parts.h"    /* the slot */
#include "store/settings.h" /* part zero, rapid rates */

enum stage {
    STAGE_RECORD, /* next record */
    STAGE_CLEAR,  /* X out of the stock */
    STAGE_PASS,   /* next pass */
    STAGE_RISE,   /* X above what is in the way */
    STAGE_OVER,   /* Z to its place */
    STAGE_DOWN,   /* X close above the material left there */
    STAGE_IN,     /* X to its level */
    STAGE_CUT,
    STAGE_BREAK_CHIP,
    STAGE_FOLLOW, /* the contour */
    STAGE_OUT,    /* away from the work */
    STAGE_PARK_X,
    STAGE_PARK_Z,
    STAGE_PARKED
};

/* Wait for each pass left out: longer than working it out takes. */
#define SKIP_MS 20

uint8_t passes_more;

static uint8_t slot_cut; /* other readers of the store may have moved on */
static uint8_t stepping;
static uint8_t stage;
static uint8_t operation; /* 1.. */
static uint16_t own_size; /* of the record at contour_own */
static uint8_t parked;    /* nothing has been cut since the last pause */
static uint8_t outside;   /* the tool is farther out than the stock */

static uint8_t at_most_255(uint16_t value)
{
    return value > 255 ? 255 : (uint8_t)value;
}

static void show_pass(void)
{
    places_next(operation, at_most_255(cuts_pass));
}

static void on_the_way(void)
{
    cuts_pass = 0;
    cuts_passes = 0;
    show_pass();
}

uint8_t passes_operation(void)
{
    return places_operation(path_mark);
}

uint8_t passes_pass(void)
{
    return places_pass(path_mark);
}

uint8_t passes_passes(void)
{
    return passes_operation() == operation ? at_most_255(cuts_passes) : 0;
}

/* Where the segment described last ends, machine steps. */
static int16_t at_x;
static int16_t at_z;

/* rate: 1/FEED_UNIT step/s. */
static void segment(uint16_t rate)
{
    path_next.kind = SEGMENT_LINE;
    path_next.dx = 0;
    path_next.dz = 0;
    path_next.mark = places_mark();
    path_set_feed(rate);
}

/* Machine coordinates of part zero for the tool in use. */
static int16_t zero_x(void)
{
    return settings[SETTING_ZERO_X] + part_offset_x;
}

static int16_t zero_z(void)
{
    return settings[SETTING_ZERO_Z] + part_offset_z;
}

static void to_x(int16_t x)
{
    x += zero_x();
    path_next.dx = x - at_x;
    at_x = x;
}

static void to_z(int16_t z)
{
    z += zero_z();
    path_next.dz = z - at_z;
    at_z = z;
}

static void rapid(uint8_t id)
{
    segment(0);
    path_set_rapid(settings[id]);
    path_next.kind = SEGMENT_LINE | SEGMENT_RAPID;
}

static void rapid_x(int16_t x)
{
    rapid(SETTING_RAPID_RATE_X);
    to_x(x);
}

static void rapid_z(int16_t z)
{
    rapid(SETTING_RAPID_RATE_Z);
    to_z(z);
}

static void feed(void)
{
    segment(cuts_finish ? part_finish_feed : part_feed);
}

/* How far the tool is below a height; negative when above. */
static int16_t below(int16_t height)
{
    return height + zero_x() - at_x;
}

void passes_begin(uint8_t slot, uint8_t step, uint8_t from)
{
    slot_cut = slot;
    stepping = step;
    at_x = stream_position(AXIS_X);
    at_z = stream_position(AXIS_Z);
    passes_more = 1;
    contour_own = PART_IMAGE_HEADER_SIZE;
    operation = 0;
    parked = 0;
    stage = STAGE_RECORD;
    places_begin(from);
    path_mark = from;
    on_the_way();
}

/* To park, unless that has been done before the power went. */
static void park(void)
{
    stage = STAGE_PARK_X;
    if (places_to_go_on != 0) {
        parked = 1;
        stage = STAGE_RECORD;
    }
}

/* Takes the record at contour_own; what is parked for comes afterwards. */
static void take_record(void)
{
    if (contour_own >= part_length) {
        passes_more = 0;
        show_pass();
        stage = STAGE_PARK_X;
        return;
    }
    part_record = contour_own;
    part_read_record();
    own_size = part_size;
    if (part_type == OPERATION_TOOL
            ? contour_own != PART_IMAGE_HEADER_SIZE
            : part_type != OPERATION_CUT && stepping && operation != 0) {
        if (!parked) {
            if (part_type == OPERATION_TOOL) {
                show_pass(); /* a place that is never cut, to go on from */
                show_pass();
            }
            park();
            return;
        }
    }
    if (part_type < OPERATION_PAUSE) {
        part_apply();
    } else {
        operation++;
        if (part_type == OPERATION_PAUSE) {
            on_the_way();
            park();
        } else if (cuts_begin()) {
            stage = STAGE_CLEAR;
            return;
        }
    }
    contour_own += own_size;
}

/* The next segment of the contour; 0 at its end. */
static uint8_t follow(void)
{
    if (!contour_next()) {
        return 0;
    }
    if (contour_split) {
        contour_next(); /* for the tool it is one arc */
    }
    feed();
    path_next.kind = contour_arc;
    path_next.dx = contour_dx;
    path_next.dz = contour_dz;
    at_x += contour_dx;
    at_z += contour_dz;
    if (contour_arc != SEGMENT_LINE) {
        contour_read_centre();
    }
    return 1;
}

/* The next peck of a plunge; 1 when it has reached the bottom. */
static uint8_t peck(void)
{
    int16_t left = cuts_x - cuts_end;

    if (part_peck != 0 && (uint16_t)left > part_peck) {
        left = part_peck;
    }
    cuts_x -= left;
    to_x(cuts_x);
    return cuts_x == cuts_end;
}

static void cut(void)
{
    feed();
    stage = STAGE_OUT;
    switch (cuts_kind) {
    case CUT_ALONG:
        to_z(cuts_end);
        break;
    case CUT_FACING:
        to_x(cuts_end);
        break;
    case CUT_PLUNGE:
        if (!peck()) {
            stage = STAGE_BREAK_CHIP;
        }
        break;
    default:
        to_z(cuts_start);
        part_record = contour_own;
        part_read_record();
        contour_open();
        stage = STAGE_FOLLOW;
        break;
    }
}

/* Describes the move of the present stage, if it has one, and sets the stage
   after it. */
static void move(void)
{
    int16_t x;

    switch (stage) {
    case STAGE_RECORD:
        take_record();
        break;
    case STAGE_CLEAR:
        stage = STAGE_PASS;
        outside = 1;
        if (below(part_stock_radius + part_retract) > 0) {
            outside = 0;
            rapid_x(part_stock_radius + part_retract);
        }
        break;
    case STAGE_PASS:
        stage = STAGE_RISE;
        if (!cuts_next()) {
            contour_own += own_size;
            parked = 0;
            stage = STAGE_RECORD;
            break;
        }
        show_pass();
        if (places_to_go_on != 0) {
            stage = STAGE_PASS;
        }
        break;
    case STAGE_RISE:
        if (below(cuts_rise) > 0) {
            rapid_x(cuts_rise);
        }
        stage = STAGE_OVER;
        break;
    case STAGE_OVER:
        rapid_z(cuts_z);
        if (outside) {
            to_x(part_stock_radius + part_retract); /* both axes at once */
            outside = 0;
        }
        stage = STAGE_DOWN;
        break;
    case STAGE_DOWN:
        if (!cuts_open && below(cuts_height) < 0) {
            rapid_x(cuts_height);
        }
        stage = STAGE_IN;
        break;
    case STAGE_IN:
        stage = STAGE_CUT;
        if (cuts_kind == CUT_PLUNGE) {
            cuts_x = cuts_height - part_retract;
        } else if (cuts_kind != CUT_FACING) {
            if (cuts_open) {
                rapid_x(cuts_x);
            } else {
                feed();
                to_x(cuts_x);
            }
        }
        break;
    case STAGE_CUT:
        cut();
        break;
    case STAGE_BREAK_CHIP:
        rapid_x(cuts_x + part_retract);
        stage = STAGE_CUT;
        break;
    case STAGE_FOLLOW:
        if (!follow()) {
            stage = STAGE_OUT;
        }
        break;
    case STAGE_OUT:
        stage = STAGE_PASS;
        if (cuts_kind == CUT_ALONG) {
            cuts_rise = cuts_x + part_retract; /* where the tool is */
            rapid_x(cuts_rise);
        } else if (cuts_kind == CUT_FACING) {
            feed(); /* what its back edge has left is in the way */
            to_z(cuts_z + part_retract);
        } else {
            rapid_x(cuts_height);
        }
        break;
    case STAGE_PARK_X:
        x = -PARK_STEPS - zero_x();
        if (x < part_stock_radius + part_retract) {
            x = part_stock_radius + part_retract; /* a thick stock */
        }
        rapid_x(x);
        stage = STAGE_PARK_Z;
        break;
    default: /* STAGE_PARK_Z */
        rapid_z(-PARK_STEPS - zero_z());
        stage = STAGE_PARKED;
        break;
    }
}

uint8_t passes_source(void)
{
    parts_open(slot_cut);
    do {
        if (stage == STAGE_PARKED) {
            if (passes_more) {
                parked = 1; /* and so it goes on in the next chain */
                stage = STAGE_RECORD;
            }
            return 0;
        }
        segment(0);
        move();
        if (places_to_go_on != 0 && path_next.dx == 0) {
            path_next.kind = SEGMENT_WAIT; /* one pass in each turn */
            path_next.dx = SKIP_MS;
        }
    } while (path_next.dx == 0 && path_next.dz == 0);
    return 1;
}
