/*
 * Progress: which part was begun and how far it came, known without power.
 *
 * SPDX-License-Identifier: Apache-2.0
 *
 * A record goes to the EEPROM when a pass has been completed, beside the
 * motion: a byte takes 4 ms, and the main loop does not wait for it. The
 * records take turns in a ring of nine, so each byte of the EEPROM is
 * written once in nine passes. The oldest is overwritten, its sequence
 * number last: a cut of power leaves the newest or the one before it.
 *
 *   at  0  CRC of the part's image, low byte first
 *       2  operation, 0 = there is nothing to resume
 *       3  pass completed last, as shown to the operator
 *       4  number of the place to go on from (places.h)
 *       5  check: all bytes sum up to CHECK; a worn or blank one shows
 *       6  sequence
 *
 * The place to go on from is the pass completed last, cut once more; if it
 * was the last one of its operation, the place after it, so that the tool in
 * use is the one that was in use. Places are counted up to 255: of a longer
 * part, what lies behind is repeated from there.
 *
 * Main loop only.
 */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdint.h>

#define PROGRESS_CRC_AT 0
#define PROGRESS_OPERATION_AT 2
#define PROGRESS_PASS_AT 3
#define PROGRESS_SIZE 7

/* The newest record. */
extern uint8_t progress_record[PROGRESS_SIZE];

/* Finds the newest record; once after reset. */
void progress_init(void);

/* Slot of the part that can be resumed, SLOT_NONE if there is none. */
uint8_t progress_slot(void);

/* Where to go on, for passes_begin(). */
uint8_t progress_from(void);

/* A run begins, at this place: follow it. */
void progress_follow(uint8_t from);

/* There is nothing to resume any more. Waits for the EEPROM: while nothing
   moves. */
void progress_forget(void);

/* Notices completed passes while a part is cut, and writes what there is to
   write; every turn of the main loop. */
void progress_poll(uint8_t cutting);

#endif
