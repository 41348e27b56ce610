/* Checks a part image before it is stored or cut.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/part_check.h"
#include "lathe/part.h"     /* header and operations */
#include "link/protocol.h"  /* offsets, refusals */
#include "store/flash.h"    /* reading numbers */
#include "store/parts.h"    /* where the image is */
#include "store/settings.h" /* step size, travel, part zero */

uint8_t part_check_operation;

static uint16_t bytes_left; /* from the present record to the image's end */

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

    parts_seek(PART_IMAGE_NAME_AT);
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

static uint8_t feed_valid(uint32_t feed)
{
    return feed >= FEED_MIN && feed <= (uint32_t)part_check_max_rate() << 8;
}

static uint8_t size_valid(int16_t size)
{
    return size > 0 && size <= POSITION_MAX;
}

/* The tool clears the stock by the retract; that place must be inside the
   travel, whose high end is machine zero. zero: where the part's zero lies,
   0 or negative; size: of the stock, 0 or more. */
static uint8_t clears(int16_t zero, int16_t size)
{
    int16_t room = -zero - size;

    return room >= 0 && part_retract <= (uint16_t)room;
}

/* Format, name and screws. */
static uint8_t check_identity(void)
{
    parts_seek(PART_IMAGE_FORMAT_AT);
    if (flash_read() != PART_IMAGE_FORMAT) {
        return REFUSAL_FORMAT;
    }
    parts_seek(PART_IMAGE_FLAGS_AT);
    if (flash_read_u16() != 0) {
        return REFUSAL_FORMAT;
    }
    parts_seek(PART_IMAGE_RESERVED_END_AT);
    if (flash_read_u16() != 0) {
        return REFUSAL_FORMAT;
    }
    if (!name_valid()) {
        return REFUSAL_NAME;
    }
    /* The name is followed by the step sizes. */
    if (flash_read_i16() != settings[SETTING_STEP_X_NM] ||
        flash_read_i16() != settings[SETTING_STEP_Z_NM]) {
        return REFUSAL_STEP_SIZE;
    }
    return 0;
}

static uint8_t check_header(void)
{
    uint8_t reason = check_identity();

    if (reason != 0) {
        return reason;
    }
    if (!size_valid(part_stock_radius) || !size_valid(part_stock_length) ||
        part_stock_front < 0 || part_stock_front > POSITION_MAX) {
        return REFUSAL_STOCK;
    }
    if (part_operations == 0 || part_operations > OPERATIONS_MAX) {
        return REFUSAL_OPERATION_COUNT;
    }
    if (part_depth_of_cut == 0 ||
        part_depth_of_cut > (uint16_t)part_stock_radius) {
        return REFUSAL_DEPTH_OF_CUT;
    }
    if (part_allowance > part_depth_of_cut) {
        return REFUSAL_ALLOWANCE;
    }
    if (!feed_valid(part_feed()) || !feed_valid(part_finish_feed())) {
        return REFUSAL_FEED;
    }
    if (part_retract == 0) {
        return REFUSAL_RETRACT;
    }
    if (!clears(settings[SETTING_ZERO_X], part_stock_radius) ||
        !clears(settings[SETTING_ZERO_Z], part_stock_front)) {
        return REFUSAL_OUTSIDE_TRAVEL;
    }
    return 0;
}

/*
 * True when the tool can come in at the operation's front end: it begins at
 * the raw front, or an earlier one has cut past that place to the same
 * radius or less. By induction everything in front is then cut as deep,
 * because that earlier one was reachable itself. Leaves the operation read.
 */
static uint8_t reachable(void)
{
    uint16_t record = part_record;
    int16_t high = part_high;
    int16_t x = part_x;
    uint8_t found = high == part_stock_front;

    part_first();
    while (part_record != record) {
        if (part_low <= high && part_x <= x) {
            found = 1;
        }
        part_next();
    }
    return found;
}

/* Form of the record read last. */
static uint8_t check_record(void)
{
    uint8_t size = OPERATION_CYLINDER_SIZE;

    if (bytes_left < OPERATION_FACE_SIZE) {
        return REFUSAL_LENGTH;
    }
    if (part_type == OPERATION_FACE) {
        size = OPERATION_FACE_SIZE;
    } else if (part_type != OPERATION_CYLINDER) {
        return REFUSAL_OPERATION_TYPE;
    }
    if (part_size != size) {
        return REFUSAL_OPERATION_SIZE;
    }
    if (size > bytes_left) {
        return REFUSAL_LENGTH;
    }
    if (part_flags != 0) {
        return REFUSAL_FORMAT;
    }
    return 0;
}

/* Place of the operation read last. */
static uint8_t check_place(void)
{
    /* Part zero counted from the low ends of the travels: no overflow, both
       are 0 to 32,000. */
    int16_t lowest_x = -settings[SETTING_ZERO_X] - settings[SETTING_TRAVEL_X];
    int16_t lowest_z = -settings[SETTING_ZERO_Z] - settings[SETTING_TRAVEL_Z];

    if (part_x < 0 || part_x > part_stock_radius ||
        part_high > part_stock_front ||
        part_low < (int16_t)part_retract - part_stock_length) {
        return REFUSAL_OUTSIDE_STOCK;
    }
    if (part_x < lowest_x || part_low < lowest_z) {
        return REFUSAL_OUTSIDE_TRAVEL;
    }
    if (part_high <= part_low || part_x == part_stock_radius) {
        return REFUSAL_EMPTY_CUT;
    }
    return reachable() ? 0 : REFUSAL_BLOCKED;
}

static uint8_t check_operations(uint16_t length)
{
    uint8_t reason;

    bytes_left = length - PART_IMAGE_HEADER_SIZE;
    part_first();
    for (;;) {
        part_check_operation++;
        reason = check_record();
        if (reason == 0) {
            reason = check_place();
        }
        bytes_left -= part_size;
        if (reason != 0) {
            return reason;
        }
        if (part_check_operation == part_operations) {
            break;
        }
        part_next();
    }
    if (bytes_left != 0) {
        part_check_operation = 0;
        return REFUSAL_LENGTH;
    }
    return 0;
}

uint8_t part_check(uint8_t slot, uint16_t length)
{
    uint8_t reason;

    part_check_operation = 0;
    if (length < PART_IMAGE_HEADER_SIZE || length > PART_IMAGE_MAX) {
        return REFUSAL_LENGTH;
    }
    part_open(slot);
    reason = check_header();
    return reason != 0 ? reason : check_operations(length);
}
