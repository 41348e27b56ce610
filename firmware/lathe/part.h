/*
 * Reads the image of one part, header and records, into variables.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Numbers are part coordinates in steps; link/protocol.toml has the layout of
 * the image and the ranges. What a TOOL or CUT record says holds for the
 * records behind it: part_apply() takes it over.
 *
 * Main loop only. part_open() must precede any other call, again after
 * somebody else has opened another slot.
 */
#ifndef PART_H
#define PART_H

#include <stdint.h>

/* Header. */
extern int16_t part_stock_radius;
extern int16_t part_stock_length;
extern int16_t part_stock_front;
extern int16_t part_retract;
extern uint8_t part_operations;
extern uint16_t part_length; /* of the image, bytes */

/* The record read last. */
extern uint16_t part_record; /* its offset in the image */
extern uint8_t part_type;
extern uint8_t part_kind;
extern uint16_t part_size;

/* The tool and the cutting data in use, in the order of their records. */
extern uint16_t part_below;
extern uint16_t part_width;
extern uint16_t part_back;
extern uint16_t part_front;
extern int16_t part_offset_x;
extern int16_t part_offset_z;
extern uint8_t part_spring;
extern uint16_t part_depth_of_cut;
extern uint16_t part_allowance;
extern uint16_t part_feed; /* 1/FEED_UNIT step/s */
extern uint16_t part_finish_feed;
extern uint16_t part_spindle;
extern uint16_t part_peck;

/* Reads the header of the image that parts_open() has chosen. */
void part_open(uint16_t length);

/* Reads the first record, or the one after the last one read; part_next()
   returns 0 at the end of the image. */
void part_first(void);
uint8_t part_next(void);

/* Reads the record at part_record; its fields are the next to be read from
   flash. */
void part_read_record(void);

/* Takes a TOOL or CUT record, just read, into use. */
void part_apply(void);

#endif
