/*
 * Part store: named parts in program flash, in units of 256 bytes.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * A part takes one unit or more in a row; its slot is the number of the first.
 * That one begins with 64 bytes of header (magic, generation, length, CRC of
 * the image, CRC of the header; written last); the image follows as it came
 * over the link, at most PART_IMAGE_MAX bytes. A part is there when its header
 * is whole, so an upload that is cut off anywhere leaves nothing behind and
 * every other part as it was. A part with the name of an older one replaces
 * it: the older header goes when the new one stands; should power fail in
 * between, the next start finds both and drops the older.
 *
 * An upload goes to the first free units that are enough of them in a row.
 * Main loop only, and never while moving: the flash stops the processor.
 * Errors are ERROR_... of link/protocol.h.
 */
#ifndef PARTS_H
#define PARTS_H

#include <stdint.h>

/* Drops what a power failure left double, finds the selected part. */
void parts_init(void);

/* Slot that the RUN button cuts: chosen, else the newest; SLOT_NONE if there
   is no part. */
uint8_t parts_selected(void);

/* Chooses it; remembered without power. */
uint8_t parts_select(uint8_t slot);

/* Chooses the part behind the selected one, the first behind the last.
   Returns its number in the order of the slots, from 1; 0 without a part. */
uint8_t parts_select_next(void);

/* True when the slot holds a part; its header is then in the variables
   below, until the next call into this room. */
uint8_t parts_present(uint8_t slot);
extern uint16_t parts_generation;
extern uint16_t parts_length;
extern uint16_t parts_crc;

/* The same, and the image has the CRC that the header tells. */
uint8_t parts_intact(uint8_t slot);

/* Reads the name of the part in a slot into parts_name. */
void parts_read_name(uint8_t slot);
extern uint8_t parts_name[];

/* Empties a slot. */
uint8_t parts_delete(uint8_t slot);

/* Upload: begin, then pieces of 32 bytes in order of offset, the last one as
   long as it is, then finish and accept. */
uint8_t parts_upload_begin(uint16_t length, uint16_t crc);
uint8_t parts_upload_data(uint16_t offset, __data const uint8_t *data,
                          uint8_t size);

/* Ends the upload: compares the image in flash with the CRC announced; on
   ERROR_OK parts_upload_slot and parts_upload_length tell where it is, and
   it becomes a part by parts_upload_accept() once it has been checked. */
uint8_t parts_upload_finish(void);
uint8_t parts_upload_accept(void);
extern uint8_t parts_upload_slot;
extern uint16_t parts_upload_length;

/* Reading the image in a slot: parts_open() chooses it, parts_seek() the
   offset; then the flash_read functions take one number after the other. */
void parts_open(uint8_t slot);
void parts_seek(uint16_t offset);

#endif
