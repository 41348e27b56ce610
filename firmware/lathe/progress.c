/* Progress of a part, in EEPROM.
   SPDX-License-Identifier: Apache-2.0 */

#include "lathe/progress.h"
#include "lathe/places.h"  /* what has been cut */
#include "link/protocol.h" /* slots */
#include "motion/path.h"   /* what is being cut */
#include "store/eeprom.h"  /* the ring */
#include "store/parts.h"   /* which part it is */

#define FROM_AT 4
#define CHECK_AT 5
#define SEQUENCE_AT 6
#define CHECK 0x5A

#if (EEPROM_PROGRESS_END - EEPROM_PROGRESS) % PROGRESS_SIZE
#error "the ring must end with a whole record"
#endif

uint8_t progress_record[PROGRESS_SIZE];

static uint8_t place;   /* address of the record */
static uint8_t written; /* bytes of it */
static uint8_t mark;    /* number of what is being cut */

/* What is to be added to the record so that it sums up to CHECK. */
static uint8_t check(void)
{
    uint8_t rest = CHECK;
    uint8_t i;

    for (i = 0; i < PROGRESS_SIZE; i++) {
        rest -= progress_record[i];
    }
    return rest;
}

static void read_record(uint8_t address)
{
    uint8_t i;

    for (i = 0; i < PROGRESS_SIZE; i++) {
        progress_record[i] = eeprom_read(address + i);
    }
}

void progress_init(void)
{
    uint8_t address = EEPROM_PROGRESS_END;
    uint8_t sequence = 0;

    place = 0;
    do {
        address -= PROGRESS_SIZE;
        read_record(address);
        if (check() == 0 &&
            (place == 0 ||
             (uint8_t)(progress_record[SEQUENCE_AT] - sequence) < 0x80)) {
            place = address;
            sequence = progress_record[SEQUENCE_AT];
        }
    } while (address != EEPROM_PROGRESS);
    written = PROGRESS_SIZE;
    progress_record[PROGRESS_OPERATION_AT] = 0;
    if (place != 0) {
        read_record(place);
    }
}

uint8_t progress_slot(void)
{
    uint8_t slot;

    if (progress_record[PROGRESS_OPERATION_AT] != 0) {
        for (slot = 0; slot < PART_SLOTS; slot++) {
            if (parts_present(slot) &&
                progress_record[PROGRESS_CRC_AT] == (uint8_t)parts_crc &&
                progress_record[PROGRESS_CRC_AT + 1] ==
                    (uint8_t)(parts_crc >> 8)) {
                return slot;
            }
        }
    }
    return SLOT_NONE;
}

uint8_t progress_from(void)
{
    return progress_record[FROM_AT];
}

/* The record of the next place is to be written, unless the one before is
   still under way: then its place is used once more. */
static void renew(void)
{
    if (written == PROGRESS_SIZE) {
        place += PROGRESS_SIZE;
        if (place < EEPROM_PROGRESS || place >= EEPROM_PROGRESS_END) {
            place = EEPROM_PROGRESS;
        }
        progress_record[SEQUENCE_AT]++;
    }
    progress_record[CHECK_AT] += check();
    written = 0;
}

static void write_next(void)
{
    if (written != PROGRESS_SIZE) {
        eeprom_start(place + written, progress_record[written]);
        written++;
    }
}

void progress_follow(uint8_t from)
{
    mark = from;
    progress_record[PROGRESS_CRC_AT] = (uint8_t)parts_crc;
    progress_record[PROGRESS_CRC_AT + 1] = (uint8_t)(parts_crc >> 8);
}

void progress_forget(void)
{
    if (progress_record[PROGRESS_OPERATION_AT] != 0) {
        progress_record[PROGRESS_OPERATION_AT] = 0;
        renew();
        while (written != PROGRESS_SIZE) {
            write_next();
        }
        eeprom_read(place); /* waits for the last byte */
    }
}

/* The tool has gone on to another place: the one before it is completed. */
static void completed(uint8_t now)
{
    uint8_t operation = places_operation(now - 1);

    mark = now;
    if (operation != 0) {
        progress_record[PROGRESS_OPERATION_AT] = operation;
        progress_record[PROGRESS_PASS_AT] = places_pass(now - 1);
        if (operation == places_operation(now)) {
            now--;
        }
        progress_record[FROM_AT] = now;
        renew();
    }
}

void progress_poll(uint8_t cutting)
{
    uint8_t now = path_mark;

    if (cutting && now > mark) {
        completed(now);
    }
    if (!eeprom_busy()) {
        write_next();
    }
}
