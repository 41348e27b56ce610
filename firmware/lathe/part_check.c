/* Checks a part image before it is stored or cut.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/part_check.h"
#include "lathe/contour.h"     /* the present record */
#include "lathe/part.h"        /* header and records */
#include "lathe/shape_check.h" /* contours, plunges */
#include "link/protocol.h"     /* offsets, refusals */
#include "store/flash.h"       /* reading numbers */
#include "store/parts.h"       /* where the image is */
#include "store/settings.h"    /* step size, rates, spindle */

#define IMAGE_FLAG_INCH 1
#define TOOL_LAST 15 /* number of a tool */

uint8_t part_check_operation;

uint16_t part_check_max_rate(void)
{
    int16_t x = settings[SETTING_RAPID_RATE_X];
    int16_t z = settings[SETTING_RAPID_RATE_Z];

    return x < z ? x : z;
}

/* At least one character of a-z 0-9 -, then zeros only. */
static uint8_t name_valid(void)
{
    uint8_t last = '-';
    uint8_t i;

    for (i = 0; i < NAME_LENGTH; i++) {
        uint8_t c = flash_read();

        if (c == 0 ? i == 0
                   : last == 0 || !(c == '-' || (c >= '0' && c <= '9') ||
                                    (c >= 'a' && c <= 'z'))) {
            return 0;
        }
        last = c;
    }
    return 1;
}

static uint8_t feed_wrong(uint16_t feed)
{
    if (feed < FEED_MIN) {
        return 1;
    }
    return (feed - 1) / FEED_UNIT >= part_check_max_rate();
}

static uint8_t length_valid(int16_t length)
{
    return length > 0 && length <= POSITION_MAX;
}

static uint8_t check_header(void)
{
    parts_seek(PART_IMAGE_FORMAT_AT);
    if (flash_read() != PART_IMAGE_FORMAT) {
        return REFUSAL_FORMAT;
    }
    flash_read(); /* the number of operations */
    if (flash_read() > IMAGE_FLAG_INCH) {
        return REFUSAL_FORMAT;
    }
    if (flash_read() != 0) {
        return REFUSAL_FORMAT;
    }
    if (!name_valid()) {
        return REFUSAL_NAME;
    }
    /* The name is followed by the step sizes. */
    if ((int16_t)flash_read_u16() != settings[SETTING_STEP_X_NM] ||
        (int16_t)flash_read_u16() != settings[SETTING_STEP_Z_NM]) {
        return REFUSAL_STEP_SIZE;
    }
    if (!length_valid(part_stock_radius) || !length_valid(part_stock_length) ||
        part_stock_front < 0 || part_stock_front > STOCK_FRONT_MAX) {
        return REFUSAL_STOCK;
    }
    if (part_operations == 0 || part_operations > OPERATIONS_MAX) {
        return REFUSAL_OPERATION_COUNT;
    }
    if (part_retract <= 0 || part_retract > RETRACT_MAX) {
        return REFUSAL_RETRACT;
    }
    part_offset_x = 0;
    part_offset_z = 0;
    return shape_check_tool();
}

static uint8_t check_cut(void)
{
    if (part_kind > SPRING_MAX) {
        return REFUSAL_FORMAT;
    }
    if (part_depth_of_cut == 0 ||
        part_depth_of_cut > (uint16_t)part_stock_radius) {
        return REFUSAL_DEPTH_OF_CUT;
    }
    if (part_allowance > part_depth_of_cut) {
        return REFUSAL_ALLOWANCE;
    }
    if (feed_wrong(part_feed) || feed_wrong(part_finish_feed)) {
        return REFUSAL_FEED;
    }
    if (part_spindle != 0 &&
        (part_spindle < (uint16_t)settings[SETTING_SPINDLE_MIN] ||
         part_spindle > (uint16_t)settings[SETTING_SPINDLE_MAX])) {
        return REFUSAL_SPINDLE;
    }
    return 0;
}

/* More bytes than a record of closed form has are wrong too. */
static uint8_t size_wrong(uint8_t size)
{
    return part_size != size;
}

/* The record read last, whose bytes are there; number: of the record, from
   0. */
static uint8_t check_record(uint8_t number)
{
    if (part_type == 0 || part_type > OPERATION_PLUNGE) {
        return REFUSAL_OPERATION_TYPE;
    }
    if (number < 2 && part_type != number + 1) {
        return REFUSAL_ORDER;
    }
    switch (part_type) {
    case OPERATION_TOOL:
        if (size_wrong(OPERATION_TOOL_SIZE)) {
            break;
        }
        part_apply();
        if (part_kind > TOOL_LAST || part_width > WIDTH_MAX ||
            part_below > WIDTH_MAX) {
            return REFUSAL_FORMAT;
        }
        return shape_check_tool();
    case OPERATION_CUT:
        if (size_wrong(OPERATION_CUT_SIZE)) {
            break;
        }
        part_apply();
        return check_cut();
    case OPERATION_PAUSE:
        if (part_size > OPERATION_PAUSE_MAX) {
            break;
        }
        return part_kind > 1 ? REFUSAL_FORMAT : 0;
    case OPERATION_CONTOUR:
        if (part_size < OPERATION_CONTOUR_SEGMENTS_AT) {
            break;
        }
        return shape_check_contour();
    default:
        if (size_wrong(OPERATION_PLUNGE_SIZE)) {
            break;
        }
        return shape_check_plunge();
    }
    return REFUSAL_OPERATION_SIZE;
}

static uint8_t check_records(void)
{
    uint8_t number = 0;
    uint8_t operations = 0;
    uint8_t reason;
    uint16_t left = part_length - PART_IMAGE_HEADER_SIZE;

    contour_own = PART_IMAGE_HEADER_SIZE;
    while (left != 0) {
        part_check_operation = operations + 1;
        if (left < OPERATION_HEAD_SIZE) {
            return REFUSAL_LENGTH;
        }
        part_record = contour_own;
        part_read_record();
        if (part_size < OPERATION_HEAD_SIZE || part_size > left) {
            return REFUSAL_LENGTH;
        }
        left -= part_size;
        reason = check_record(number); /* comes back to this record */
        contour_own += part_size;
        if (reason != 0) {
            return reason;
        }
        if (part_type >= OPERATION_PAUSE && operations <= OPERATIONS_MAX) {
            operations++; /* too many are never the right number */
        }
        if (number < 2) {
            number++;
        }
    }
    part_check_operation = 0;
    return operations == part_operations ? 0 : REFUSAL_OPERATION_COUNT;
}

uint8_t part_check(uint8_t slot, uint16_t length)
{
    uint8_t reason;

    part_check_operation = 0;
    if (length < PART_IMAGE_HEADER_SIZE || length > PART_IMAGE_MAX) {
        return REFUSAL_LENGTH;
    }
    parts_open(slot);
    part_open(length);
    reason = check_header();
    return reason != 0 ? reason : check_records();
}
