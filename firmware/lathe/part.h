/*
 * Reads the image of one part, header and operations, into variables.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * Both operations that can be cut so far remove a region: everything larger
 * than a radius between two ends.
 *
 *              part_low       part_high          part_x
 *   face       its z          the raw front      x_inner
 *   cylinder   z_end          z_start            x
 *
 * Numbers are part coordinates in steps. A 32-bit field that does not fit 16
 * bits reads as -32768 or 32767, which every range check refuses.
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
extern uint16_t part_depth_of_cut;
extern uint16_t part_allowance;
extern uint16_t part_retract;
extern uint8_t part_operations;

/* The operation read last. */
extern uint16_t part_record; /* offset of its record in the image */
extern uint8_t part_type;
extern uint8_t part_size;
extern uint16_t part_flags;
extern int16_t part_low;
extern int16_t part_high;
extern int16_t part_x;

/* Chooses the slot and reads the header. */
void part_open(uint8_t slot);

/* Chooses the slot only: the header has been read before. */
void part_reopen(uint8_t slot);

/* Reads the first operation, or the one after the last one read. */
void part_first(void);
void part_next(void);

/* Reads the operation whose record is at part_record. */
void part_read_operation(void);

/* Feeds, 1/256 step/s. */
uint32_t part_feed(void);
uint32_t part_finish_feed(void);

#endif
